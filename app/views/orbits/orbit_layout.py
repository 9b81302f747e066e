"""The panes of the orbits: those that need an orbit, or two, come with these; an empty pane in the page takes its time, too."""

from __future__ import annotations

import panel as pn

from app.views.components.flex_row import flex_row
from app.views.components.plots import PANE, dress
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot


class OrbitLayout:
    """A row that wraps, beside the desk as long as there is room for one pane."""

    def __init__(self, panes: OrbitPlots, separation: SeparationPlot) -> None:
        *always, exponent = panes.layout()
        self._columns = [*((0, column) for column in always), (1, exponent), (2, separation.layout())]
        self._late_figures = (panes.exponent, separation.figure)
        self._dark = False
        self._row = flex_row(gap="4px")
        self._row.styles = {**self._row.styles, "flex": f"1 1 {PANE}px"}
        self.follow(0)

    def layout(self) -> pn.viewable.Viewable:
        """The panes."""
        return self._row

    def follow(self, orbits: int) -> None:
        """Show what so many orbits need."""
        columns = [column for least, column in self._columns if least <= orbits]
        if columns != self._row.objects:
            for plot in self._late_figures:
                dress(plot, dark=self._dark)
            self._row.objects = columns

    def set_dark(self, dark: bool) -> None:
        """Whether panes come into a dark page."""
        self._dark = dark
