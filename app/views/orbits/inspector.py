"""The inspector of the orbits: built for the first orbit, shown while there are orbits."""

from __future__ import annotations

import panel as pn

from app.views.components.flex_row import FULL_HEIGHT
from app.views.orbits.orbit_controls import OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot


class Inspector:
    """A line to type a start; below it the list and values of the orbits, the player and the plots."""

    def __init__(self, controls: OrbitControls, playback: Playback, plots: OrbitPlots, separation: SeparationPlot) -> None:
        self._controls, self._playback, self._plots, self._separation = controls, playback, plots, separation
        self._values: pn.viewable.Viewable | None = None
        self._single: list[pn.viewable.Viewable] = []
        self._pair: list[pn.viewable.Viewable] = []
        self._grid = pn.Column(
            *controls.entry(), sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["inspector"]
        )
        self._entry = [*self._grid.objects]

    def layout(self) -> pn.viewable.Viewable:
        """The whole inspector."""
        return self._grid

    def follow(self, starts: int, orbits: int) -> None:
        """Show what a number of starts needs, of which some may have no orbit."""
        if starts >= 1 and self._values is None:
            self._values = self._controls.values(self._playback.layout())
        if orbits >= 1 and not self._single:
            self._single = self._plots.build()
        if orbits >= 2 and not self._pair:
            self._pair = [self._separation.build()]
        parts = [*self._entry, *([self._values] if starts >= 1 else []), *(self._single if orbits >= 1 else [])]
        parts += self._pair if orbits >= 2 else []
        if parts != self._grid.objects:
            self._grid.objects = parts
