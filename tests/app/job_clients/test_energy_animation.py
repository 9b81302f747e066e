"""The animation raises the energy, waits for slow previews, and ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.job_clients.energy_animation import SWEEP_SECONDS, TICK_MS, EnergyAnimation


class Clock:
    """A timer that the test advances."""

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


class Played:
    def __init__(self) -> None:
        self.clock, self.busy = Clock(), False
        self.energies: list[float] = []
        self.stopped: list[float] = []
        self.animation = EnergyAnimation(self.clock, lambda: self.busy, self.energies.append, self.stopped.append)


@pytest.fixture
def played() -> Played:
    return Played()


def test_energies_rise_in_equal_steps(played: Played) -> None:
    played.animation.start(0.2, 0.1, 0.5)
    for _ in range(3):
        played.clock.tick()
    step = 0.4 * TICK_MS / (1000 * SWEEP_SECONDS)
    assert played.energies == pytest.approx([0.2 + step, 0.2 + 2 * step, 0.2 + 3 * step])


def test_a_slow_preview_delays_the_next_step(played: Played) -> None:
    played.animation.start(0.2, 0.1, 0.5)
    played.busy = True
    played.clock.tick()
    assert played.energies == []


def test_it_stops_at_the_end_of_the_range(played: Played) -> None:
    played.animation.start(0.4999, 0.1, 0.5)
    played.clock.tick()
    assert played.energies == played.stopped == [0.5]
    assert not played.animation.playing
    assert played.clock.callback is None


@pytest.mark.parametrize("energy", [0.5, 0.05, 7.0])
def test_at_the_end_or_outside_it_starts_at_the_lower_end(played: Played, energy: float) -> None:
    played.animation.start(energy, 0.1, 0.5)
    played.clock.tick()
    assert 0.1 < played.energies[0] < 0.11


def test_a_second_start_has_no_effect(played: Played) -> None:
    played.animation.start(0.2, 0.1, 0.5)
    played.animation.start(0.3, 0.1, 0.5)
    played.clock.tick()
    assert played.energies[0] < 0.21


def test_stopping_reports_the_energy(played: Played) -> None:
    played.animation.start(0.2, 0.1, 0.5)
    played.clock.tick()
    played.animation.stop()
    played.animation.stop()
    assert played.stopped == played.energies
