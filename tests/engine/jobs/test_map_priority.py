"""The priority of the calls of a map depends on stage and load."""

from __future__ import annotations

from engine.jobs.map_priority import CROWDED_REST_SECONDS, REST_SECONDS, MapPriority
from engine.jobs.scheduler import Priority
from tests.app.clock import Clock


def quiet() -> bool:
    return False


def test_calls_before_the_first_frame_come_first() -> None:
    clock = Clock()
    priority = MapPriority(quiet, clock)
    clock.now += 2.0 * REST_SECONDS
    assert priority() is Priority.FIRST_FRAME


def test_finer_pixels_with_the_first_horizon_are_in_the_background() -> None:
    priority = MapPriority(quiet)
    priority.add_frame(100.0)
    priority.add_frame(100.0)
    assert priority() is Priority.BACKGROUND


def test_longer_horizons_are_unsettled_until_the_user_rests() -> None:
    clock = Clock()
    priority = MapPriority(quiet, clock)
    priority.add_frame(100.0)
    priority.add_frame(1000.0)
    assert priority() is Priority.UNSETTLED
    clock.now += REST_SECONDS
    assert priority() is Priority.BACKGROUND


def test_the_first_frame_of_a_resumed_map_may_have_a_long_horizon() -> None:
    priority = MapPriority(quiet)
    priority.add_frame(1e5)
    assert priority() is Priority.BACKGROUND


def test_all_frames_but_the_first_are_unsettled_for_longer_while_the_process_is_crowded() -> None:
    clock = Clock()
    priority = MapPriority(lambda: True, clock)
    assert priority() is Priority.FIRST_FRAME
    priority.add_frame(100.0)
    clock.now += REST_SECONDS
    assert priority() is Priority.UNSETTLED
    clock.now += CROWDED_REST_SECONDS - REST_SECONDS
    assert priority() is Priority.BACKGROUND
