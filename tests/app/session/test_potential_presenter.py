"""Choice of a potential: validation, use, and messages for invalid ones."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from app.session import potential_presenter as presenter_module
from app.session.potential_presenter import PotentialPresenter
from app.state.history import History
from app.state.view_state import ViewState
from app.views.analysis.potential_panel import PotentialPanel
from engine import CASES, System
from engine.jobs.manager import Jobs
from engine.potentials.review.potential_review import review_system
from engine.potentials.system import TYPED

HENON_HEILES = "½(x² + y²) + x²y − y³/3"
WEAKER = "½(x² + y²) − 0.5xy²"
NEWER = {"text": WEAKER, "typed": 2, "done": False}
# The channels 1 and 3 merge at h = 0.5.
CHANNELS_THAT_MERGE = "½(x² + y²) − xy² − x⁴/8"
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
    made = PotentialPresenter(ViewState(case="I", energy=0.25, starts=((0.1, 0.1),)), Jobs(), History(), at_once)
    yield made
    made.close()


@pytest.fixture
def with_kernels(monkeypatch: pytest.MonkeyPatch) -> None:
    """The integrators of all potentials are compiled."""
    monkeypatch.setattr(presenter_module, "is_ready_for_maps", lambda potential: True)


def state_of(choice: PotentialPresenter) -> ViewState:
    return choice._state


def type_in(panel: PotentialPanel, text: str, *, enter: bool) -> None:
    panel.formula._receive({"text": text, "typed": 1, "done": enter})


def slide(panel: PotentialPanel, name: str, number: float, *, done: bool) -> None:
    panel.sliders[name]._receive({"number": number, "chosen": 1, "done": done})


def test_a_text_is_used_while_it_is_typed(choice: PotentialPresenter, with_kernels: None) -> None:
    type_in(choice.panel, HENON_HEILES, enter=False)
    state = state_of(choice)
    wait_for(lambda: state.formula == HENON_HEILES)
    assert "3 channels above the escape energy h = 0.166667" in choice.panel.message.object
    assert "(0, 1)" in choice.panel.facts.object


def test_a_text_that_needs_another_integrator_waits_for_enter(
    choice: PotentialPresenter, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(presenter_module, "is_ready_for_maps", lambda potential: False)
    type_in(choice.panel, HENON_HEILES, enter=False)
    wait_for(lambda: "Press Enter" in choice.panel.message.object)
    assert "The maps still show Case I" in choice.panel.message.object
    assert state_of(choice).case == "I"
    type_in(choice.panel, HENON_HEILES, enter=True)
    wait_for(lambda: state_of(choice).case == TYPED)


def test_the_text_is_not_replaced_while_it_is_typed(choice: PotentialPresenter, with_kernels: None) -> None:
    state_of(choice).param.watch(lambda event: choice.panel.formula._receive(NEWER), "formula")
    type_in(choice.panel, HENON_HEILES, enter=False)
    wait_for(lambda: state_of(choice).formula == NEWER["text"])
    assert choice.panel.formula.shown == {"text": NEWER["text"], "typed": 2}


def test_a_text_is_used_at_the_same_ratio_to_the_escape_energy_without_starts(choice: PotentialPresenter) -> None:
    type_in(choice.panel, WEAKER, enter=True)
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert (state.formula, state.energy, state.starts) == (WEAKER, 1.0, ())
    assert choice.panel.known.value == TYPED


def test_a_text_typed_during_a_review_is_used_after_it(choice: PotentialPresenter, with_kernels: None) -> None:
    state, used = state_of(choice), list[str]()
    state.param.watch(lambda event: used.append(event.new), "formula")
    for text in (HENON_HEILES, WEAKER):
        type_in(choice.panel, text, enter=False)
    wait_for(lambda: state.formula == WEAKER)
    assert used == [HENON_HEILES, WEAKER]


def test_another_text_of_the_same_potential_changes_the_link_only(choice: PotentialPresenter) -> None:
    type_in(choice.panel, "½(x² + y²) − x y y", enter=True)
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert (state.energy, state.starts) == (0.25, ((0.1, 0.1),))


def test_a_ratio_beyond_the_highest_energy_gives_the_initial_energy(choice: PotentialPresenter) -> None:
    state = state_of(choice)
    state.energy = 5.0
    type_in(choice.panel, CHANNELS_THAT_MERGE, enter=True)
    wait_for(lambda: state.case == TYPED)
    assert state.energy == state.energies.first


def test_all_that_is_typed_until_enter_is_one_entry_of_the_history(choice: PotentialPresenter, with_kernels: None) -> None:
    state, history = state_of(choice), choice._history
    entries: list[int] = []
    state.param.watch(lambda event: entries.append(history.record()), "formula")
    for text, enter in ((HENON_HEILES, False), (WEAKER, False), (WEAKER, True), (HENON_HEILES, True)):
        type_in(choice.panel, text, enter=enter)
        wait_for(lambda text=text: state.formula == text and choice._proposal is None)
    assert entries == [1, 1, 2]


def test_an_invalid_formula_gives_an_escaped_message(choice: PotentialPresenter) -> None:
    type_in(choice.panel, "x² + <b>", enter=True)
    wait_for(lambda: "character 6" in choice.panel.message.object)
    assert "<b>" not in choice.panel.message.object
    assert state_of(choice).case == "I"


def test_a_refused_text_stays_with_its_reason_and_its_points(choice: PotentialPresenter) -> None:
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: "no well at the origin" in choice.panel.message.object)
    assert choice.panel.formula.text == WELL_ELSEWHERE
    assert "The maps still show Case I: V = ½(x² + y²) − xy²" in choice.panel.message.object
    assert "<td>minimum</td><td>(1, 0)</td>" in choice.panel.facts.object
    assert (choice.panel.known.value, state_of(choice).case) == (TYPED, "I")


def test_a_well_elsewhere_can_be_used(choice: PotentialPresenter) -> None:
    assert not choice.panel.move.visible
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    choice.panel.move.clicks += 1
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert choice.panel.formula.text == f"{WELL_ELSEWHERE}; well (1, 0)"
    assert sorted(state.potential.terms) == sorted(CASES["I"].terms)
    wait_for(lambda: not choice.panel.move.visible)
    assert "alert" not in choice.panel.message.object
    assert "x and y count from the well at (1, 0)" in choice.panel.facts.object


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
    assert choice.panel.formula.text == text


def test_typing_the_formula_of_the_maps_again_shows_its_points(choice: PotentialPresenter) -> None:
    text = choice.panel.formula.text
    type_in(choice.panel, "x +", enter=False)
    type_in(choice.panel, text, enter=False)
    wait_for(lambda: "2 channels" in choice.panel.message.object)
    assert "<td>saddle</td>" in choice.panel.facts.object
    assert choice.panel.known.value == "I"


def test_the_potential_of_the_maps_can_be_selected_again(choice: PotentialPresenter) -> None:
    text = choice.panel.formula.text
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    choice.panel.known.value = "I"
    wait_for(lambda: "2 channels" in choice.panel.message.object)
    assert choice.panel.formula.text == text
    assert state_of(choice).starts == ((0.1, 0.1),)


def test_a_new_system_of_the_maps_replaces_a_refused_text(choice: PotentialPresenter) -> None:
    type_in(choice.panel, WELL_ELSEWHERE, enter=True)
    wait_for(lambda: choice.panel.move.visible)
    state_of(choice).show_system(review_system(System("III")))
    assert "4 channels" in choice.panel.message.object
    assert (choice.panel.known.value, choice.panel.move.visible) == ("III", False)


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
    slide(choice.panel, "epsilon", 0.5, done=True)
    state = state_of(choice)
    wait_for(lambda: state.system.parameters.get("epsilon") == 0.5)
    assert state.energy / state.potential.escape_energy == pytest.approx(0.25 / CASES["I"].escape_energy, rel=1e-2)


def test_a_slider_that_moves_on_during_a_review_is_not_set_back(choice: PotentialPresenter, with_kernels: None) -> None:
    later = {"number": 0.7, "chosen": 2, "done": True}
    state_of(choice).param.watch(lambda event: choice.panel.sliders["epsilon"]._receive(later), "parameters")
    slide(choice.panel, "epsilon", 0.5, done=False)
    wait_for(lambda: state_of(choice).system.parameters.get("epsilon") == 0.7)
    assert choice.panel.sliders["epsilon"].shown == {"number": 0.7, "chosen": 2}


def test_a_typed_formula_keeps_the_parameters(choice: PotentialPresenter) -> None:
    slide(choice.panel, "omega_1", 1.13, done=True)
    type_in(choice.panel, WEAKER, enter=True)
    wait_for(lambda: state_of(choice).case == TYPED)
    assert state_of(choice).parameters["omega_1"] == 1.13


def test_all_parameters_can_be_reset(choice: PotentialPresenter) -> None:
    state = state_of(choice)
    state.show_system(review_system(System("III", parameters={"omega_1": 1.1, "epsilon": 0.5})))
    assert choice.panel.sliders["epsilon"].shown["number"] == 0.5
    choice.panel.reset.clicks += 1
    wait_for(lambda: not state.system.parameters)
    assert state.case == "III"


def test_typing_starts_from_the_current_formula(choice: PotentialPresenter) -> None:
    choice.panel.known.value = TYPED
    state = state_of(choice)
    wait_for(lambda: state.case == TYPED)
    assert state.potential == CASES["I"]


def test_typing_starts_from_coefficients_without_rounding_errors(choice: PotentialPresenter) -> None:
    state = state_of(choice)
    state.show_system(review_system(System("I", parameters={"omega_1": 1.46, "epsilon": 0.7})))
    before = state.potential
    choice.panel.known.value = TYPED
    wait_for(lambda: state.case == TYPED)
    assert state.formula == "1.0658x² + y²/2 − 0.7xy²"
    for (i, j, c), (k, m, expected) in zip(sorted(state.potential.terms), sorted(before.terms), strict=True):
        assert (i, j) == (k, m)
        assert c == pytest.approx(expected, rel=5e-12)
