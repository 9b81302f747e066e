"""The orbit plots: those that need an orbit, or two, are added to the page with these, as empty figures cost time."""

from __future__ import annotations

import panel as pn

from app.views.components.flex_row import flex_row
from app.views.components.plots import COLUMN
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot


class OrbitLayout:
    """A row that wraps, beside the controls while there is room for one plot."""

    def __init__(self, plots: OrbitPlots, separation: SeparationPlot) -> None:
        *always, exponent = plots.layout()
        self._columns = [*((0, column) for column in always), (1, exponent), (2, separation.layout())]
        self._row = flex_row()
        self._row.styles = {**self._row.styles, "flex": f"1 1 {COLUMN}px"}
        self.follow(0)

    def layout(self) -> pn.viewable.Viewable:
        """The plots."""
        return self._row

    def follow(self, orbits: int) -> None:
        """Show the plots that a number of orbits needs."""
        columns = [column for least, column in self._columns if least <= orbits]
        if columns != self._row.objects:
            self._row.objects = columns
