"""Pages requested at the same time are made one after another."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

import pytest
from bokeh.application.handlers import CodeHandler
from bokeh.document import Document
from bokeh.models import Slider
from bokeh.server import urls
from bokeh.server.server import Server
from panel.io.application import Application
from tornado.httpclient import AsyncHTTPClient
from tornado.ioloop import IOLoop

from app.runtime.fair_share import BURST_SECONDS, SHARE
from app.runtime.process_state import ProcessState
from app.runtime.visitors import visitor_of
from app.server import routes
from app.server.admission import RETRY_SECONDS, admit
from app.server.routes import PageHandler, install_handlers
from tests.app.other_loop import run_on_new_loop
from tests.page_channel import Channel

COUNT = 6
# Addresses of two visitors.
GREEDY, OTHER = "192.0.2.1", "192.0.2.2"


class AdmittedPages(CodeHandler):
    """Makes pages for admitted visitors on the event loop, as the application does."""

    def __init__(self) -> None:
        super().__init__(source="", filename="pages.py")
        self.events: list[str] = []
        self.visitors: list[str] = []

    def process_request(self, request: Any) -> dict[str, Any]:
        admit(request)
        return {}

    def modify_document(self, doc: Document) -> None:
        doc.add_root(Slider(start=0, end=9, value=0))
        self.events.append("page")
        self.visitors.append(visitor_of(doc))
        asyncio.get_running_loop().call_soon(self.events.append, "another")


@pytest.fixture
def start(start_state: Callable[..., ProcessState]) -> Callable[..., ProcessState]:
    install_handlers(urls.per_app_patterns, urls.toplevel_patterns)
    return start_state


@asynccontextmanager
async def serving(state: ProcessState, pages: AdmittedPages) -> AsyncIterator[int]:
    """Run a server; yield its port."""
    options = {"port": 0, "io_loop": IOLoop.current(), "address": "127.0.0.1", "use_xheaders": True}
    server = Server({"/app": Application(pages)}, **options)
    state.sessions = lambda: server.get_sessions("/app")
    server.start()
    try:
        yield server.port
    finally:
        server.stop()


def ask_at_once(state: ProcessState, pages: AdmittedPages) -> list[int]:
    """Return the statuses of pages that one visitor requests at once."""

    async def scenario() -> list[int]:
        client = AsyncHTTPClient(force_instance=True, max_clients=COUNT)
        async with serving(state, pages) as port:
            asked = [client.fetch(f"http://127.0.0.1:{port}/app", raise_error=False) for _ in range(COUNT)]
            return [answer.code for answer in await asyncio.gather(*asked)]

    return run_on_new_loop(scenario)


def test_other_requests_are_served_between_two_pages(start: Callable[..., ProcessState]) -> None:
    pages = AdmittedPages()
    assert ask_at_once(start(pages_per_address=COUNT), pages) == [200] * COUNT
    assert pages.events == ["page", "another"] * COUNT


def test_pages_being_made_count_as_pages_of_their_visitor(start: Callable[..., ProcessState]) -> None:
    assert sorted(ask_at_once(start(pages_per_address=2), AdmittedPages())) == [200, 200] + [429] * (COUNT - 2)


def test_no_page_is_made_for_a_visitor_who_has_left(start: Callable[..., ProcessState], monkeypatch: pytest.MonkeyPatch) -> None:
    state, pages = start(), AdmittedPages()
    asked, left = asyncio.Event(), asyncio.Event()
    get_session, on_connection_close = PageHandler.get_session, PageHandler.on_connection_close

    async def tell_of_request(handler: PageHandler) -> Any:
        asked.set()
        return await get_session(handler)

    def tell_of_end(handler: PageHandler) -> None:
        on_connection_close(handler)
        left.set()

    monkeypatch.setattr(PageHandler, "get_session", tell_of_request)
    monkeypatch.setattr(PageHandler, "on_connection_close", tell_of_end)

    async def scenario() -> None:
        async with serving(state, pages) as port:
            async with state.making_page.turn("a visitor"):
                _, writer = await asyncio.open_connection("127.0.0.1", port)
                writer.write(f"GET /app HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
                await asked.wait()
                writer.close()
                await left.wait()
            client = AsyncHTTPClient(force_instance=True)
            assert (await client.fetch(f"http://127.0.0.1:{port}/app")).code == 200

    run_on_new_loop(scenario)
    assert pages.events.count("page") == 1


def test_the_next_pages_of_a_visitor_beyond_a_fair_share_wait(start: Callable[..., ProcessState]) -> None:
    state, pages = start(), AdmittedPages()

    async def scenario() -> None:
        async with serving(state, pages) as port:
            address = f"http://127.0.0.1:{port}/app"
            of_greedy, of_other = ({"headers": {"X-Forwarded-For": visitor}} for visitor in (GREEDY, OTHER))
            channel = await Channel.open(address, of_other)
            await AsyncHTTPClient().fetch(address, **of_greedy)
            [document] = [session.document for session in state.sessions() if visitor_of(session.document) == GREEDY]
            # The next page of this visitor waits for a second.
            state.page_time(document).charge(BURST_SECONDS + SHARE)
            delayed = [asyncio.ensure_future(AsyncHTTPClient().fetch(address, **of_greedy)) for _ in range(2)]
            await AsyncHTTPClient().fetch(address, **of_other)
            assert [answer.code for answer in await asyncio.gather(*delayed)] == [200, 200]
            channel.close()

    run_on_new_loop(scenario)
    assert pages.visitors == [OTHER, GREEDY, OTHER, GREEDY, GREEDY]


def test_a_page_that_waits_too_long_is_refused_and_may_be_asked_for_again(
    start: Callable[..., ProcessState], monkeypatch: pytest.MonkeyPatch
) -> None:
    state, pages = start(), AdmittedPages()

    async def scenario() -> None:
        async with serving(state, pages) as port:
            address, client = f"http://127.0.0.1:{port}/app", AsyncHTTPClient(force_instance=True)
            with monkeypatch.context() as patch:
                patch.setattr(routes, "LONGEST_PAGE_WAIT", 0.05)
                async with state.making_page.turn("a visitor"):
                    answer = await client.fetch(address, raise_error=False)
            assert (answer.code, answer.headers["Retry-After"]) == (503, str(RETRY_SECONDS))
            assert pages.events == []
            assert (await client.fetch(address)).code == 200

    run_on_new_loop(scenario)
