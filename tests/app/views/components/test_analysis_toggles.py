"""AnalysisToggles write to the view state and follow it."""

from __future__ import annotations

from app.state.view_state import SWITCHES, ViewState
from app.views.components.analysis_toggles import LABELS, AnalysisToggles


def test_there_is_a_labelled_switch_for_each_analysis() -> None:
    toggles = AnalysisToggles(ViewState())
    assert list(toggles.switches.options.values()) == list(SWITCHES) == list(LABELS)


def test_a_switch_changes_the_state() -> None:
    state = ViewState()
    AnalysisToggles(state).switches.value = ["trust"]
    assert [name for name in SWITCHES if getattr(state, name)] == ["trust"]


def test_a_switch_follows_the_state() -> None:
    state = ViewState(judge=True)
    toggles = AnalysisToggles(state)
    assert toggles.switches.value == ["judge"]
    state.param.update(judge=False, manifolds=True)
    assert toggles.switches.value == ["manifolds"]
