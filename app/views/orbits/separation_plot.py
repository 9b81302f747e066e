"""The distance of two orbits: the chosen one and the one before it."""

from __future__ import annotations

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, Line, Range1d

from app.rendering.palette import PAPER, Palette
from app.views.components.plots import set_range, square_figure, with_help
from engine import Separation

TITLE = "Distance of two orbits"
LEAST = 1e-17


class SeparationPlot:
    """Distance in phase space against time, logarithmic; empty while fewer than two orbits are chosen."""

    def __init__(self) -> None:
        ranges = {"x_range": Range1d(0.0, 10.0), "y_range": Range1d(LEAST, 10.0)}
        self.figure = square_figure("separation", TITLE, y_axis_type="log", x_axis_label="t", y_axis_label="distance", **ranges)
        self._source = ColumnDataSource({"t": [], "distance": []}, name="separation_source")
        self._line = Line(x="t", y="distance", line_width=1.5, line_color=PAPER.orbits[1])
        self.figure.add_glyph(self._source, self._line)
        self._column = with_help(pn.pane.Bokeh(self.figure, margin=0), "distance")

    def layout(self) -> pn.viewable.Viewable:
        """The figure with its help text."""
        return self._column

    def show(self, pair: tuple[int, int] | None, separation: Separation | None) -> None:
        """Draw the distance of two orbits, given by their places in the list; None removes it."""
        if pair is None or separation is None:
            self._source.data = {"t": [], "distance": []}
            self.figure.title.text = TITLE
            return
        distance = np.maximum(separation.distance, LEAST)
        self._source.data = {"t": separation.t, "distance": distance}
        set_range(self.figure.x_range, 0.0, float(separation.t[-1]))
        set_range(self.figure.y_range, 0.5 * float(distance.min()), 10.0)
        self.figure.title.text = f"Distance of orbits {pair[0] + 1} and {pair[1] + 1}"

    def set_palette(self, palette: Palette) -> None:
        """Set the colour of the line."""
        self._line.line_color = palette.orbits[1]
