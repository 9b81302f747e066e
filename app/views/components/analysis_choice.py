"""The choice of analyses: layers over the maps, and what is shown below them."""

from __future__ import annotations

from typing import Any

import panel as pn

from app.state.view_state import LAYERS, Analysis, ViewState
from app.views.components.widgets import SegmentedControl, Switches

LAYER_LABELS = {
    "judge": "Regular or chaotic",
    "trust": "Pixels to trust",
    "manifolds": "Stable manifolds",
    "origins": "Origin and exit",
}
"""Of the layers of a view state."""

ANALYSIS_LABELS = {
    Analysis.NONE: "No analysis",
    Analysis.STATISTICS: "Statistics",
    Analysis.MEASURES: "Basin measures",
    Analysis.ENERGIES: "Against energy",
}
"""Of the analyses below the maps."""


class LayerSwitches:
    """Switches that write to the view state and follow it."""

    def __init__(self, state: ViewState) -> None:
        self._state = state
        options = {LAYER_LABELS[name]: name for name in LAYERS}
        self.switches = Switches(label="Layers", options=options, value=self._on(), margin=(0, 10))
        self.switches.param.watch(self._write, "value")
        state.param.watch(lambda *events: self.switches.param.update(value=self._on()), list(LAYERS))

    def _on(self) -> list[str]:
        return [name for name in LAYERS if getattr(self._state, name)]

    def _write(self, event: Any) -> None:
        with pn.io.hold():
            self._state.param.update({name: name in event.new for name in LAYERS})


class AnalysisTabs:
    """A segmented control that writes to the view state and follows it."""

    def __init__(self, state: ViewState) -> None:
        self.tabs = SegmentedControl(
            label="Analysis", options={label: analysis for analysis, label in ANALYSIS_LABELS.items()}, value=state.analysis
        )
        self.tabs.param.watch(lambda event: state.param.update(analysis=event.new), "value")
        state.param.watch(lambda event: self.tabs.param.update(value=event.new), "analysis")
