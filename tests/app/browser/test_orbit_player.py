"""The server's side of the player; tests/browser/test_orbits_in_browser.py has the browser's."""

from __future__ import annotations

from typing import Any

import pytest

from app.browser.orbit_player import OrbitPlayer


@pytest.fixture
def steps() -> list[int]:
    return []


@pytest.fixture
def player(steps: list[int]) -> OrbitPlayer:
    return OrbitPlayer(steps.append, begin=5.0, end=12.5)


def test_each_step_is_reported(player: OrbitPlayer, steps: list[int]) -> None:
    # Numbers of a browser have no type: 5.0 arrives as 5.
    for step in (0, 1, player.steps):
        player._receive({"step": step, "begin": 5, "end": 12.5})
    assert steps == [0, 1, player.steps]


@pytest.mark.parametrize(
    "message",
    [
        None, 3, {"step": 3}, {"step": 3.5, "begin": 5, "end": 12.5}, {"step": -1, "begin": 5, "end": 12.5},
        {"step": 601, "begin": 5, "end": 12.5}, {"step": 3, "begin": 0, "end": 12.5}, {"step": 3, "begin": 5, "end": "12.5"},
    ],
)  # fmt: skip
def test_other_messages_and_other_intervals_are_ignored(player: OrbitPlayer, steps: list[int], message: Any) -> None:
    player._receive(message)
    assert steps == []


def test_without_an_interval_there_are_no_steps(player: OrbitPlayer, steps: list[int]) -> None:
    player.param.update(begin=0.0, end=0.0)
    player._receive({"step": 3, "begin": 0, "end": 0})
    assert steps == []
