"""Pictures of links: their addresses, and the answers of their endpoint."""

from __future__ import annotations

import asyncio
import html
import re
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from io import BytesIO
from typing import Any

import panel as pn
import pytest
from bokeh.application.handlers import FunctionHandler
from bokeh.document import Document
from bokeh.server import tornado as bokeh_tornado
from bokeh.server.server import Server
from panel.io.application import Application
from PIL import Image
from tornado.httpclient import AsyncHTTPClient, HTTPResponse
from tornado.ioloop import IOLoop

from app.runtime import process_state as process_state_module
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings
from app.server.admission import PICTURES_PER_ADDRESS
from app.server.link_pictures import NOT_COMPILED, ROUTE, LinkPictureHandler
from app.server.page_websocket import PageWebSocket
from app.server.url_patterns import PageHandler
from app.session.page import ExplorerTemplate
from app.state.link_picture import picture_of
from engine import CASES
from engine.warmup import prepare_for_maps
from tests.app.other_loop import run_on_new_loop

PATTERNS = [("/?", PageHandler), ("/ws", PageWebSocket), (ROUTE, LinkPictureHandler)]
PICTURE = f"/app{ROUTE}?case=I&t_max=100"


@pytest.fixture
def state(monkeypatch: pytest.MonkeyPatch) -> ProcessState:
    """The state of a process that is ready."""
    prepare_for_maps(CASES["I"])
    monkeypatch.setattr(bokeh_tornado, "per_app_patterns", PATTERNS)
    monkeypatch.setattr(process_state_module, "_started", state := ProcessState(Settings(link_pictures=PICTURES_PER_ADDRESS + 1)))
    state.kernels_ready.set()
    return state


def build(document: Document) -> None:
    """A page without widgets, of a link that tries to insert a script."""
    picture = picture_of({"formula": '"><script>1</script>'})
    ExplorerTemplate(picture, **{part: pn.Column() for part in ("header", "controls", "stage")}).server_doc(document)


@asynccontextmanager
async def serving(**options: Any) -> AsyncIterator[int]:
    """The port of a server with options of `bokeh.server.server.Server`."""
    application = Application(FunctionHandler(build))
    server = Server({"/app": application}, port=0, io_loop=IOLoop.current(), address="127.0.0.1", **options)
    server.start()
    try:
        yield server.port
    finally:
        server.stop()


async def ask(port: int, path: str, headers: dict[str, str] | None = None) -> HTTPResponse:
    return await AsyncHTTPClient().fetch(f"http://127.0.0.1:{port}{path}", raise_error=False, headers=headers)


def run(scenario: Callable[[int], Awaitable[Any]], **options: Any) -> Any:
    async def with_server() -> Any:
        async with asyncio.timeout(60), serving(**options) as port:
            return await scenario(port)

    return run_on_new_loop(with_server)


def answer(path: str, headers: dict[str, str] | None = None, **options: Any) -> HTTPResponse:
    return run(lambda port: ask(port, path, headers), **options)


def picture_in(page: HTTPResponse) -> str | None:
    """The address of the picture in the head of a page."""
    found = re.search(r'<meta property="og:image" content="([^"]*)">', page.body.decode())
    return html.unescape(found[1]) if found is not None else None


@pytest.mark.usefixtures("state")
def test_the_answer_is_a_picture_that_may_be_kept() -> None:
    response = answer(PICTURE)
    assert (response.code, response.headers["Content-Type"]) == (200, "image/png")
    assert Image.open(BytesIO(response.body)).size == (1200, 630)
    assert response.headers["Cache-Control"] == "max-age=86400"
    assert response.headers["X-Content-Type-Options"] == "nosniff"


@pytest.mark.usefixtures("state")
@pytest.mark.parametrize("link", ["h=nan", "case=IV", "case=I&h=-3", "V=x^2%2By^2", "window=0,1,1,0"])
def test_an_invalid_link_is_answered_by_a_sentence(link: str) -> None:
    response = answer(f"/app{ROUTE}?{link}")
    assert (response.code, response.headers["Content-Type"]) == (400, "text/plain; charset=utf-8")
    assert response.body.decode().startswith("Ignored ")


@pytest.mark.usefixtures("state")
def test_parameters_of_others_are_ignored() -> None:
    assert answer(f"{PICTURE}&utm_source=chat&bytes=%ff").code == 200


@pytest.mark.usefixtures("state")
def test_a_potential_that_is_not_compiled_has_no_picture() -> None:
    response = answer(f"/app{ROUTE}?V=x^2/2%2By^2/2-x^2*y-0.01x^8*y")
    assert (response.code, response.body.decode()) == (503, NOT_COMPILED)


def test_a_server_that_is_not_ready_sends_no_picture(state: ProcessState) -> None:
    state.kernels_ready.clear()
    response = answer(PICTURE)
    assert (response.code, response.reason) == (503, "The integrators are being compiled.")


def test_an_address_has_few_pictures_at_a_time(state: ProcessState) -> None:
    # They wait for a thread.
    state.jobs.pause_background(True)

    async def scenario(port: int) -> None:
        waiting = [asyncio.create_task(ask(port, f"{PICTURE}&h=0.3{n}")) for n in range(PICTURES_PER_ADDRESS)]
        while state.link_pictures.total() < PICTURES_PER_ADDRESS:
            await asyncio.sleep(0)
        assert (await ask(port, PICTURE)).code == 429
        state.jobs.pause_background(False)
        assert [response.code for response in await asyncio.gather(*waiting)] == [200] * PICTURES_PER_ADDRESS

    run(scenario)
    assert state.link_pictures == {}


def test_a_picture_is_cancelled_when_its_client_leaves(state: ProcessState) -> None:
    state.jobs.pause_background(True)

    async def scenario(port: int) -> None:
        _, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(f"GET {PICTURE} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        while not state.jobs.in_flight:
            await asyncio.sleep(0)
        writer.close()
        while state.jobs.in_flight or state.link_pictures:
            await asyncio.sleep(0)

    run(scenario)


@pytest.mark.usefixtures("state")
def test_the_head_of_a_page_has_the_address_of_its_picture() -> None:
    async def scenario(port: int) -> None:
        page = await ask(port, "/app?case=III&h=0.45&utm_source=chat")
        assert picture_in(page) == f"http://127.0.0.1:{port}/app/picture.png?case=III&h=0.45"

    run(scenario)


@pytest.mark.usefixtures("state")
def test_the_address_of_a_picture_is_that_of_the_proxy() -> None:
    headers = {"Host": "maps.example.org", "X-Forwarded-Proto": "https"}
    proxy: dict[str, Any] = {"use_xheaders": True, "http_server_kwargs": {"xheaders": True}}
    page = answer("/deep/app", headers, prefix="/deep", allow_websocket_origin=["maps.example.org"], **proxy)
    assert picture_in(page) == "https://maps.example.org/deep/app/picture.png?"


@pytest.mark.usefixtures("state")
def test_texts_of_a_link_are_no_markup_in_the_head() -> None:
    text = answer("/app").body.decode()
    assert "script&gt;1" not in text
    assert "<script>1" not in text
    assert 'content="Typed potential on the plane' in text


def test_without_pictures_the_head_names_none(monkeypatch: pytest.MonkeyPatch, state: ProcessState) -> None:
    monkeypatch.setattr(state, "settings", Settings(link_pictures=0))
    page = answer("/app")
    assert picture_in(page) is None
    assert 'property="og:description"' in page.body.decode()
