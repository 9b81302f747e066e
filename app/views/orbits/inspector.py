"""The inspector of the orbits. It is built for the first orbit, and shown while there are orbits."""

from __future__ import annotations

from collections.abc import Sequence

import panel as pn

from app.browser.components.orbit_components import OrbitPlayer
from app.views.components.collapsible_section import InTurns, Later
from app.views.components.widgets import FULL_HEIGHT
from app.views.orbits.orbit_controls import OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot


class Inspector:
    """Arranges the verdict on the chosen orbit, the player, histories, indicators and values, and the boxes to type a start.

    Parameters
    ----------
    controls, player, plots, separation
        The parts of the inspector.
    later
        Wraps a function to run in a later iteration of the event loop. Texts and figures are made later than the inspector.
    """

    def __init__(
        self, controls: OrbitControls, player: OrbitPlayer, plots: OrbitPlots, separation: SeparationPlot, later: Later
    ) -> None:
        self._controls, self._player = controls, player
        self._start_count = 0
        self._orbit_count = 0
        self._head: list[pn.viewable.Viewable] = []
        self._details: list[pn.viewable.Viewable] = []
        self._figure_panes: list[pn.viewable.Viewable] = []
        self._build_later = later(self._build_texts)
        self._figures_in_turns = InTurns([*plots.parts(), separation.build], self._add_figures, later)
        self._boxes = controls.start_boxes()
        self._grid = pn.Column(
            controls.note, *self._boxes, sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["inspector"]
        )

    def layout(self) -> pn.viewable.Viewable:
        """Return the inspector."""
        return self._grid

    def follow(self, start_count: int, orbit_count: int) -> None:
        """Show the panes that are needed for a number of starts, and for the orbits among them."""
        self._start_count, self._orbit_count = start_count, orbit_count
        if start_count >= 1 and not self._head:
            self._build_later()
        if orbit_count >= 1:
            self._figures_in_turns.begin()
        self._arrange()

    def _build_texts(self) -> None:
        if not self._head:
            self._head, self._details = [self._controls.head(self._player)], self._controls.details()
            self._arrange()

    def _add_figures(self, figures: Sequence[pn.viewable.Viewable]) -> None:
        self._figure_panes += figures
        self._arrange()

    def _arrange(self) -> None:
        has_starts = self._start_count >= 1
        figures = self._figure_panes if self._orbit_count >= 1 else []
        results = [*figures, *self._details] if has_starts else []
        parts = [*(self._head if has_starts else []), self._controls.note, *results, *self._boxes]
        if parts != self._grid.objects:
            self._grid.objects = parts
