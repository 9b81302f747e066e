"""AnalysisToggles write into the view state and follow it."""

from __future__ import annotations

from app.state.view_state import SWITCHES, ViewState
from app.views.components.analysis_toggles import LABELS, AnalysisToggles


def test_there_is_a_labelled_switch_for_each() -> None:
    switches = AnalysisToggles(ViewState())
    assert list(switches.widgets) == list(SWITCHES) == list(LABELS)


def test_a_switch_writes_into_the_state() -> None:
    state = ViewState()
    AnalysisToggles(state).widgets["trust"].value = True
    assert [name for name in SWITCHES if getattr(state, name)] == ["trust"]


def test_a_switch_follows_the_state() -> None:
    state = ViewState(judge=True)
    switches = AnalysisToggles(state)
    state.param.update(judge=False, manifolds=True)
    assert [name for name, widget in switches.widgets.items() if widget.value] == ["manifolds"]
