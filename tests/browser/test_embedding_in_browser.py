"""A frame in a page of another origin shows one picture of the page."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from urllib.parse import quote

import pytest
from playwright.sync_api import Browser, Frame, Page, expect

from tests.browser.host_page import host_server
from tests.conftest import TIMEOUT_MS

LINK = "?case=III&plane=x_y&h=0.45&t_max=100&resolution=112&embed=basins"
SIDE = 500
_IS_COMPLETE = "window.Bokeh?.documents.length && Bokeh.documents[0].get_model_by_name('maps')?.data.complete[0] === true"
# Names of the visible pictures, with their width on the screen.
_SEEN = """() => Object.fromEntries([...Bokeh.index.all_views()]
    .filter(view => view.model.type == "Figure" && view.el.offsetWidth > 0)
    .map(view => [view.model.name, view.el.offsetWidth]))"""


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
    """Open a page of another origin that contains the code of a frame, and return the frame."""
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
def test_a_wheel_zooms_without_an_entry_of_the_page_around_and_the_link_opens_the_view(
    page: Page, host: str, server: str
) -> None:
    frame = embed(page, host, frame_code(server))
    wait_until_complete(frame)
    entries = page.evaluate("history.length")
    move_to_middle(page)
    expect(frame.get_by_text(re.compile(r"\(−?0\.\d+, −?0\.\d+\)")).first).to_be_visible()
    page.mouse.wheel(0, -240)
    frame.wait_for_url(re.compile("window="))
    assert page.evaluate("history.length") == entries
    page.mouse.down()
    page.mouse.up()
    frame.wait_for_url(re.compile("embed=basins.*orbits=|orbits=.*embed=basins"))
    with page.context.expect_page() as opened:
        frame.get_by_role("link", name="Open in the explorer").click()
    whole = opened.value
    whole.set_default_timeout(TIMEOUT_MS)
    assert "orbits=" in whole.url
    assert "focus=basins" in whole.url
    assert "embed=" not in whole.url
    expect(whole.get_by_role("button", name="Share", exact=True)).to_be_visible()


def test_pages_of_other_origins_cannot_embed_it(page: Page, server: str) -> None:
    refused: list[str] = []
    page.on("console", lambda message: refused.append(message.text) if message.type == "error" else None)
    with host_server() as stranger:
        frame = embed(page, stranger, frame_code(server))
        frame.wait_for_load_state()
    assert "frame-ancestors" in " ".join(refused)
    assert not frame.evaluate("() => 'Bokeh' in window")
