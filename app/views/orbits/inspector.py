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
        self._controls = controls
        self._start_count = 0
        self._orbit_count = 0
        self._texts: list[pn.viewable.Viewable] = []
        self._figure_panes: list[pn.viewable.Viewable] = []
        self._boxes = controls.start_boxes()
        self._texts_in_turns = InTurns([lambda: [controls.head(player)], lambda: [controls.details()]], self._add_texts, later)
        self._figures_in_turns = InTurns([*plots.parts(), separation.build], self._add_figures, later)
        self._grid = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT)
        self._arrange()
        self._show_parts()

    def layout(self) -> pn.viewable.Viewable:
        """Return the inspector."""
        return self._grid

    def follow(self, start_count: int, orbit_count: int) -> None:
        """Show the panes that are needed for a number of starts, and for the orbits among them."""
        self._start_count, self._orbit_count = start_count, orbit_count
        if start_count >= 1:
            self._texts_in_turns.begin()
        if orbit_count >= 1:
            self._figures_in_turns.begin()
        self._show_parts()

    def _add_texts(self, texts: Sequence[pn.viewable.Viewable]) -> None:
        self._texts += texts
        self._arrange()
        self._show_parts()

    def _add_figures(self, figures: Sequence[pn.viewable.Viewable]) -> None:
        self._figure_panes += figures
        self._arrange()

    def _arrange(self) -> None:
        self._grid.objects = [*self._texts[:1], self._controls.note, *self._figure_panes, *self._texts[1:], *self._boxes]

    def _show_parts(self) -> None:
        """Show or hide what is made. Figures stay in the document, because adding a figure takes up to a tenth of a second."""
        for part in self._texts:
            part.visible = self._start_count >= 1
        self._grid.css_classes = ["inspector", *([] if self._orbit_count >= 1 else ["without-orbits"])]
