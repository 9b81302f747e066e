"""The controls change the view state only when a widget is used."""

from __future__ import annotations

import panel as pn
import pytest

from app.state.system_review import review_system
from app.state.view_state import ViewState
from app.views.panels.controls import ControlActions, Controls
from engine import Plane
from engine.service import TYPED, System


class Page:
    """Controls with their state, and the calls they made."""

    def __init__(self) -> None:
        self.state = ViewState(case="I", energy=0.19)
        self.previews: list[float] = []
        self.settled = 0
        self.controls = Controls(
            self.state,
            ControlActions(
                preview=self.previews.append,
                settle=self.settle,
                play=lambda: None,
                choose_potential=lambda: None,
                lock_times=lambda locked: None,
            ),
        )

    def settle(self) -> None:
        self.settled += 1

    def drag_over(self, energy: float) -> None:
        """A message of the browser while the slider is dragged."""
        self.controls.energy._process_events({"value": energy})

    def release_at(self, energy: float) -> None:
        self.controls.energy._process_events({"value": energy, "value_throttled": energy})


@pytest.fixture
def page() -> Page:
    return Page()


def test_dragging_requests_previews_and_keeps_the_state(page: Page) -> None:
    for energy in (0.2, 0.21):
        page.drag_over(energy)
    assert page.previews == [0.2, 0.21]
    assert page.state.energy == 0.19


def test_releasing_the_slider_sets_the_energy_without_another_preview(page: Page) -> None:
    page.drag_over(0.2)
    page.release_at(0.25)
    assert page.state.energy == 0.25
    assert page.previews == [0.2]


def test_an_energy_of_the_slider_has_no_rounding_error(page: Page) -> None:
    page.drag_over(0.21000000000000002)
    page.release_at(0.45999999999999996)
    assert page.state.energy == 0.46
    assert page.previews == [0.21]


def test_dragging_back_shows_the_map_again(page: Page) -> None:
    page.drag_over(0.2)
    page.drag_over(0.19)
    assert page.settled == 1
    assert page.state.energy == 0.19


def test_an_animation_moves_only_the_slider(page: Page) -> None:
    for energy in (0.2, 0.21):
        page.controls.show_animated(energy)
    assert page.controls.energy.value == 0.21
    assert page.state.energy == 0.19
    assert page.previews == []


def test_after_an_animation_an_energy_that_it_passed_can_be_chosen(page: Page) -> None:
    page.controls.show_animated(0.21)
    page.state.energy = 0.22
    page.release_at(0.21)
    assert page.state.energy == 0.21


def test_an_energy_beyond_the_slider_can_be_typed(page: Page) -> None:
    page.controls.exact_energy._receive({"number": 0.7, "typed": 1})
    assert page.state.energy == 0.7
    assert page.controls.energy.value == page.controls.energy.end


def test_another_case_resets_energy_and_orbits(page: Page) -> None:
    page.state.param.update(starts=((0.1, 0.1),))
    page.controls.case.value = "III"
    assert (page.state.case, page.state.energy, page.state.starts) == ("III", 0.35, ())


def test_the_controls_follow_a_preset(page: Page) -> None:
    page.state.param.update(case="II", plane=Plane.X_Y, energy=0.22, t_max=1e3, palette="safe")
    shown = {name: getattr(page.controls, name).value for name in ("case", "plane", "energy")}
    assert shown == {"case": "II", "plane": Plane.X_Y, "energy": 0.22}


def open_quality(page: Page) -> dict[str, pn.widgets.Select]:
    """The lists of the closed fold, by label."""
    parts = page.controls.layout(pn.pane.HTML())
    fold = next(part for part in parts if isinstance(part, pn.widgets.Button) and "Quality" in part.label)
    assert fold.label == "▸ Quality and colours"
    fold.clicks += 1
    section = parts[parts.index(fold) + 1]
    return {part.label: part for part in section.objects if isinstance(part, pn.widgets.Select)}


def test_the_lists_follow_a_preset(page: Page) -> None:
    lists = open_quality(page)
    page.state.param.update(t_max=1e3, resolution=112, palette="safe")
    assert {label: box.value for label, box in lists.items()} == {"t_max": 1e3, "Resolution": 112, "Colours": "safe"}


def test_the_lists_change_the_state(page: Page) -> None:
    lists = open_quality(page)
    for label, value in (("t_max", 1e4), ("Resolution", 450), ("Colours", "safe")):
        lists[label].value = value
    assert (page.state.t_max, page.state.resolution, page.state.palette) == (1e4, 450, "safe")


def test_on_a_touch_device_all_folds_are_closed(page: Page) -> None:
    page.controls.begin_touch()
    parts = page.controls.layout(pn.pane.HTML())
    labels = [part.label for part in parts if isinstance(part, pn.widgets.Button)]
    assert {label for label in labels if label[0] in "▸▾"} == {"▸ Quality and colours", "▸ Layers"}


def test_other_potentials_leave_no_case_selected(page: Page) -> None:
    page.state.show_system(review_system(System("I", epsilon=0.5)))
    assert page.controls.case.value == "I"
    page.state.show_system(review_system(System(TYPED, "½(x² + y²) − x²y")))
    assert page.controls.case.value is None
    assert page.controls.other.color == "primary"
    assert page.state.case == TYPED
