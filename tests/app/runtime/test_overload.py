"""Overload: sustained delays, with hysteresis."""

from __future__ import annotations

from app.runtime.overload import CALM_SECONDS, LATE_SECONDS, WINDOW_SECONDS, OverloadMonitor
from tests.app.clock import Clock

LIMIT = 0.5


def run(monitor: OverloadMonitor, clock: Clock, seconds: int, delay: float) -> None:
    """One delay in each second."""
    for _ in range(seconds):
        clock.now += 1.0
        monitor.add(delay)


def test_overload_begins_after_enough_late_seconds() -> None:
    clock = Clock()
    monitor = OverloadMonitor(LIMIT, clock.monotonic)
    run(monitor, clock, 100, LIMIT)
    assert not monitor.is_overloaded()
    # Each delay of 0.6 s ends at a whole second, and so belongs to two of them.
    run(monitor, clock, LATE_SECONDS - 2, 0.6)
    assert not monitor.is_overloaded()
    run(monitor, clock, 1, 0.6)
    assert monitor.is_overloaded()


def test_a_long_delay_belongs_to_all_its_seconds() -> None:
    clock = Clock()
    monitor = OverloadMonitor(LIMIT, clock.monotonic)
    monitor.add(LATE_SECONDS - 2.0)
    assert not monitor.is_overloaded()
    monitor.add(1000.0)
    assert monitor.is_overloaded()


def test_overload_ends_below_the_load_at_which_it_begins() -> None:
    clock = Clock()
    monitor = OverloadMonitor(LIMIT, clock.monotonic)
    run(monitor, clock, WINDOW_SECONDS, 0.6)
    run(monitor, clock, WINDOW_SECONDS - CALM_SECONDS - 1, 0.0)
    assert monitor.is_overloaded()
    assert monitor.delay == 0.6
    run(monitor, clock, 1, 0.0)
    assert not monitor.is_overloaded()
