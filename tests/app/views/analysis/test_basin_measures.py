"""Each measure of the basins names its region; the box can be removed where they stand."""

from __future__ import annotations

import re

import pytest

from app.state.view_state import ViewState
from app.views.analysis.basin_measures import BasinMeasuresView
from engine import CASES, MapSpec, Window, compute_map
from engine.sweeps.points import measure_map


@pytest.fixture
def state() -> ViewState:
    return ViewState()


@pytest.fixture
def view(state: ViewState) -> BasinMeasuresView:
    shown = BasinMeasuresView(state, lambda name: None, lambda text: None)
    frame = compute_map(MapSpec(CASES["II"], "x_px", 0.25, (40, 40), t_max=100.0))
    for name in ("basin_entropy", "wada", "decay_rate"):
        shown.show(name, measure_map(frame, name))
    return shown


def regions(view: BasinMeasuresView) -> list[str]:
    text = re.sub(r"<span[^>]*popover>.*?</span>", "", view.text.object)
    return re.findall(r"in the (whole view|box)", re.sub(r"<[^>]*>", "", text))


def test_without_a_box_all_measures_are_those_of_the_whole_view(view: BasinMeasuresView) -> None:
    assert regions(view) == ["whole view"] * 3
    assert not view.whole.visible


def test_the_measures_of_a_map_are_those_of_the_box(state: ViewState, view: BasinMeasuresView) -> None:
    state.box = Window(0.0, 0.1, 0.0, 0.1)
    assert regions(view) == ["box"] * 3
    assert view.whole.visible
    state.box = None
    assert regions(view) == ["whole view"] * 3
