"""The inspector of the orbits: built for the first orbit, shown while there are orbits; each part has its place."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import panel as pn

from app.views.components.widgets import FULL_HEIGHT
from app.views.orbits.orbit_controls import OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot


class Inspector:
    """A line to type a start; below it the list of the orbits, the player, the histories, and the verdicts and values.

    Parameters
    ----------
    controls, playback, plots, separation
        Its parts.
    later
        Wraps a function so that it runs in a later turn of the event loop, as each figure takes some time.
    """

    def __init__(
        self,
        controls: OrbitControls,
        playback: Playback,
        plots: OrbitPlots,
        separation: SeparationPlot,
        later: Callable[[Callable[[], None]], Callable[[], None]],
    ) -> None:
        self._controls, self._playback = controls, playback
        self._head: list[pn.viewable.Viewable] = []
        self._details: list[pn.viewable.Viewable] = []
        self._plotted: list[pn.viewable.Viewable] = []
        # Makers of the figures that are not there yet.
        self._unbuilt = deque([plots.build, separation.build])
        self._grid = pn.Column(
            *controls.entry(), sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["inspector"]
        )
        self._entry = [*self._grid.objects]
        self._starts = self._orbits = 0
        self._add_figures = later(self._build_figures)

    def layout(self) -> pn.viewable.Viewable:
        """The whole inspector."""
        return self._grid

    def follow(self, starts: int, orbits: int) -> None:
        """Show the panes for a number of starts, some of which may have no orbit."""
        self._starts, self._orbits = starts, orbits
        if starts >= 1 and not self._head:
            self._head, self._details = [self._controls.head(self._playback.layout())], self._controls.details()
        if orbits >= 1 and self._unbuilt:
            self._add_figures()
        self._arrange()

    def _build_figures(self) -> None:
        if self._unbuilt:
            self._plotted += self._unbuilt.popleft()()
            self._arrange()
            self._add_figures()

    def _arrange(self) -> None:
        plotted = self._plotted if self._orbits >= 1 else []
        parts = [*self._entry, *([*self._head, *plotted, *self._details] if self._starts >= 1 else [])]
        if parts != self._grid.objects:
            self._grid.objects = parts
