"""The choice of analyses writes to the view state and follows it."""

from __future__ import annotations

from app.state.view_state import LAYERS, Analysis, ViewState
from app.views.components.analysis_choice import ANALYSIS_LABELS, LAYER_LABELS, AnalysisTabs, LayerSwitches


def test_there_is_a_labelled_switch_for_each_layer() -> None:
    switches = LayerSwitches(ViewState()).switches
    assert list(switches) == list(LAYERS) == list(LAYER_LABELS)
    assert [switch.options for switch in switches.values()] == [[label] for label in LAYER_LABELS.values()]


def test_a_switch_changes_the_state() -> None:
    state = ViewState()
    LayerSwitches(state).switches["trust"].value = [LAYER_LABELS["trust"]]
    assert [name for name in LAYERS if getattr(state, name)] == ["trust"]


def test_the_switches_follow_the_state() -> None:
    state = ViewState(judge=True)
    layers = LayerSwitches(state)
    assert [name for name, switch in layers.switches.items() if switch.value] == ["judge"]
    state.param.update(judge=False, manifolds=True)
    assert [name for name, switch in layers.switches.items() if switch.value] == ["manifolds"]


def test_there_is_a_labelled_tab_for_each_analysis() -> None:
    assert list(AnalysisTabs(ViewState()).tabs.options.values()) == list(Analysis) == list(ANALYSIS_LABELS)


def test_a_tab_changes_the_state() -> None:
    state = ViewState()
    AnalysisTabs(state).tabs.value = Analysis.MEASURES
    assert state.analysis is Analysis.MEASURES


def test_the_tabs_follow_the_state() -> None:
    state = ViewState(analysis=Analysis.ENERGIES)
    tabs = AnalysisTabs(state).tabs
    assert tabs.value is Analysis.ENERGIES
    state.analysis = Analysis.STATISTICS
    assert tabs.value is Analysis.STATISTICS
