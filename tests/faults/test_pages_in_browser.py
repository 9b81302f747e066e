"""Faults between a page and its server, in a browser: one page's trouble is nobody else's, and each is said in a sentence."""

from __future__ import annotations

import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import quote

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import RunningApp, running_app

pytestmark = pytest.mark.browser

# Bounded orbits, followed for longer than any test takes.
LONG_MAP = "?case=III&h=0.26&resolution=900&t_max=1e%2B06&plane=x_y"
HOSTILE = '<img src=x onerror="window.hit=1">'
PATIENCE_MS = 60_000
# Longer than a visitor needs to connect, and short enough to see it end.
LIFETIME = ("--unused-session-lifetime", "3000", "--check-unused-sessions", "500")

# What a page may send that none of its own controls would.
_SEND_NONSENSE = """label => {
    for (const model of Bokeh.documents[0]._all_models.values())
        if (model.data?.label === label) { model.data.value = 'nonsense'; return true }
    return false
}"""


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("served") / "log"


@pytest.fixture(scope="module")
def served(log: Path) -> Iterator[RunningApp]:
    with running_app(log, *LIFETIME) as running:
        yield running


@pytest.fixture
def open_page(chromium: Browser, served: RunningApp) -> Iterator[Callable[..., Page]]:
    """Opens the page, or a link to a view, in a visitor of its own; it is closed in the end, and with it what it asked for."""
    contexts = []

    def open_link(link: str = "") -> Page:
        context = chromium.new_context(viewport={"width": 1400, "height": 1000})
        contexts.append(context)
        context.add_init_script("localStorage.setItem('escape-explorer-visited', 'yes')")
        page = context.new_page()
        page.set_default_timeout(PATIENCE_MS)
        page.goto(served.address + link)
        return page

    yield open_link
    for context in contexts:
        context.close()


def wait_for(condition: Callable[[], bool], seconds: float) -> float:
    """How many seconds it took until a condition held."""
    begun = time.monotonic()
    while not condition():
        assert time.monotonic() - begun < seconds, f"not within {seconds} s"
        time.sleep(0.05)
    return time.monotonic() - begun


def test_a_page_that_is_closed_takes_its_job_with_it_and_then_its_session(
    open_page: Callable[..., Page], served: RunningApp
) -> None:
    page = open_page(LONG_MAP)
    wait_for(lambda: served.figure("jobs_in_flight") == 1, 60)
    page.context.close()
    wait_for(lambda: served.figure("websockets_open") == 0, 10)
    assert wait_for(lambda: served.figure("jobs_in_flight") == 0, 10) < 1.0
    wait_for(lambda: served.figure("sessions_open") == 0, 30)


def test_a_callback_that_fails_leaves_the_others_and_its_own_page_working(
    open_page: Callable[..., Page], served: RunningApp, log: Path
) -> None:
    broken, other = ExplorerPage(open_page()), ExplorerPage(open_page())
    for explorer in (broken, other):
        explorer.wait_until_complete()
    assert broken.page.evaluate(_SEND_NONSENSE, "t_max")
    wait_for(lambda: "nonsense" in log.read_text(), 30)
    for explorer, energy in ((other, "0.21"), (broken, "0.22")):
        explorer.forget_pixels()
        explorer.type_number("h exactly", energy)
        explorer.wait_for_new_pixels()
        explorer.wait_until_complete()
    assert served.process.poll() is None


def test_a_hostile_formula_in_a_link_and_a_typed_one_are_shown_and_not_run(open_page: Callable[..., Page]) -> None:
    page = open_page(f"?case=typed&V={quote('x ' + HOSTILE)}")
    warned = page.locator(".MuiAlert-message").first
    warned.wait_for()
    expect(warned).to_contain_text("The potential in the link is of no use: formula, character 3: '<' is not understood")
    ExplorerPage(page).wait_until_complete()
    page.get_by_role("button", name="Other …").click()
    box = page.get_by_label("V(x, y) =")
    box.fill(HOSTILE)
    box.press("Enter")
    said = page.get_by_role("alert").filter(has_text="formula, character 1")
    said.wait_for()
    expect(said).to_contain_text("'<' is not understood")
    assert page.evaluate("window.hit") is None


def test_a_page_whose_server_is_gone_says_so(chromium: Browser, tmp_path: Path) -> None:
    with running_app(tmp_path / "log", *LIFETIME) as running:
        page = chromium.new_page()
        page.goto(running.address)
        ExplorerPage(page).wait_until_complete()
        running.process.send_signal(signal.SIGKILL)
        running.process.wait(30)
        page.get_by_text("The connection to the server is lost.").wait_for(timeout=PATIENCE_MS)
        page.close()
