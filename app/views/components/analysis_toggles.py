"""Switches for everything that is computed or shown on demand."""

from __future__ import annotations

from typing import Any

import panel as pn

from app.state.view_state import SWITCHES, ViewState
from app.views.components.widgets import Switches

LABELS = {
    "judge": "Regular or chaotic",
    "trust": "Pixels to trust",
    "manifolds": "Stable manifolds",
    "origins": "Origin and exit",
    "statistics": "Statistics",
    "measures": "Basin measures",
    "energies": "Against energy",
}
"""Of the switches of a view state."""


class AnalysisToggles:
    """A widget that writes to the view state and follows it."""

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self.switches = Switches(label="Analyses", options={LABELS[name]: name for name in SWITCHES}, value=self._on())
        self.switches.param.watch(self._write, "value")
        state.param.watch(lambda *events: self.switches.param.update(value=self._on()), list(SWITCHES))

    def layout(self) -> pn.viewable.Viewable:
        """The switches in a row that wraps."""
        return self.switches

    def _on(self) -> list[str]:
        return [name for name in SWITCHES if getattr(self._state, name)]

    def _write(self, event: Any) -> None:
        with pn.io.hold():
            self._state.param.update({name: name in event.new for name in SWITCHES})
