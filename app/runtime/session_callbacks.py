"""Callbacks that any thread may call. They run on the event loop, under the lock of a session.

Bokeh's ``Document.locked_callback`` is not used, because it schedules calls through events of the document. While a
callback holds events back (``pn.io.hold``), Panel and Bokeh copy the list of held events, then replace the list. An
event that a thread appends in between is lost. With Bokeh's ``policy="latest"``, one lost event blocks all later calls.
"""

from __future__ import annotations

import asyncio
import logging
import weakref
from collections import deque
from collections.abc import Awaitable, Callable
from contextlib import suppress
from functools import partial
from typing import Any

import panel as pn
from bokeh.application.application import SessionContext
from bokeh.document import Document
from panel.io.state import set_curdoc

from app.runtime.fair_share import PageTime
from app.runtime.process_state import process_state
from app.runtime.visitors import visitor_of

log = logging.getLogger(__name__)


class SessionCallbacks:
    """Wraps functions that change the document of one session. Construct it while the page is built.

    A wrapped function returns at once. Its calls run later on the event loop, one at a time and in order, with the document
    locked and set as the current document. Calls after the end of the session are dropped. Without a session, as in a
    notebook, wrapped functions are called directly.

    Parameters
    ----------
    document
        The document of the session.
    loop
        The event loop of the server; by default the running loop.
    """

    def __init__(self, document: Document, loop: asyncio.AbstractEventLoop | None = None) -> None:
        self._document = weakref.ref(document)
        self._next_turn = partial(process_state().next_turn, visitor_of(document))
        self._page_time = process_state().page_time(document)
        self._loop = (loop or asyncio.get_running_loop()) if document.session_context is not None else None

    def every(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a function so that all of its calls run."""
        return self._wrap(function, None)

    def latest(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Wrap a function so that only the latest of its waiting calls runs."""
        return self._wrap(function, 1)

    def _wrap(self, function: Callable[..., Any], most_waiting: int | None) -> Callable[..., Any]:
        if self._loop is None:
            return function
        return _LockedCallback(self._loop, self._document, self._next_turn, self._page_time, function, most_waiting)


class _LockedCallback:
    """A wrapped function with its waiting calls."""

    def __init__(
        self,
        loop: asyncio.AbstractEventLoop,
        document: weakref.ref[Document],
        next_turn: Callable[[], Awaitable[None]],
        page_time: PageTime,
        function: Callable[..., Any],
        most_waiting: int | None,
    ) -> None:
        self._loop, self._document, self._function = loop, document, function
        self._next_turn, self._page_time = next_turn, page_time
        self._calls: deque[Callable[[], Any]] = deque(maxlen=most_waiting)
        self._task: asyncio.Task[None] | None = None

    def __call__(self, *args: Any, **kwargs: Any) -> None:
        self._calls.append(partial(self._function, *args, **kwargs))
        # After the server has stopped, the loop is closed, and the call is dropped.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._start)

    def _start(self) -> None:
        if self._task is None or self._task.done():
            self._task = self._loop.create_task(self._run_calls())

    async def _run_calls(self) -> None:
        while self._calls:
            await self._next_turn()
            context = self._open_context()
            if context is None:
                return
            try:
                await self._page_time.charge_for(context.with_locked_document(self._run_one))
            except Exception:
                # Later changes could not be sent either.
                log.exception("the changes of a callback could not be sent")
                self._calls.clear()

    def _open_context(self) -> SessionContext | None:
        """Return the context of the session; None after the end of the session."""
        document = self._document()
        context = document.session_context if document is not None else None
        return context if context is not None and not context.destroyed else None

    async def _run_one(self, document: Document) -> None:
        """Run the first waiting call, if any, with the document locked."""
        if self._calls:
            call = self._calls.popleft()
            try:
                # Panel may hold back changes of widgets until the socket is free. Changes by the call may concern models that
                # held changes add, so they must not overtake held changes.
                with set_curdoc(document), pn.io.hold(document):
                    call()
            except Exception:
                log.exception("a callback failed")
