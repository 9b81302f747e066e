"""What the server tells the engine in the browser, and what it hears from it."""

from __future__ import annotations

import pytest

from app.browser.engine_component import BrowserEngine


def played() -> tuple[BrowserEngine, list[float]]:
    ends: list[float] = []
    engine = BrowserEngine(ends.append)
    engine.play(0.2, 0.1, 0.5)
    return engine, ends


def test_the_end_of_playing_is_reported_once() -> None:
    engine, ends = played()
    for _ in range(2):
        engine._receive({"energy": 0.3})
    assert ends == [0.3]
    assert not engine.playing


@pytest.mark.parametrize("message", [{"energy": "0.3"}, {"energy": float("inf")}, {"other": 1}, None])
def test_other_messages_are_ignored(message: object) -> None:
    engine, ends = played()
    engine._receive(message)
    assert ends == []
    assert engine.playing


def test_commands_that_repeat_differ() -> None:
    engine, _ = played()
    first = engine.layout().command
    engine.play(0.2, 0.1, 0.5)
    assert engine.layout().command != first
