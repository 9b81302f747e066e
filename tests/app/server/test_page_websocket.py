"""Changes reach a page at once. Messages of a page wait beyond its share of the event loop's time."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Any

import panel as pn
import pytest
from bokeh.application.handlers import FunctionHandler
from bokeh.document import Document
from bokeh.models import Slider
from bokeh.server import session as bokeh_session
from bokeh.server import urls
from bokeh.server.server import Server
from bokeh.server.session import ServerSession
from panel.io.application import Application
from panel.io.state import set_curdoc
from tornado.ioloop import IOLoop

from app.browser.bokeh_patches.batched_patches import batch_patches
from app.browser.bokeh_patches.inline_callbacks import call_inline
from app.runtime.fair_share import BURST_SECONDS, SHARE
from app.runtime.process_state import ProcessState, process_state
from app.server.page_websocket import DELAYED_NOTICE, PageWebSocket
from app.server.routes import install_handlers
from app.views.components.notice import Notice
from tests.app.other_loop import run_on_new_loop
from tests.page_channel import Channel, Options
from tests.waiting import SECONDS

# Addresses of two visitors.
VISITOR, OTHER = "192.0.2.1", "192.0.2.2"
# A text that is longer than the buffers of a connection.
LONG = "x" * 8 * 2**20


@pytest.fixture
def state(start_state: Callable[..., ProcessState]) -> ProcessState:
    """Install the handlers of the page, and return the state of a new server process."""
    install_handlers(urls.per_app_patterns, urls.toplevel_patterns)
    return start_state()


def build(document: Document) -> None:
    pn.Column(Notice().layout()).server_doc(document)
    document.add_root(Slider(name="slider", start=0, end=9, value=0))


def of_visitor(address: str) -> Options:
    """Return options of requests of a visitor with this address."""
    return {"headers": {"X-Forwarded-For": address}}


@asynccontextmanager
async def pages(visitors: Sequence[str], make: Callable[[Document], None] = build) -> AsyncIterator[tuple[Channel, Document]]:
    """Open a page for each visitor, given by address, and yield the channel and the document of the last page."""
    application = Application(FunctionHandler(make))
    server = Server({"/app": application}, port=0, io_loop=IOLoop.current(), address="127.0.0.1", use_xheaders=True)
    process_state().sessions = lambda: server.get_sessions("/app")
    server.start()
    address, channels = f"http://127.0.0.1:{server.port}/app", []
    try:
        for visitor in visitors:
            channels.append(await Channel.open(address, of_visitor(visitor)))
            assert await receive(channels[-1], "ACK")
        yield channels[-1], server.get_sessions("/app")[-1].document
    finally:
        for channel in channels:
            channel.close()
            # Messages in transit must arrive before the server's tasks end.
            async for _ in channel.messages():
                pass
        server.stop()


async def receive(channel: Channel, kind: str) -> str:
    """Return the content of the next message of a kind."""
    async for each, content in channel.messages():
        if each == kind:
            return content
    raise EOFError


def run(
    visitors: Sequence[str], scenario: Callable[[Channel, Document], Awaitable[None]], make: Callable[[Document], None] = build
) -> None:
    async def with_pages() -> None:
        async with asyncio.timeout(SECONDS), pages(visitors, make) as (channel, document):
            await scenario(channel, document)

    run_on_new_loop(with_pages)


def delayed_messages(state: ProcessState) -> float:
    count = state.metrics.registry.get_sample_value("escape_explorer_messages_delayed_total")
    assert count is not None
    return count


def slider_of(document: Document) -> Any:
    return document.get_model_by_name("slider")


async def move_slider(channel: Channel, document: Document) -> None:
    channel.set(slider_of(document).id, value=5)
    channel.send("SERVER-INFO-REQ", {})
    await receive(channel, "SERVER-INFO-REPLY")


def test_messages_of_a_visitor_beyond_a_fair_share_wait(state: ProcessState) -> None:
    async def scenario(channel: Channel, document: Document) -> None:
        # The visitor has used more than a share, so the next message waits for half a second.
        state.page_time(document).charge(BURST_SECONDS + 0.5 * SHARE)
        channel.set(slider_of(document).id, value=5)
        assert DELAYED_NOTICE in await receive(channel, "PATCH-DOC")
        assert slider_of(document).value == 0
        await move_slider(channel, document)
        assert slider_of(document).value == 5

    run([OTHER, VISITOR], scenario)
    assert delayed_messages(state) >= 1


def test_messages_beyond_a_fair_share_wait_while_another_visitor_waits_for_a_page(state: ProcessState) -> None:
    async def scenario(channel: Channel, document: Document) -> None:
        state.page_time(document).charge(BURST_SECONDS + 0.5 * SHARE)
        async with state.making_page.turn(OTHER):
            channel.set(slider_of(document).id, value=5)
            assert DELAYED_NOTICE in await receive(channel, "PATCH-DOC")
            assert slider_of(document).value == 0

    run([VISITOR], scenario)
    assert delayed_messages(state) >= 1


@pytest.mark.parametrize(
    ("visitors", "debt"), [([OTHER, VISITOR], 0.0), ([VISITOR, VISITOR], 10.0)], ids=["within the share", "the only visitor"]
)
def test_other_messages_do_not_wait(visitors: Sequence[str], debt: float, state: ProcessState) -> None:
    async def scenario(channel: Channel, document: Document) -> None:
        state.page_time(document).charge(debt)
        await move_slider(channel, document)
        assert slider_of(document).value == 5

    run(visitors, scenario)
    assert delayed_messages(state) == 0


def test_a_value_that_becomes_illegal_while_its_message_waits_for_the_turn_is_refused(state: ProcessState) -> None:
    next_turn = state.next_turn

    async def scenario(channel: Channel, document: Document) -> None:
        async def narrow_the_slider(visitor: str) -> None:
            await document.session_context.session.with_document_locked(setattr, slider_of(document), "end", 3)
            await next_turn(visitor)

        state.next_turn = narrow_the_slider
        await move_slider(channel, document)
        assert slider_of(document).value == 0

    run([VISITOR], scenario)


@pytest.mark.parametrize("limit", ["pages_per_address", "most_sessions"])
def test_websockets_beyond_the_limits_are_closed(limit: str, state: ProcessState) -> None:
    state.settings = replace(state.settings, **{limit: 2})

    async def scenario(channel: Channel, document: Document) -> None:
        third = await Channel.open(channel.address, of_visitor(VISITOR))
        assert [kind async for kind, _ in third.messages()] == []
        third.close()
        assert state.sockets == {VISITOR: 2}
        await move_slider(channel, document)

    run([VISITOR, VISITOR], scenario)
    assert state.sockets == {}


def test_changes_made_while_others_are_being_sent_reach_the_page(state: ProcessState, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bokeh_session, "_run_in_executor", call_inline)
    # `monkeypatch` restores the method after the test.
    monkeypatch.setattr(ServerSession, "_send_pending_patches", ServerSession._send_pending_patches)
    batch_patches()
    pane = pn.pane.HTML()

    def build_with_pane(document: Document) -> None:
        build(document)
        pane.server_doc(document)

    async def scenario(channel: Channel, document: Document) -> None:
        channel.emit("document_ready")
        await move_slider(channel, document)
        session, texts = document.session_context.session, iter(range(5))

        async def lengthen_title() -> asyncio.Task[None]:
            """Begin to send a long title under the session's lock."""
            title = f"{next(texts)}{LONG}"
            task = asyncio.create_task(session.with_document_locked(setattr, slider_of(document), "title", title))
            for _ in range(100):
                await asyncio.sleep(0)
            return task

        tasks = [await lengthen_title()]
        for _ in range(3):
            with set_curdoc(document):
                pane.object = f"{next(texts)}{LONG}"
        assert "title" in await receive(channel, "PATCH-DOC")
        # This is the first part of the message of three changes. The end of the message is still in transit.
        await channel.part()
        tasks.append(await lengthen_title())
        with set_curdoc(document):
            pane.object = "the last change"
        while "the last change" not in str(await channel.part()):
            pass
        await asyncio.gather(*tasks)

    run([VISITOR], scenario, build_with_pane)


def test_a_socket_that_is_closed_while_it_is_opened_leaves_no_connection(
    state: ProcessState, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed, opened = asyncio.Event(), asyncio.Event()
    open_session, on_close = PageWebSocket._async_open, PageWebSocket.on_close

    async def open_after_the_end(handler: PageWebSocket, token: str) -> None:
        await closed.wait()
        await open_session(handler, token)
        opened.set()

    def tell(handler: PageWebSocket) -> None:
        on_close(handler)
        closed.set()

    async def scenario(channel: Channel, document: Document) -> None:
        monkeypatch.setattr(PageWebSocket, "_async_open", open_after_the_end)
        monkeypatch.setattr(PageWebSocket, "on_close", tell)
        (await Channel.open(channel.address)).close()
        await opened.wait()
        sessions = document.session_context.server_context.sessions
        assert sum(session.connection_count for session in sessions) == 1

    run([VISITOR], scenario)
