"""Callbacks that threads call run on the event loop under the session's lock."""

from __future__ import annotations

import asyncio
import gc
import threading
import weakref
from collections.abc import Callable
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


async def new_session() -> tuple[ServerSession, ApplicationContext]:
    """A session, and the server's context, which owns it."""
    context = ApplicationContext(Application())
    return await context.create_session_if_needed("session"), context  # type: ignore[arg-type]


def is_held(session: ServerSession) -> bool:
    """Whether changes wait to be sent together."""
    return session.document.callbacks.hold_value == "combine"


async def wait_for(condition: Callable[[], Any]) -> None:
    async with asyncio.timeout(10):
        while not condition():
            await asyncio.sleep(0.001)


def test_calls_of_threads_run_on_the_loop_with_lock_and_document() -> None:
    async def scenario() -> None:
        (session, _owner), seen = await new_session(), list[Any]()
        with set_curdoc(session.document):
            call = SessionCallbacks(session.document).every(
                lambda value: seen.append(
                    (value, threading.get_ident(), session._lock.locked(), pn.state.curdoc, is_held(session))
                )
            )
        for value in range(3):
            await asyncio.to_thread(call, value)
        await wait_for(lambda: len(seen) == 3)
        assert seen == [(value, threading.get_ident(), True, session.document, True) for value in range(3)]

    run_on_new_loop(scenario)


def test_of_waiting_calls_only_the_latest_runs() -> None:
    async def scenario() -> None:
        (session, _owner), seen = await new_session(), list[int]()
        call = SessionCallbacks(session.document).latest(seen.append)
        async with session._lock:
            for value in range(5):
                await asyncio.to_thread(call, value)
            await asyncio.sleep(0.01)
        await wait_for(lambda: seen)
        await asyncio.sleep(0.01)
        assert seen == [4]

    run_on_new_loop(scenario)


def test_a_call_of_a_thread_while_changes_are_held_is_not_lost() -> None:
    """Held events are copied and then replaced, as Panel and Bokeh do: ``Document.locked_callback`` loses such a call."""

    async def scenario() -> None:
        (session, _owner), seen = await new_session(), list[str]()
        document = session.document
        call = SessionCallbacks(document).latest(seen.append)

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
        await wait_for(lambda: seen)
        assert seen == ["frame"]

    run_on_new_loop(scenario)


def test_failed_call_does_not_stop_the_next(caplog: pytest.LogCaptureFixture) -> None:
    async def scenario() -> None:
        (session, _owner), seen = await new_session(), list[float]()
        call = SessionCallbacks(session.document).every(lambda value: seen.append(1.0 / value))
        call(0.0)
        call(2.0)
        await wait_for(lambda: seen)
        assert seen == [0.5]

    run_on_new_loop(scenario)
    assert "ZeroDivisionError" in caplog.text


def test_calls_after_the_session_are_dropped() -> None:
    async def scenario() -> weakref.ref[Document]:
        (session, _owner), seen = await new_session(), list[int]()
        call = SessionCallbacks(session.document).every(seen.append)
        document = weakref.ref(session.document)
        session.destroy()
        call(1)
        await asyncio.sleep(0.01)
        assert seen == []
        return document

    document = run_on_new_loop(scenario)
    gc.collect()
    assert document() is None


def test_functions_are_called_directly_without_a_session() -> None:
    seen: list[int] = []
    SessionCallbacks(Document()).every(seen.append)(1)
    assert seen == [1]
