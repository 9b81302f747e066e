"""Priority of the calls of a map."""

from __future__ import annotations

import pytest

from engine.jobs import map_priority
from engine.jobs.map_priority import REST_SECONDS, MapPriority
from engine.jobs.scheduler import Priority
from tests.app.clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(map_priority, "time", made)
    return made


def test_calls_before_the_first_frame_come_first(clock: Clock) -> None:
    priority = MapPriority()
    clock.now += 2.0 * REST_SECONDS
    assert priority() is Priority.FIRST_FRAME


def test_finer_pixels_with_the_first_horizon_are_in_the_background(clock: Clock) -> None:
    priority = MapPriority()
    priority.add_frame(100.0)
    priority.add_frame(100.0)
    assert priority() is Priority.BACKGROUND


def test_longer_horizons_are_unsettled_until_the_user_rests(clock: Clock) -> None:
    priority = MapPriority()
    priority.add_frame(100.0)
    priority.add_frame(1000.0)
    assert priority() is Priority.UNSETTLED
    clock.now += REST_SECONDS
    assert priority() is Priority.BACKGROUND


def test_the_first_frame_of_a_resumed_map_may_have_a_long_horizon(clock: Clock) -> None:
    priority = MapPriority()
    priority.add_frame(1e5)
    assert priority() is Priority.BACKGROUND
