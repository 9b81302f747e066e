"""The image of the manifolds and the lock of the escape times write to the view state and follow it."""

from __future__ import annotations

import pytest
from panel.widgets import Widget

from app.state.view_state import IMAGE_CHOICES, LAYERS, ViewState
from app.views.components.analysis_choice import LayerSwitches
from app.views.components.widgets import SegmentedControl, Switches
from app.views.panels.controls import LOCK, ControlActions, Controls
from plots.time_scale import TimeScale


@pytest.fixture
def locks() -> list[bool]:
    """What the lock asked for."""
    return []


def controls(state: ViewState, locks: list[bool]) -> Controls:
    return Controls(
        state,
        ControlActions(
            lambda: None,
            lambda: None,
            lambda: None,
            lambda on: state.param.update(compared=state.present_view() if on else None),
            lambda: None,
            locks.append,
        ),
    )


def lock_of(panel: Controls) -> Widget:
    return next(part for part in panel._build_quality() if isinstance(part, Switches))


def test_the_choice_of_an_image_is_there_while_the_manifolds_are_on() -> None:
    state = ViewState()
    layers = LayerSwitches(state)
    assert layers.parts() == [*layers.switches.values()]
    state.manifolds = True
    assert len(layers.parts()) == len(LAYERS) + 1
    state.manifolds = False
    assert layers.parts() == [*layers.switches.values()]


def test_the_image_changes_the_state_and_follows_it() -> None:
    state = ViewState(manifolds=True)
    images = LayerSwitches(state).parts()[-1]
    assert isinstance(images, SegmentedControl)
    assert list(images.options.values()) == list(IMAGE_CHOICES.values())
    images.value = 2
    assert state.images == 2
    state.images = 0
    assert images.value == 0


def test_the_fold_of_layers_has_the_image_when_the_manifolds_are_switched_on(locks: list[bool]) -> None:
    state = ViewState()
    panel = controls(state, locks)
    fold = panel._folds[1].layout()
    assert len(fold.objects) == len(LAYERS) + 1
    state.manifolds = True
    assert len(fold.objects) == len(LAYERS) + 2


def test_the_switch_of_the_comparison_follows_the_state_and_asks_for_it(locks: list[bool]) -> None:
    state = ViewState(energy=0.19)
    panel = controls(state, locks)
    state.compared = state.present_view()
    assert panel.comparison.switch.value
    assert "Case I, (x, px), h = 0.19" in panel.comparison.view.object
    assert panel.comparison.swap in panel._folds[1].layout().objects
    panel.comparison.switch.value = []
    assert state.compared is None
    assert panel.comparison.swap not in panel._folds[1].layout().objects


def test_the_lock_asks_for_the_limits_of_the_map(locks: list[bool]) -> None:
    lock = lock_of(controls(ViewState(), locks))
    lock.value = [LOCK]
    assert locks == [True]


def test_the_lock_follows_the_state_without_asking(locks: list[bool]) -> None:
    state = ViewState(lock_times=TimeScale(1.0, 500.0))
    lock = lock_of(controls(state, locks))
    assert lock.value == [LOCK]
    state.lock_times = None
    assert lock.value == []
    assert locks == []


def test_the_open_lock_is_closed_by_the_user(locks: list[bool]) -> None:
    lock = lock_of(controls(ViewState(lock_times=TimeScale(1.0, 500.0)), locks))
    lock.value = []
    assert locks == [False]
