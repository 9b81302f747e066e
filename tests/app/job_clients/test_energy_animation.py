"""A sweep goes through the energies, waits for slow pictures, and ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.job_clients.energy_animation import SWEEP_SECONDS, TICK_MS, EnergyAnimation


class Clock:
    """A timer that ticks when it is told to."""

    def __init__(self) -> None:
        self.callback: Callable[[], None] | None = None

    def add_periodic_callback(self, callback: Callable[[], None], period_milliseconds: int) -> Any:
        assert period_milliseconds == TICK_MS
        self.callback = callback
        return callback

    def remove_periodic_callback(self, callback_obj: Any) -> None:
        assert callback_obj is self.callback
        self.callback = None

    def tick(self) -> None:
        assert self.callback is not None
        self.callback()


class Sweep:
    def __init__(self) -> None:
        self.clock, self.busy = Clock(), False
        self.energies: list[float] = []
        self.stopped: list[float] = []
        self.sweep = EnergyAnimation(self.clock, lambda: self.busy, self.energies.append, self.stopped.append)


@pytest.fixture
def played() -> Sweep:
    return Sweep()


def test_energies_rise_by_even_steps(played: Sweep) -> None:
    played.sweep.start(0.2, 0.1, 0.5)
    for _ in range(3):
        played.clock.tick()
    step = 0.4 * TICK_MS / (1000 * SWEEP_SECONDS)
    assert played.energies == pytest.approx([0.2 + step, 0.2 + 2 * step, 0.2 + 3 * step])


def test_a_slow_picture_is_waited_for(played: Sweep) -> None:
    played.sweep.start(0.2, 0.1, 0.5)
    played.busy = True
    played.clock.tick()
    assert played.energies == []


def test_it_stops_at_the_end_of_the_range(played: Sweep) -> None:
    played.sweep.start(0.4999, 0.1, 0.5)
    played.clock.tick()
    assert played.energies == played.stopped == [0.5]
    assert not played.sweep.playing
    assert played.clock.callback is None


@pytest.mark.parametrize("energy", [0.5, 0.05, 7.0])
def test_at_the_end_or_outside_it_begins_anew(played: Sweep, energy: float) -> None:
    played.sweep.start(energy, 0.1, 0.5)
    played.clock.tick()
    assert 0.1 < played.energies[0] < 0.11


def test_a_second_start_changes_nothing(played: Sweep) -> None:
    played.sweep.start(0.2, 0.1, 0.5)
    played.sweep.start(0.3, 0.1, 0.5)
    played.clock.tick()
    assert played.energies[0] < 0.21


def test_stopping_tells_where(played: Sweep) -> None:
    played.sweep.start(0.2, 0.1, 0.5)
    played.clock.tick()
    played.sweep.stop()
    played.sweep.stop()
    assert played.stopped == played.energies
