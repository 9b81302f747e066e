"""The controls write wishes into the view state, and only wishes."""

from __future__ import annotations

import pytest

from app.state.view_state import ViewState
from app.views.panels.controls import ControlActions, Controls
from engine import Plane


class Page:
    """Controls with their state, and what they asked for."""

    def __init__(self) -> None:
        self.state = ViewState(case="I", energy=0.19)
        self.looks: list[float] = []
        self.settled = 0
        self.controls = Controls(
            self.state,
            ControlActions(look=self.looks.append, settle=self.settle, play=lambda: None, choose_potential=lambda: None),
        )

    def settle(self) -> None:
        self.settled += 1

    def drag_over(self, energy: float) -> None:
        """As the browser tells it: the value moves, and is not yet let go of."""
        self.controls.energy._process_events({"value": energy})

    def let_go(self, energy: float) -> None:
        self.controls.energy._process_events({"value": energy, "value_throttled": energy})


@pytest.fixture
def page() -> Page:
    return Page()


def test_a_drag_looks_at_what_it_passes_and_changes_nothing(page: Page) -> None:
    for energy in (0.2, 0.21):
        page.drag_over(energy)
    assert page.looks == [0.2, 0.21]
    assert page.state.energy == 0.19


def test_letting_go_sets_the_energy_without_another_look(page: Page) -> None:
    page.drag_over(0.2)
    page.let_go(0.25)
    assert page.state.energy == 0.25
    assert page.looks == [0.2]


def test_a_drag_back_settles(page: Page) -> None:
    page.drag_over(0.2)
    page.drag_over(0.19)
    assert page.settled == 1
    assert page.state.energy == 0.19


def test_a_sweep_moves_the_slider_and_nothing_else(page: Page) -> None:
    page.controls.show_playing(True)
    for energy in (0.2, 0.21):
        page.controls.show_passing(energy)
    assert page.controls.energy.value == 0.21
    assert page.state.energy == 0.19
    assert page.looks == []


def test_what_the_browser_says_late_of_a_sweep_is_no_wish(page: Page) -> None:
    page.controls.show_playing(True)
    for energy in (0.2123, 0.2155, 0.2187):
        page.controls.show_passing(energy)
    page.let_go(0.2123)
    page.controls.show_playing(False)
    page.let_go(0.2155)
    assert page.state.energy == 0.19


def test_after_a_sweep_an_energy_that_it_passed_can_be_chosen(page: Page) -> None:
    page.controls.show_playing(True)
    page.controls.show_passing(0.21)
    page.controls.show_playing(False)
    page.state.energy = 0.22
    page.let_go(0.21)
    assert page.state.energy == 0.21


def test_an_energy_beyond_the_slider_stays_as_typed(page: Page) -> None:
    page.controls.exact_energy.value = 0.7
    assert page.state.energy == 0.7
    assert page.controls.energy.value == page.controls.energy.end


def test_another_case_begins_anew(page: Page) -> None:
    page.state.param.update(starts=((0.1, 0.1),))
    page.controls.case.value = "III"
    assert (page.state.case, page.state.energy, page.state.starts) == ("III", 0.35, ())


def test_the_controls_follow_a_preset(page: Page) -> None:
    page.state.param.update(case="II", plane=Plane.X_Y, energy=0.22, t_max=1e3, palette="safe")
    shown = {name: getattr(page.controls, name).value for name in ("case", "plane", "energy", "t_max", "palette")}
    assert shown == {"case": "II", "plane": Plane.X_Y, "energy": 0.22, "t_max": 1e3, "palette": "safe"}
