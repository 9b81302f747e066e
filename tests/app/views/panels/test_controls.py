"""The controls change the view state only when a widget is used."""

from __future__ import annotations

import panel as pn
import pytest
from panel.widgets import Widget

from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from app.views.components.widgets import Switches
from app.views.panels.controls import LOCK_SCALE, Controls
from engine import System
from engine.systems.system import TYPED
from plots.pictures.time_scale import TimeScale
from tests.app.map_actions import make_browser_engine


class Page:
    """Controls with their state, and the calls that they made."""

    def __init__(self) -> None:
        self.locks: list[bool] = []
        self.state = ViewState(system=System("I"), energy=0.19)
        engine = make_browser_engine(self.state)
        self.controls = Controls(self.state, engine, lambda name: None, lambda: None, self.locks.append)


@pytest.fixture
def page() -> Page:
    return Page()


def test_another_case_resets_energy_and_orbits(page: Page) -> None:
    page.state.param.update(starts=((0.1, 0.1),))
    page.controls.case.value = "III"
    assert (page.state.system.case, page.state.energy, page.state.starts) == ("III", 0.35, ())


def open_quality(page: Page) -> dict[str, Widget]:
    """Return the widgets of the closed fold, by label."""
    parts = page.controls.layout()
    fold = next(part for part in parts if isinstance(part, pn.widgets.Button) and "Quality" in part.label)
    assert fold.label == "▸ Quality and colours"
    fold.clicks += 1
    section = parts[parts.index(fold) + 1]
    return {
        LOCK_SCALE if isinstance(part, Switches) else part.label: part for part in section.objects if isinstance(part, Widget)
    }


def test_the_lists_change_the_state_and_follow_a_preset(page: Page) -> None:
    lists = open_quality(page)
    shown = {"t_max": 1e3, "Resolution": 112, "Colours": "safe"}
    page.state.param.update(t_max=1e3, resolution=112, palette="safe")
    assert {label: lists[label].value for label in shown} == shown
    for label, value in (("t_max", 1e4), ("Resolution", 450), ("Colours", "paper")):
        lists[label].value = value
    assert (page.state.t_max, page.state.resolution, page.state.palette) == (1e4, 450, "paper")


def test_the_lock_asks_for_the_limits_of_the_map_and_follows_the_state(page: Page) -> None:
    lock = open_quality(page)[LOCK_SCALE]
    lock.value = [LOCK_SCALE]
    assert page.locks == [True]
    page.state.lock_times = TimeScale(1.0, 500.0)
    page.state.lock_times = None
    assert (lock.value, page.locks) == ([], [True])
    page.state.lock_times = TimeScale(1.0, 500.0)
    assert lock.value == [LOCK_SCALE]
    lock.value = []
    assert page.locks == [True, False]


def test_on_a_touch_device_all_folds_are_closed(page: Page) -> None:
    page.state.touch = True
    parts = page.controls.layout()
    labels = [part.label for part in parts if isinstance(part, pn.widgets.Button)]
    assert {label for label in labels if label[0] in "▸▾"} == {"▸ Quality and colours", "▸ Layers"}


def test_other_potentials_leave_no_case_selected(page: Page) -> None:
    page.state.show_system(review_for_page(System("I", parameters={"epsilon": 0.5})))
    assert page.controls.case.value == "I"
    page.state.show_system(review_for_page(System(TYPED, "½(x² + y²) − x²y")))
    assert page.controls.case.value is None
    assert page.controls.other.color == "primary"
    assert page.state.system.case == TYPED


def test_another_case_writes_no_plane_that_is_shown_already(page: Page) -> None:
    # When the server writes a widget, Panel drops a choice of the browser that is not handled yet.
    written: list[object] = []
    page.controls.plane.param.watch(lambda event: written.append(event.new), "value", onlychanged=False)
    page.controls.case.value = "II"
    assert page.state.system.case == "II"
    assert written == []
