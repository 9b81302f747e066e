"""Marks on the pictures: numbered starts, section points (crossings of the section), and the box whose pixels are counted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from bokeh.models import ColumnDataSource, Quad, Scatter, Text
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.orbit_lines import orbit_colours
from app.views.components.plots import LaterGlyphs, SourcedGlyphs
from engine import Window
from plots.pictures.palette import LIGHT, MARK_EDGE

MOST_SECTION_POINTS = 2000
"""Largest number of section points that are drawn for an orbit."""

NO_POINTS = np.zeros((0, 2))
"""The section of an orbit without section points."""


class Markers:
    """Marks on figures. A kind of mark is added to the figures when it is first shown.

    Parameters
    ----------
    state
        View state, whose box is marked.
    """

    def __init__(self, state: ViewState) -> None:
        self._glyphs_by_kind = {
            "starts": LaterGlyphs(self._make_starts, "annotation"),
            "sections": LaterGlyphs(self._make_sections, "annotation"),
            "box": LaterGlyphs(self._make_box, "annotation"),
        }
        self._starts = ColumnDataSource({"x": [], "y": [], "slot": [], "text": []}, name="starts")
        self._sections = ColumnDataSource({"x": [], "y": [], "slot": []}, name="sections")
        self._box = ColumnDataSource({"left": [], "right": [], "bottom": [], "top": []}, name="box")
        self._colour = {"field": "slot", "transform": orbit_colours(state)}
        state.follow(self._show_box, "box")

    def draw(self, plot: figure, *, sections: bool) -> None:
        """Add a figure to mark. Only with `sections`, section points are drawn, because painting them takes time."""
        for kind in ("starts", "box", *(["sections"] if sections else [])):
            self._glyphs_by_kind[kind].add_figure(plot)

    def _make_sections(self) -> SourcedGlyphs:
        return [(self._sections, Scatter(size=3, fill_color=self._colour, line_color=None))]

    def _make_box(self) -> SourcedGlyphs:
        return [(self._box, Quad(fill_alpha=0.0, line_color=MARK_EDGE, line_width=2, line_dash="dashed"))]

    def _make_starts(self) -> SourcedGlyphs:
        crosses = [
            Scatter(marker="cross", size=size, line_width=width, line_color=ink)
            for size, width, ink in ((18, 7, LIGHT.halo), (17, 5, MARK_EDGE), (16, 3, self._colour))
        ]
        style = {"x_offset": 6, "y_offset": -4, "text_font_size": "14px", "text_font_style": "bold", "text_color": MARK_EDGE}
        # The outline of a text covers the text, so the number is drawn again without outline.
        numbers = [Text(text_outline_color=outline, **style) for outline in (LIGHT.halo, None)]
        return [(self._starts, glyph) for glyph in (*crosses, *numbers)]

    def show_starts(self, starts: Sequence[tuple[float, float]]) -> None:
        """Mark each start with a numbered cross."""
        if starts:
            self._glyphs_by_kind["starts"].draw()
        x, y = [float(x) for x, _ in starts], [float(ordinate) for _, ordinate in starts]
        slots = list(range(len(starts)))
        marks = {"x": x, "y": y, "slot": slots, "text": [str(slot + 1) for slot in slots]}
        if marks != dict(self._starts.data):
            self._starts.data = marks

    def show_sections(self, sections: Sequence[np.ndarray]) -> None:
        """Draw the section points of each orbit, given as arrays of shape (n, 2)."""
        drawn_sections = [points[:MOST_SECTION_POINTS] for points in sections]
        if any(len(points) for points in drawn_sections):
            self._glyphs_by_kind["sections"].draw()
        elif not len(self._sections.data["x"]):
            return
        points = np.concatenate([NO_POINTS, *drawn_sections]).astype(np.float32)
        slots = np.repeat(np.arange(len(drawn_sections), dtype=np.uint8), [len(points) for points in drawn_sections])
        self._sections.data = {"x": points[:, 0], "y": points[:, 1], "slot": slots}

    def _show_box(self, box: Window | None) -> None:
        """Draw the box whose pixels are counted; None removes it."""
        boxes = [] if box is None else [box]
        if boxes:
            self._glyphs_by_kind["box"].draw()
        self._box.data = {
            "left": [each.x_low for each in boxes],
            "right": [each.x_high for each in boxes],
            "bottom": [each.ordinate_low for each in boxes],
            "top": [each.ordinate_high for each in boxes],
        }
