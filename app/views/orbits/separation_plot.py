"""The distance between the chosen orbit and the previously chosen orbit, or else a neighbour in the list."""

from __future__ import annotations

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, Line, Range1d

from app.state.view_state import ViewState
from app.views.components.plots import history_figure, set_decades, set_range
from app.views.components.texts import TextPane
from engine.results import Separation
from plots.pictures.palette import PALETTES

TITLE = "Distance of two orbits"
SMALLEST_DISTANCE = 1e-17
"""Smallest distance on the logarithmic axis (dimensionless)."""


class SeparationPlot:
    """Draws the distance in phase space against time, on a logarithmic axis, while there are two orbits."""

    def __init__(self, state: ViewState) -> None:
        self._x_range = Range1d(0.0, 10.0)
        self._y_range = Range1d(SMALLEST_DISTANCE, 10.0)
        self._source = ColumnDataSource({"t": [], "distance": []}, name="separation_source")
        self._pair = TextPane("", name="pair", margin=(0, 10), css_classes=["quiet"])
        self._view = pn.Column(margin=0, sizing_mode="stretch_width", visible=False)
        self._line = Line(x="t", y="distance", line_width=1.5)
        state.follow(lambda name: self._line.update(line_color=PALETTES[name].orbits[1]), "palette")

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the view with the figure and the line of text that names the orbits."""
        plot = history_figure("separation", TITLE, y_axis_type="log", x_range=self._x_range, y_range=self._y_range)
        plot.add_glyph(self._source, self._line)
        self._view.objects = [pn.pane.Bokeh(plot, margin=0), self._pair]
        return [self._view]

    def show(self, pair: tuple[int, int] | None, separation: Separation | None) -> None:
        """Draw the distance of two orbits, given by their places in the list; None hides the figure."""
        self._view.visible = pair is not None and separation is not None
        if pair is None or separation is None:
            return
        distance = np.maximum(separation.distance, SMALLEST_DISTANCE)
        self._source.data = {"t": separation.t, "distance": distance}
        set_range(self._x_range, 0.0, float(separation.t[-1]))
        set_decades(self._y_range, float(distance.min()), 10.0)
        self._pair.object = f"Orbits {pair[0] + 1} and {pair[1] + 1}"
