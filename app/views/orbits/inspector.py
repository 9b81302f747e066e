"""The inspector of the orbits: built for the first orbit, shown while there are orbits; each part has its place."""

from __future__ import annotations

import panel as pn

from app.views.components.widgets import FULL_HEIGHT
from app.views.orbits.orbit_controls import OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot


class Inspector:
    """The verdict on the chosen orbit, the player, the histories, the indicators and values; last, a line to type a start."""

    def __init__(self, controls: OrbitControls, playback: Playback, plots: OrbitPlots, separation: SeparationPlot) -> None:
        self._controls, self._playback, self._plots, self._separation = controls, playback, plots, separation
        self._head: list[pn.viewable.Viewable] = []
        self._details: list[pn.viewable.Viewable] = []
        self._plotted: list[pn.viewable.Viewable] = []
        self._entry = controls.entry()
        self._grid = pn.Column(
            controls.note, *self._entry, sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["inspector"]
        )

    def layout(self) -> pn.viewable.Viewable:
        """The whole inspector."""
        return self._grid

    def follow(self, starts: int, orbits: int) -> None:
        """Show the panes for a number of starts, some of which may have no orbit."""
        if starts >= 1 and not self._head:
            self._head, self._details = [self._controls.head(self._playback.layout())], self._controls.details()
        if orbits >= 1 and not self._plotted:
            self._plotted = [*self._plots.build(), self._separation.build()]
        shown = [*(self._plotted if orbits >= 1 else []), *self._details] if starts >= 1 else []
        parts = [*(self._head if starts >= 1 else []), self._controls.note, *shown, *self._entry]
        if parts != self._grid.objects:
            self._grid.objects = parts
