"""Priority of the calls of a map."""

from __future__ import annotations

from engine.jobs.map_priority import REST_SECONDS, MapPriority
from engine.jobs.scheduler import Priority
from tests.app.clock import Clock


def test_calls_before_the_first_frame_come_first() -> None:
    clock = Clock()
    priority = MapPriority(clock)
    clock.now += 2.0 * REST_SECONDS
    assert priority() is Priority.FIRST_FRAME


def test_finer_pixels_with_the_first_horizon_are_in_the_background() -> None:
    priority = MapPriority()
    priority.add_frame(100.0)
    priority.add_frame(100.0)
    assert priority() is Priority.BACKGROUND


def test_longer_horizons_are_unsettled_until_the_user_rests() -> None:
    clock = Clock()
    priority = MapPriority(clock)
    priority.add_frame(100.0)
    priority.add_frame(1000.0)
    assert priority() is Priority.UNSETTLED
    clock.now += REST_SECONDS
    assert priority() is Priority.BACKGROUND


def test_the_first_frame_of_a_resumed_map_may_have_a_long_horizon() -> None:
    priority = MapPriority()
    priority.add_frame(1e5)
    assert priority() is Priority.BACKGROUND
