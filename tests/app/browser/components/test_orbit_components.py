"""The player steps through the visible interval of time."""

from __future__ import annotations

import pytest

from app.browser.components.orbit_components import OrbitPlayer
from tests.app.browser_messages import send


@pytest.fixture
def times() -> list[float | None]:
    return []


@pytest.fixture
def player(times: list[float | None]) -> OrbitPlayer:
    player = OrbitPlayer(times.append)
    player.follow((10.0, 40.0))
    return player


def move(player: OrbitPlayer, step: int) -> None:
    send(player, {"step": step, "begin": player.begin, "end": player.end})


def test_steps_are_times_of_the_interval(player: OrbitPlayer, times: list[float | None]) -> None:
    for step in (player.steps // 3, player.steps, 0):
        move(player, step)
    assert times == [None, 20.0, 40.0, None]


def test_another_interval_begins_at_its_start(player: OrbitPlayer, times: list[float | None]) -> None:
    move(player, 100)
    player.follow((10.0, 40.0))
    player.follow((0.0, 5.0))
    player.follow(None)
    assert times == [None, 15.0, None, None]
    assert player.begin == player.end
