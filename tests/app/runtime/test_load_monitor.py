"""How far the server is behind."""

from __future__ import annotations

import pytest

from app.runtime import load_monitor
from app.runtime.load_monitor import HIGH, LONGEST_SECONDS, LOOKED_AT_EVERY, LoadMonitor
from tests.app.clock import Clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr(load_monitor, "time", made)
    return made


def tick(measured: LoadMonitor, clock: Clock, seconds: float) -> None:
    clock.now += seconds
    measured.tick()


def test_a_clock_that_is_in_time_knows_no_pressure(clock: Clock) -> None:
    measured = LoadMonitor()
    for _ in range(5):
        tick(measured, clock, LOOKED_AT_EVERY)
    assert not measured.is_high()


def test_a_late_tick_is_pressure_which_passes(clock: Clock) -> None:
    measured = LoadMonitor()
    tick(measured, clock, 0.0)
    tick(measured, clock, LOOKED_AT_EVERY + 4.0 * HIGH)
    assert measured.is_high()
    for _ in range(20):
        tick(measured, clock, LOOKED_AT_EVERY)
    assert not measured.is_high()


def test_pressure_that_lasts_lets_go_from_time_to_time(clock: Clock) -> None:
    measured = LoadMonitor()
    tick(measured, clock, 0.0)
    high = []
    for _ in range(40):
        tick(measured, clock, LOOKED_AT_EVERY + 2.0 * HIGH)
        high.append(measured.is_high())
    assert high[0]
    assert 1 <= high.count(False) <= 40 * (LOOKED_AT_EVERY + 2.0 * HIGH) / LONGEST_SECONDS
