"""Callbacks that threads call run on the event loop under the session's lock."""

from __future__ import annotations

import asyncio
import gc
import threading
import weakref
from typing import Any

import panel as pn
import pytest
from bokeh.application import Application
from bokeh.document import Document
from bokeh.server.contexts import ApplicationContext
from bokeh.server.session import ServerSession
from panel.io.state import set_curdoc

from app.runtime.session_callbacks import SessionCallbacks
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS


async def new_session() -> tuple[ServerSession, ApplicationContext]:
    """Return a session, and the server's context that owns the session."""
    context = ApplicationContext(Application())
    return await context.create_session_if_needed("session"), context  # type: ignore[arg-type]


def is_held(session: ServerSession) -> bool:
    """Return whether changes wait to be sent together."""
    return session.document.callbacks.hold_value == "combine"


class Calls:
    """Records the arguments of calls on the event loop, and lets tests await the calls."""

    def __init__(self) -> None:
        self._calls = asyncio.Queue[Any]()

    def add(self, value: Any) -> None:
        self._calls.put_nowait(value)

    async def take(self, count: int) -> list[Any]:
        """Return the next calls."""
        async with asyncio.timeout(SECONDS):
            return [await self._calls.get() for _ in range(count)]


def test_calls_of_threads_run_on_the_loop_with_the_document_whose_changes_are_held() -> None:
    async def scenario() -> None:
        (session, _owner), calls = await new_session(), Calls()
        with set_curdoc(session.document):
            call = SessionCallbacks(session.document).every(
                lambda value: calls.add((value, threading.get_ident(), pn.state.curdoc, is_held(session)))
            )
        for value in range(3):
            await asyncio.to_thread(call, value)
        assert await calls.take(3) == [(value, threading.get_ident(), session.document, True) for value in range(3)]

    run_on_new_loop(scenario)


def test_calls_of_a_page_made_on_a_thread_run_on_the_loop_of_the_server() -> None:
    async def scenario() -> None:
        (session, _owner), calls = await new_session(), Calls()
        callbacks = await asyncio.to_thread(SessionCallbacks, session.document, asyncio.get_running_loop())
        await asyncio.to_thread(callbacks.every(lambda: calls.add(threading.get_ident())))
        assert await calls.take(1) == [threading.get_ident()]

    run_on_new_loop(scenario)


def test_only_the_latest_of_the_calls_that_wait_for_the_lock_runs() -> None:
    async def scenario() -> None:
        (session, _owner), calls = await new_session(), Calls()
        call = SessionCallbacks(session.document).latest(calls.add)

        async def call_often() -> None:
            for value in range(5):
                await asyncio.to_thread(call, value)

        await session.with_document_locked(call_often)
        first = await calls.take(1)
        call(5)
        assert first + await calls.take(1) == [4, 5]

    run_on_new_loop(scenario)


def test_a_call_of_a_thread_while_changes_are_held_is_not_lost() -> None:
    """Panel and Bokeh copy and then replace held events. ``Document.locked_callback`` loses a call that comes between."""

    async def scenario() -> None:
        (session, _owner), calls = await new_session(), Calls()
        document = session.document
        call = SessionCallbacks(document).latest(calls.add)

        def change() -> None:
            document.hold()
            document.title = "changed"
            events = list(document.callbacks._held_events)
            caller = threading.Thread(target=call, args=("frame",))
            caller.start()
            caller.join()
            document.callbacks._held_events = events
            document.unhold()

        await session.with_document_locked(change)
        assert await calls.take(1) == ["frame"]

    run_on_new_loop(scenario)


def test_failed_call_does_not_stop_the_next(caplog: pytest.LogCaptureFixture) -> None:
    async def scenario() -> None:
        (session, _owner), calls = await new_session(), Calls()
        call = SessionCallbacks(session.document).every(lambda value: calls.add(1.0 / value))
        call(0.0)
        call(2.0)
        assert await calls.take(1) == [0.5]

    run_on_new_loop(scenario)
    assert "ZeroDivisionError" in caplog.text


def test_calls_after_the_session_are_dropped() -> None:
    async def scenario() -> weakref.ref[Document]:
        (session, _owner), seen = await new_session(), list[int]()
        call = SessionCallbacks(session.document).every(seen.append)
        document = weakref.ref(session.document)
        session.destroy()
        call(1)
        # Let the tasks end that the call has started.
        begun = asyncio.Event()
        asyncio.get_running_loop().call_soon(begun.set)
        await begun.wait()
        await asyncio.gather(*asyncio.all_tasks() - {asyncio.current_task()})
        assert seen == []
        return document

    document = run_on_new_loop(scenario)
    gc.collect()
    assert document() is None


def test_functions_are_called_directly_without_a_session() -> None:
    seen: list[int] = []
    SessionCallbacks(Document()).every(seen.append)(1)
    assert seen == [1]
