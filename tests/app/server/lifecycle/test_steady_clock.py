"""Periodic callbacks go on when the time of the machine is set back."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator

import pytest
from tornado.ioloop import IOLoop, PeriodicCallback

from app.server.lifecycle.steady_clock import use_steady_clock
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS


@pytest.fixture
def _steady_clock() -> Iterator[None]:
    before = IOLoop.time
    use_steady_clock()
    yield
    IOLoop.time = before  # type: ignore[method-assign]


async def call_until_the_clock_is_set_back(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run a callback every 10 ms, during which the time of day is set back by an hour."""
    calls: asyncio.Queue[None] = asyncio.Queue()
    periodic = PeriodicCallback(lambda: calls.put_nowait(None), 10.0)
    periodic.start()
    wall_clock = time.time
    async with asyncio.timeout(SECONDS):
        await calls.get()
        monkeypatch.setattr(time, "time", lambda: wall_clock() - 3600.0)
        for _ in range(3):
            await calls.get()
    periodic.stop()


@pytest.mark.usefixtures("_steady_clock")
def test_periodic_callbacks_go_on_after_the_clock_is_set_back(monkeypatch: pytest.MonkeyPatch) -> None:
    run_on_new_loop(lambda: call_until_the_clock_is_set_back(monkeypatch))
