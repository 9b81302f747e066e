"""Pages of a server's sessions, without a browser."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from urllib.parse import urlencode

from bokeh.application import Application
from bokeh.application.handlers import FunctionHandler
from bokeh.document import Document
from bokeh.server.callbacks import PeriodicCallback
from bokeh.server.contexts import ApplicationContext
from bokeh.server.session import ServerSession
from panel.io.state import set_curdoc
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine

from app.session.explorer import Explorer
from app.session.page import explorer_page

NO_LINK: Mapping[str, str] = {}


@asynccontextmanager
async def opened_page(
    link: Mapping[str, str] = NO_LINK, prepare: Callable[[Explorer], None] = lambda explorer: None
) -> AsyncIterator[tuple[Explorer, ServerSession]]:
    """The explorer and the session of a page that is opened with a link; `prepare` is called before it is built."""
    built: list[tuple[Explorer, Document]] = []

    def build(document: Document) -> None:
        with set_curdoc(document):
            built.append((Explorer(), document))
            prepare(built[0][0])
            explorer_page(built[0][0]).server_doc(document)

    context = ApplicationContext(Application(FunctionHandler(build)))
    # Else Bokeh builds the page in a thread.
    context._can_initialize_document_in_worker = lambda: False  # type: ignore[method-assign]
    line = RequestStartLine("GET", f"/app?{urlencode(link)}", "HTTP/1.1")
    request = HTTPServerRequest(start_line=line, headers=HTTPHeaders({"Host": "localhost"}))
    session = await context.create_session_if_needed("session", request)  # type: ignore[arg-type]
    [(explorer, document)] = built
    try:
        with set_curdoc(document):
            yield explorer, session
    finally:
        explorer.close()


async def settle(document: Document) -> None:
    """Wait until no callback is due or under way, also none that another one began: the loop ends after that."""
    for each in document.session_callbacks:
        if isinstance(each, PeriodicCallback):
            document.remove_periodic_callback(each)
    quiet = 0
    async with asyncio.timeout(30.0):
        while quiet < 10:
            quiet = 0 if document.session_callbacks or len(asyncio.all_tasks()) > 1 else quiet + 1
            await asyncio.sleep(0.01)


async def wait_for(condition: Callable[[], bool]) -> None:
    """Wait until a condition holds."""
    async with asyncio.timeout(30.0):
        while not condition():
            await asyncio.sleep(0.01)
