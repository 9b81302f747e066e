"""The controls change the view state only when a widget is used."""

from __future__ import annotations

import panel as pn
import pytest

from app.state.view_state import ViewState
from app.views.panels.controls import ControlActions, Controls
from engine import Plane, System
from engine.potentials.review.potential_review import review_system
from engine.potentials.system import TYPED


class Page:
    """Controls with their state, and the calls they made."""

    def __init__(self) -> None:
        self.state = ViewState(case="I", energy=0.19)
        self.controls = Controls(
            self.state,
            ControlActions(
                play=lambda: None,
                choose_potential=lambda: None,
                choose_slice=lambda: None,
                compare=lambda on: None,
                swap=lambda: None,
                lock_times=lambda locked: None,
            ),
        )

    def release_at(self, energy: float) -> None:
        """A message of the browser when the slider is released."""
        self.controls.energy._receive({"energy": energy})


@pytest.fixture
def page() -> Page:
    return Page()


def test_releasing_the_slider_sets_the_energy(page: Page) -> None:
    page.release_at(0.25)
    assert page.state.energy == 0.25


@pytest.mark.parametrize("message", [{"energy": "0.3"}, {"energy": float("nan")}, {}, None])
def test_other_messages_of_the_slider_are_ignored(page: Page, message: object) -> None:
    page.controls.energy._receive(message)
    assert page.state.energy == 0.19


def test_the_slider_chooses_no_energy_beyond_its_ends(page: Page) -> None:
    page.release_at(17.0)
    assert page.state.energy == page.controls.energy.high


def test_an_energy_beyond_the_slider_can_be_typed(page: Page) -> None:
    page.controls.exact_energy._receive({"number": 0.7, "typed": 1})
    assert page.state.energy == 0.7
    assert "beyond the end of the slider" in page.controls.energy.note


def test_another_case_resets_energy_and_orbits(page: Page) -> None:
    page.state.param.update(starts=((0.1, 0.1),))
    page.controls.case.value = "III"
    assert (page.state.case, page.state.energy, page.state.starts) == ("III", 0.35, ())


def test_the_controls_follow_a_preset(page: Page) -> None:
    page.state.param.update(case="II", plane=Plane.X_Y, energy=0.22, t_max=1e3, palette="safe")
    shown = {name: getattr(page.controls, name).value for name in ("case", "plane")}
    assert shown == {"case": "II", "plane": Plane.X_Y}
    assert page.controls.energy.energy == 0.22


def open_quality(page: Page) -> dict[str, pn.widgets.Select]:
    """The lists of the closed fold, by label."""
    parts = page.controls.layout()
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
    parts = page.controls.layout()
    labels = [part.label for part in parts if isinstance(part, pn.widgets.Button)]
    assert {label for label in labels if label[0] in "▸▾"} == {"▸ Quality and colours", "▸ Layers"}


def test_other_potentials_leave_no_case_selected(page: Page) -> None:
    page.state.show_system(review_system(System("I", parameters={"epsilon": 0.5})))
    assert page.controls.case.value == "I"
    page.state.show_system(review_system(System(TYPED, "½(x² + y²) − x²y")))
    assert page.controls.case.value is None
    assert page.controls.other.color == "primary"
    assert page.state.case == TYPED


def test_another_case_writes_no_plane_that_is_shown_already(page: Page) -> None:
    # Panel drops a choice of the browser that waits to be handled when the server writes the widget.
    written: list[object] = []
    page.controls.plane.param.watch(lambda event: written.append(event.new), "value", onlychanged=False)
    page.controls.case.value = "II"
    assert page.state.case == "II"
    assert written == []
