"""The load of the event loop follows its delays."""

from __future__ import annotations

from app.runtime.loop_watch import HIGH_SECONDS, LONGEST_HIGH_SECONDS, TICK_SECONDS, LoadMonitor
from tests.app.clock import Clock


def tick(monitor: LoadMonitor, clock: Clock, seconds: float) -> None:
    clock.now += seconds
    monitor.tick()


def test_load_is_high_after_a_late_tick_and_decays() -> None:
    clock = Clock()
    monitor = LoadMonitor(clock.monotonic)
    tick(monitor, clock, 0.0)
    tick(monitor, clock, TICK_SECONDS + 4.0 * HIGH_SECONDS)
    high = [monitor.is_high()]
    for _ in range(29):
        tick(monitor, clock, TICK_SECONDS)
        high.append(monitor.is_high())
    # The delay of 0.2 s falls by a factor of 0.7 in each 0.1 s, and is below 0.05 s after 0.39 s.
    assert high == [True] * 20 + [False] * 10


def test_persistent_high_load_is_interrupted() -> None:
    clock = Clock()
    monitor = LoadMonitor(clock.monotonic)
    tick(monitor, clock, 0.0)
    high = []
    for _ in range(40):
        tick(monitor, clock, TICK_SECONDS + 2.0 * HIGH_SECONDS)
        high.append(monitor.is_high())
    assert high[0]
    assert 1 <= high.count(False) <= 40 * (TICK_SECONDS + 2.0 * HIGH_SECONDS) / LONGEST_HIGH_SECONDS
