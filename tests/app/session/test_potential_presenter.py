"""Choice of a potential: validation, use, and messages for invalid ones."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import param
import pytest

from app.session.potential_presenter import PotentialPresenter
from app.state.system_review import review_system
from app.state.view_state import ViewState
from app.views.analysis.potential_panel import PotentialPanel
from engine import CASES
from engine.service import TYPED, Jobs, System

HENON_HEILES = "½(x² + y²) + x²y − y³/3"
VALLEY = "x²y²"
# Case I with its well at (1, 0).
WELL_ELSEWHERE = "((x−1)² + y²)/2 − (x−1)y²"


def at_once(callback: Callable[..., Any], **_: Any) -> Callable[..., Any]:
    return callback


def wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 20.0
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    assert condition()


@pytest.fixture
def choice() -> Iterator[PotentialPresenter]:
    made = PotentialPresenter(ViewState(case="I", energy=0.25, starts=((0.1, 0.1),)), Jobs(), at_once)
    yield made
    made.close()


def state_of(choice: PotentialPresenter) -> ViewState:
    return choice._state


def type_in(panel: PotentialPanel, text: str, *, enter: bool) -> None:
    panel.formula.value_input = text
    if enter:
        panel.formula.value = text


def test_a_typed_potential_is_reviewed_and_not_used_before_enter(choice: PotentialPresenter) -> None:
    type_in(choice.panel, HENON_HEILES, enter=False)
    wait_for(lambda: "0.166667" in choice.panel.facts.object)
    assert "(0, 1)" in choice.panel.facts.object
    assert state_of(choice).case == "I"


def test_enter_uses_it_at_its_initial_energy_without_starts(choice: PotentialPresenter) -> None:
    type_in(choice.panel, HENON_HEILES, enter=True)
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert (state.formula, state.energy, state.starts) == (HENON_HEILES, 0.25, ())
    assert choice.panel.known.value == TYPED


def test_an_invalid_formula_gives_an_escaped_message(choice: PotentialPresenter) -> None:
    type_in(choice.panel, "x² + <b>", enter=True)
    wait_for(lambda: "character 6" in choice.panel.message.object)
    assert "<b>" not in choice.panel.message.object
    assert state_of(choice).case == "I"


def test_a_refused_text_stays_with_its_reason_and_its_points(choice: PotentialPresenter) -> None:
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: "no well at the origin" in choice.panel.message.object)
    assert (choice.panel.formula.value_input, choice.panel.formula.value) == (WELL_ELSEWHERE, WELL_ELSEWHERE)
    assert "The maps still show Case I: V = ½(x² + y²) − xy²" in choice.panel.message.object
    assert "<td>minimum</td><td>(1, 0)</td>" in choice.panel.facts.object
    assert (choice.panel.known.value, state_of(choice).case) == (TYPED, "I")


def test_a_well_elsewhere_can_be_moved_to_the_origin(choice: PotentialPresenter) -> None:
    choice.toggle()
    assert not choice.panel.move.visible
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    choice.panel.move.clicks += 1
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert choice.panel.formula.value == "x²/2 + y²/2 − xy²"
    assert sorted(state.potential.terms) == sorted(CASES["I"].terms)
    wait_for(lambda: not choice.panel.move.visible)
    assert choice.panel.message.object == ""


def test_a_syntax_error_removes_the_table(choice: PotentialPresenter) -> None:
    type_in(choice.panel, WELL_ELSEWHERE, enter=False)
    wait_for(lambda: choice.panel.move.visible)
    type_in(choice.panel, WELL_ELSEWHERE + " +", enter=False)
    wait_for(lambda: "ends where" in choice.panel.message.object)
    assert (choice.panel.facts.object, choice.panel.move.visible) == ("", False)


@pytest.mark.parametrize("enter", [True, False])
def test_an_empty_box_is_an_error(choice: PotentialPresenter, enter: bool) -> None:
    type_in(choice.panel, "", enter=enter)
    wait_for(lambda: "ends where" in choice.panel.message.object)


def test_a_text_beyond_the_limit_is_not_cut(choice: PotentialPresenter) -> None:
    text = "½r² + " + "+".join(["xy²"] * 200)
    type_in(choice.panel, text, enter=True)
    wait_for(lambda: f"the text has {len(text)} characters; at most 500 characters" in choice.panel.message.object)
    assert choice.panel.formula.value == text


def test_a_valid_text_says_that_enter_uses_it(choice: PotentialPresenter) -> None:
    type_in(choice.panel, HENON_HEILES, enter=False)
    wait_for(lambda: "Press Enter" in choice.panel.message.object)
    assert "The maps still show Case I" in choice.panel.message.object


def test_typing_the_formula_of_the_maps_again_shows_its_points(choice: PotentialPresenter) -> None:
    text = choice.panel.formula.value
    type_in(choice.panel, "x +", enter=False)
    type_in(choice.panel, text, enter=False)
    wait_for(lambda: choice.panel.message.object == "")
    assert "2 channels" in choice.panel.facts.object
    assert choice.panel.known.value == "I"


def test_the_potential_of_the_maps_can_be_selected_again(choice: PotentialPresenter) -> None:
    text = choice.panel.formula.value
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    choice.panel.known.value = "I"
    wait_for(lambda: choice.panel.message.object == "")
    assert choice.panel.formula.value == text
    assert state_of(choice).starts == ((0.1, 0.1),)


def test_a_new_system_of_the_maps_replaces_a_refused_text(choice: PotentialPresenter) -> None:
    choice.toggle()
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    state_of(choice).show_system(review_system(System("III")))
    wait_for(lambda: "4 channels" in choice.panel.facts.object)
    assert (choice.panel.known.value, choice.panel.message.object, choice.panel.move.visible) == ("III", "", False)


def test_a_closed_section_keeps_a_refused_text(choice: PotentialPresenter) -> None:
    choice.toggle()
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    choice.toggle()
    choice.toggle()
    wait_for(lambda: "no well at the origin" in choice.panel.message.object)
    assert choice.panel.formula.value == WELL_ELSEWHERE


def test_a_potential_without_exits_gives_a_message(choice: PotentialPresenter) -> None:
    type_in(choice.panel, VALLEY, enter=True)
    wait_for(lambda: "valley" in choice.panel.message.object)
    assert state_of(choice).case == "I"
    assert not choice.panel.move.visible


def test_a_known_potential_can_be_selected(choice: PotentialPresenter) -> None:
    choice.panel.known.value = "C5"
    state = state_of(choice)
    wait_for(lambda: state.case == "C5")
    assert state.potential.channels == 5
    assert state.energy == pytest.approx(0.45)


def test_a_parameter_keeps_the_ratio_to_the_escape_energy(choice: PotentialPresenter) -> None:
    slider = choice.panel.sliders["epsilon"]
    with param.edit_constant(slider):
        slider.value_throttled = 0.5
    state = state_of(choice)
    wait_for(lambda: state.epsilon == 0.5)
    assert state.energy / state.potential.escape_energy == pytest.approx(0.25 / CASES["I"].escape_energy, rel=1e-2)


def test_all_parameters_can_be_reset(choice: PotentialPresenter) -> None:
    state = state_of(choice)
    state.show_system(review_system(System("III", omega_1=1.1, epsilon=0.5)))
    assert choice.panel.sliders["epsilon"].value == 0.5
    choice.panel.reset.clicks += 1
    wait_for(lambda: not state.system.changed)
    assert state.case == "III"


def test_typing_starts_from_the_current_formula(choice: PotentialPresenter) -> None:
    choice.panel.known.value = TYPED
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert state.potential == CASES["I"]


def test_typing_starts_from_coefficients_without_rounding_errors(choice: PotentialPresenter) -> None:
    state = state_of(choice)
    state.show_system(review_system(System("I", omega_1=1.46, epsilon=0.7)))
    before = state.potential
    choice.panel.known.value = TYPED
    wait_for(lambda: state.case == TYPED)
    assert state.formula == "1.0658x² + y²/2 − 7xy²/10"
    for (i, j, c), (k, m, expected) in zip(sorted(state.potential.terms), sorted(before.terms), strict=True):
        assert (i, j) == (k, m)
        assert c == pytest.approx(expected, rel=5e-12)


def test_the_event_of_the_last_letter_may_arrive_after_enter(choice: PotentialPresenter) -> None:
    choice.panel.formula.value = "½(x² + y²) − 0.6x²y²"
    choice.panel.formula.value_input = "½(x² + y²) − 0.6x²y²"
    wait_for(lambda: state_of(choice).system.case == "typed")
