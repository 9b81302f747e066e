"""One picture in a frame of another page."""

from __future__ import annotations

import http.server
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from urllib.parse import quote, unquote, urlsplit

import pytest
from playwright.sync_api import Browser, Frame, Page, expect

from tests.browser.served_app import served_app
from tests.conftest import TIMEOUT_MS

LINK = "?case=III&plane=x_y&h=0.45&t_max=100&resolution=112&embed=basins"
SIDE = 500
_IS_COMPLETE = "window.Bokeh?.documents.length && Bokeh.documents[0].get_model_by_name('maps')?.data.complete[0] === true"
# Names of the pictures that are seen, with their width on the screen.
_SEEN = """() => Object.fromEntries([...Bokeh.index.all_views()]
    .filter(view => view.model.type == "Figure" && view.el.offsetWidth > 0)
    .map(view => [view.model.name, view.el.offsetWidth]))"""


class HostHandler(http.server.BaseHTTPRequestHandler):
    """Answers with a page that contains the code in the query string."""

    def do_GET(self) -> None:
        code = unquote(urlsplit(self.path).query)
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.end_headers()
        self.wfile.write(f"<!doctype html><h1>A talk</h1>{code}".encode())

    def log_message(self, format: str, *args: object) -> None:
        pass


@contextmanager
def host_server() -> Iterator[str]:
    """The origin of a server of pages that contain frames. Chromium lets no page of an intercepted address embed a local one."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), HostHandler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@pytest.fixture(scope="module")
def host() -> Iterator[str]:
    """The origin that may embed the page."""
    with host_server() as origin:
        yield origin


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory, host: str) -> Iterator[str]:
    """The address of the app."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ESCAPE_EXPLORER_FRAME_ANCESTORS", host)
        with served_app(tmp_path_factory.mktemp("server") / "log") as address:
            yield address


@pytest.fixture
def page(chromium: Browser) -> Iterator[Page]:
    context = chromium.new_context(viewport={"width": 1200, "height": 800}, permissions=["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.set_default_timeout(TIMEOUT_MS)
    yield page
    context.close()


def frame_code(server: str) -> str:
    return f'<iframe src="{escape(server + LINK)}" width="{SIDE}" height="{SIDE}"></iframe>'


def embed(page: Page, origin: str, code: str) -> Frame:
    """Open a page of another origin that contains the code of a frame."""
    page.goto(f"{origin}/?{quote(code)}")
    return page.frames[1]


def wait_until_complete(frame: Frame) -> None:
    frame.wait_for_function(_IS_COMPLETE)


def move_to_middle(page: Page) -> None:
    box = page.locator("iframe").bounding_box()
    assert box is not None
    for offset in (3.0, 0.0):
        page.mouse.move(box["x"] + 0.5 * box["width"] - offset, box["y"] + 0.4 * box["height"])


def test_one_picture_fills_the_frame(page: Page, host: str, server: str) -> None:
    frame = embed(page, host, frame_code(server))
    wait_until_complete(frame)
    seen = frame.evaluate(_SEEN)
    assert seen.keys() == {"basins"}
    assert seen["basins"] == pytest.approx(SIDE, abs=4)
    expect(frame.locator(".frame-header")).to_have_count(0)
    assert [button.inner_text() for button in frame.get_by_role("button").all() if button.is_visible()] == ["?"]


@pytest.mark.slow
def test_a_wheel_zooms_and_the_history_of_the_page_around_has_no_entry(page: Page, host: str, server: str) -> None:
    frame = embed(page, host, frame_code(server))
    wait_until_complete(frame)
    entries = page.evaluate("history.length")
    move_to_middle(page)
    page.mouse.wheel(0, -240)
    frame.wait_for_url(re.compile("window="))
    assert "embed=basins" in frame.url
    assert page.evaluate("history.length") == entries


@pytest.mark.slow
def test_the_text_at_the_mouse_is_shown(page: Page, host: str, server: str) -> None:
    frame = embed(page, host, frame_code(server))
    wait_until_complete(frame)
    move_to_middle(page)
    expect(frame.get_by_text(re.compile(r"\(-?0\.\d+, -?0\.\d+\)")).first).to_be_visible()


@pytest.mark.slow
def test_the_link_opens_the_view_of_the_moment(page: Page, host: str, server: str) -> None:
    frame = embed(page, host, frame_code(server))
    wait_until_complete(frame)
    move_to_middle(page)
    page.mouse.down()
    page.mouse.up()
    frame.wait_for_url(re.compile("orbits="))
    with page.context.expect_page() as opened:
        frame.get_by_role("link", name="Open in the explorer").click()
    whole = opened.value
    whole.set_default_timeout(TIMEOUT_MS)
    assert "orbits=" in whole.url
    assert "focus=basins" in whole.url
    assert "embed=" not in whole.url
    expect(whole.get_by_role("button", name="Share", exact=True)).to_be_visible()


@pytest.mark.slow
def test_the_code_of_the_drawer_embeds_the_picture(page: Page, host: str, server: str) -> None:
    page.goto(f"{server}?case=II&t_max=100&resolution=112&focus=times")
    wait_until_complete(page.main_frame)
    page.get_by_role("button", name="Share", exact=True).click()
    page.get_by_role("button", name="Copy embed code").click()
    expect(page.get_by_text("Copied.")).to_be_visible()
    frame = embed(page, host, page.evaluate("navigator.clipboard.readText()"))
    wait_until_complete(frame)
    assert frame.evaluate(_SEEN).keys() == {"times"}


def test_pages_of_other_origins_cannot_embed_it(page: Page, server: str) -> None:
    refused: list[str] = []
    page.on("console", lambda message: refused.append(message.text) if message.type == "error" else None)
    with host_server() as stranger:
        frame = embed(page, stranger, frame_code(server))
        frame.wait_for_load_state()
    assert "frame-ancestors" in " ".join(refused)
    assert not frame.evaluate("() => 'Bokeh' in window")
