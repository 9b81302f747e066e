"""Whoever calls, a page is told on its loop."""

from __future__ import annotations

import asyncio
import threading
from typing import Any

import pytest
from bokeh.document import Document
from bokeh.document.locking import LockedCallback

from app.bokeh_patches.told_by_threads import schedule_on_the_loop
from tests.app.other_loop import run_elsewhere


class Session:
    """Of a visitor who is there."""

    destroyed = False


class Page(Document):
    """Notes in which thread it is asked to call back, and calls back at once."""

    session_context = Session()  # type: ignore[assignment]

    def __init__(self) -> None:
        super().__init__()
        self.threads: list[int] = []

    def on_session_destroyed(self, *callbacks: Any) -> None:
        """Nobody leaves."""

    def add_next_tick_callback(self, callback: Any) -> Any:
        self.threads.append(threading.get_ident())
        callback()


@pytest.fixture
def way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(LockedCallback, "_schedule", LockedCallback._schedule)


async def told_by_a_thread(*, on_the_loop: bool) -> tuple[list[str], list[int], int]:
    """What the page heard, in which threads it was asked to call back, and that of the loop."""
    if on_the_loop:
        schedule_on_the_loop(asyncio.get_running_loop())
    page, heard = Page(), []
    tell = page.locked_callback(heard.append)
    await asyncio.to_thread(tell, "from a thread")
    await asyncio.sleep(0.01)
    tell("from the loop")
    return heard, page.threads, threading.get_ident()


@pytest.mark.usefixtures("way")
def test_bokeh_tells_a_page_in_any_thread_until_it_is_told_not_to() -> None:
    heard, threads, loop = run_elsewhere(lambda: told_by_a_thread(on_the_loop=False))
    assert heard == ["from a thread", "from the loop"]
    assert threads[0] != loop
    heard, threads, loop = run_elsewhere(lambda: told_by_a_thread(on_the_loop=True))
    assert heard == ["from a thread", "from the loop"]
    assert threads == [loop, loop]


@pytest.mark.usefixtures("way")
def test_when_the_loop_is_closed_nobody_is_told() -> None:
    loop = asyncio.new_event_loop()
    schedule_on_the_loop(loop)
    loop.close()
    page, heard = Page(), []
    page.locked_callback(heard.append)("too late")
    assert heard == []
