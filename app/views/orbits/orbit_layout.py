"""The orbit plots on the page: built for the first orbit, or the second, and shown while there are as many."""

from __future__ import annotations

import panel as pn

from app.views.components.flex_row import flex_row
from app.views.components.plots import COLUMN
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot


class OrbitLayout:
    """A row that wraps, beside the controls while there is room for one plot."""

    def __init__(self, plots: OrbitPlots, separation: SeparationPlot) -> None:
        self._plots, self._separation = plots, separation
        self._single: list[pn.viewable.Viewable] = []
        self._pair: list[pn.viewable.Viewable] = []
        self._row = flex_row()
        self._row.visible = False
        self._row.styles = {**self._row.styles, "flex": f"1 1 {COLUMN}px"}

    def layout(self) -> pn.viewable.Viewable:
        """The plots."""
        return self._row

    def follow(self, orbits: int) -> None:
        """Show the plots that a number of orbits needs."""
        if orbits >= 1 and not self._single:
            self._single = self._plots.build()
        if orbits >= 2 and not self._pair:
            self._pair = [self._separation.build()]
        columns = [*(self._single if orbits >= 1 else []), *(self._pair if orbits >= 2 else [])]
        if columns != self._row.objects:
            self._row.param.update(objects=columns, visible=bool(columns))
