"""The player steps through the visible interval of time."""

from __future__ import annotations

import pytest

from app.views.orbits.playback import Playback
from tests.app.browser_messages import send


@pytest.fixture
def times() -> list[float | None]:
    return []


@pytest.fixture
def playback(times: list[float | None]) -> Playback:
    playback = Playback(times.append)
    playback.follow((10.0, 40.0))
    return playback


def move(playback: Playback, step: int) -> None:
    send(playback.player, {"step": step, "begin": playback.player.begin, "end": playback.player.end})


def test_steps_are_times_of_the_interval(playback: Playback, times: list[float | None]) -> None:
    for step in (playback.player.steps // 3, playback.player.steps, 0):
        move(playback, step)
    assert times == [None, 20.0, 40.0, None]


def test_another_interval_begins_at_its_start(playback: Playback, times: list[float | None]) -> None:
    move(playback, 100)
    playback.follow((10.0, 40.0))
    playback.follow((0.0, 5.0))
    playback.follow(None)
    assert times == [None, 15.0, None, None]
    assert playback.player.begin == playback.player.end
