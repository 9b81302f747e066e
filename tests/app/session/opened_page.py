"""Open pages of a server's sessions without a browser."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from typing import Any
from urllib.parse import urlencode

import param
from bokeh.application.handlers.document_lifecycle import DocumentLifecycleHandler
from bokeh.document import Document
from bokeh.events import DocumentReady
from bokeh.server.contexts import ApplicationContext
from bokeh.server.session import ServerSession
from panel.io.application import Application
from panel.io.state import set_curdoc
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine

from app.runtime.process_state import process_state
from app.session.explorer import Explorer
from app.session.page import explorer_page
from tests.waiting import SECONDS

NO_LINK: Mapping[str, str] = {}


# The base class matters: Bokeh calls other handlers in a thread.
class PageBuilder(DocumentLifecycleHandler):
    """Calls `prepare`, and then builds the page of a session on the event loop."""

    def __init__(self, prepare: Callable[[Explorer], None]) -> None:
        super().__init__()
        self._prepare = prepare
        self.explorer: Explorer | None = None

    def modify_document(self, doc: Document) -> None:
        with set_curdoc(doc):
            self.explorer = Explorer()
            self._prepare(self.explorer)
            explorer_page(self.explorer).server_doc(doc)


@asynccontextmanager
async def opened_page(
    link: Mapping[str, str] = NO_LINK, prepare: Callable[[Explorer], None] = lambda explorer: None
) -> AsyncIterator[tuple[Explorer, ServerSession]]:
    """Yield the explorer and the session of a page opened with a link, after calling `prepare` and then building the page."""
    builder = PageBuilder(prepare)
    line = RequestStartLine("GET", f"/app?{urlencode(link)}", "HTTP/1.1")
    request = HTTPServerRequest(start_line=line, headers=HTTPHeaders({"Host": "localhost"}))
    context = ApplicationContext(Application(builder), url="/app")
    session = await context.create_session_if_needed("session", request)  # type: ignore[arg-type]
    explorer = builder.explorer
    assert explorer is not None
    try:
        with set_curdoc(session.document):
            yield explorer, session
    finally:
        explorer.close()
        await run_callbacks(session)
        await on_loop(session, session.destroy)


async def on_loop(session: ServerSession, function: Callable[[], object]) -> None:
    """Call a function with the session's lock."""

    # The call is a coroutine, because the session would run a function in a thread.
    async def call() -> None:
        function()

    await session.with_document_locked(call)


async def tell_ready(session: ServerSession) -> None:
    """Tell the server that the page is shown, as a browser does."""
    await on_loop(session, lambda: session.document.callbacks.trigger_event(DocumentReady()))


async def wait_for(watched: param.Parameterized, name: str, condition: Callable[[Any], bool]) -> None:
    """Wait until a condition holds for the value of a parameter."""
    changed, loop = asyncio.Event(), asyncio.get_running_loop()
    watcher = watched.param.watch(lambda event: loop.call_soon_threadsafe(changed.set), name)
    async with asyncio.timeout(SECONDS):
        while not condition(getattr(watched, name)):
            changed.clear()
            await changed.wait()
    watched.param.unwatch(watcher)


async def run_callbacks(session: ServerSession) -> None:
    """Run the callbacks that wait for the session's lock, and the callbacks that those begin."""
    for _ in range(2):
        await process_state().next_turn("")
        await session.with_document_locked(lambda: None)
