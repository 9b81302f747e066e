"""The distance of two orbits: the chosen one and the one before it."""

from __future__ import annotations

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, Line, Range1d

from app.views.components.plots import HISTORY_ASPECT, set_decades, set_range, square_figure
from app.views.components.texts import TextPane
from engine.results import Separation
from plots.pictures.palette import PAPER, Palette

TITLE = "Distance of two orbits"
LEAST = 1e-17
_ALONE = "Needs a second orbit."


class SeparationPlot:
    """Distance in phase space against time, logarithmic; empty for a single orbit, so that a second one moves nothing."""

    def __init__(self) -> None:
        self._times, self._distances = Range1d(0.0, 10.0), Range1d(LEAST, 10.0)
        self._source = ColumnDataSource({"t": [], "distance": []}, name="separation_source")
        self._pair = TextPane(_ALONE, name="pair", margin=(0, 10), css_classes=["quiet"])
        self._line = Line(x="t", y="distance", line_width=1.5, line_color=PAPER.orbits[1])

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the figure, and the line that names the orbits."""
        plot = square_figure(
            "separation", TITLE, y_axis_type="log", x_axis_label="t", y_axis_label="distance",
            x_range=self._times, y_range=self._distances, aspect_ratio=HISTORY_ASPECT,
        )  # fmt: skip
        plot.add_glyph(self._source, self._line)
        return [pn.Column(pn.pane.Bokeh(plot, margin=0), self._pair, margin=0, sizing_mode="stretch_width")]

    def show(self, pair: tuple[int, int] | None, separation: Separation | None) -> None:
        """Draw the distance of two orbits, given by their places in the list; None removes it."""
        if pair is None or separation is None:
            self._source.data = {"t": [], "distance": []}
            self._pair.object = _ALONE
            return
        distance = np.maximum(separation.distance, LEAST)
        self._source.data = {"t": separation.t, "distance": distance}
        set_range(self._times, 0.0, float(separation.t[-1]))
        set_decades(self._distances, float(distance.min()), 10.0)
        self._pair.object = f"Orbits {pair[0] + 1} and {pair[1] + 1}"

    def set_palette(self, palette: Palette) -> None:
        """Set the colour of the line."""
        self._line.line_color = palette.orbits[1]
