"""Measures of the basins are a table that names their region, and offers to remove the box."""

from __future__ import annotations

import re
from html import escape

import pytest

from app.state.view_state import ViewState
from app.views.analysis.basin_measures import BasinMeasuresView
from engine import CASES, MapSpec, Window, compute_basin_entropy, compute_map
from engine.measures.compute import measure_map
from tests.results import result_of


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
    return re.findall(r"In the (whole view|box)", re.sub(r"<[^>]*>", "", text))


def test_the_measures_of_a_map_are_those_of_the_box(state: ViewState, view: BasinMeasuresView) -> None:
    state.box = Window(0.0, 0.1, 0.0, 0.1)
    assert regions(view) == ["box"]
    assert view.count_whole.visible
    state.box = None
    assert regions(view) == ["whole view"]
    assert not view.count_whole.visible


def test_numbers_have_their_errors_and_sentences_open_on_demand(view: BasinMeasuresView) -> None:
    entropy = compute_basin_entropy(compute_map(MapSpec(CASES["II"], "x_px", 0.25, (40, 40), t_max=100.0)))
    sentence = escape(entropy.describe())
    shown, in_all = (re.sub(r"<[^>]*>", "", text) for text in (view.text.object.partition("</table>")[0], view.text.object))
    assert f"S_b {entropy.s_b:.2f} ± {entropy.s_b_error:.1g}" in shown
    assert sentence not in shown
    assert sentence in in_all


def test_a_measure_without_numbers_has_its_sentence_in_view(state: ViewState) -> None:
    view = BasinMeasuresView(state, lambda name: None, lambda text: None)
    view.show("wada", None)
    assert "Not defined for this map." in view.text.object
    assert "details" not in view.text.object.partition("</table>")[0]


def test_a_measured_exponent_has_its_chart_until_there_is_another_map(view: BasinMeasuresView) -> None:
    view.show("uncertainty_exponent", result_of("exponent"))
    assert "α" in view.text.object
    assert len(view.uncertainty.points.data["y"]) > 5
    assert view.uncertainty.view.visible
    view.begin()
    assert not view.uncertainty.view.visible
