"""Faults of pages and connections affect one page only, and are shown as a sentence in the browser."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from urllib.parse import quote

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import RunningApp, running_app
from tests.conftest import TIMEOUT_MS
from tests.waiting import SECONDS, wait_until

pytestmark = [pytest.mark.browser, pytest.mark.slow]

# A map of bounded orbits, whose integration takes longer than any test.
LONG_MAP = "?case=III&h=0.26&resolution=900&t_max=1e%2B06&plane=x_y"
HOSTILE = '<img src=x onerror="window.hit=1">'
# Lifetime of unused sessions in ms: longer than it takes to connect, and short enough to wait for the end of a session.
LIFETIME = ("--unused-session-lifetime", "6000", "--check-unused-sessions", "500")

# Sends a value that the control itself would not send.
_SEND_INVALID_VALUE = """label => {
    for (const model of Bokeh.documents[0].all_models)
        if (model.title === label) { model.value = 'not-an-option'; return true }
    return false
}"""


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningApp]:
    with running_app(tmp_path_factory.mktemp("served") / "log", *LIFETIME) as running:
        yield running


@pytest.fixture
def open_page(chromium: Browser, served: RunningApp) -> Iterator[Callable[..., Page]]:
    """Yield a function that opens the page, or a link to a view, in a new browser context. Close the contexts after the test."""
    contexts = []

    def open_link(link: str = "") -> Page:
        context = chromium.new_context(viewport={"width": 1400, "height": 1000})
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(TIMEOUT_MS)
        page.goto(served.address + link)
        return page

    yield open_link
    for context in contexts:
        context.close()


def test_closed_page_cancels_its_job_and_ends_its_session(open_page: Callable[..., Page], served: RunningApp) -> None:
    page = open_page(LONG_MAP)
    wait_until(lambda: served.figure("jobs_in_flight") == 1)
    page.context.close()
    wait_until(lambda: served.figure("websockets_open") == 0)
    wait_until(lambda: served.figure("jobs_in_flight") == 0)
    assert served.figure("sessions_open") == 1
    wait_until(lambda: served.figure("sessions_open") == 0)


def test_failing_callback_does_not_affect_pages(open_page: Callable[..., Page], served: RunningApp) -> None:
    broken, other = ExplorerPage(open_page(QUICK)), ExplorerPage(open_page(QUICK))
    for explorer in (broken, other):
        explorer.wait_until_complete()
    broken.open_fold("Quality and colours")
    assert broken.page.evaluate(_SEND_INVALID_VALUE, "t_max")
    served.output.wait_for("not-an-option")
    for explorer, energy in ((other, "0.21"), (broken, "0.22")):
        explorer.forget_pixels()
        explorer.type_number("Exact h", energy)
        explorer.wait_for_new_pixels()
        explorer.wait_until_complete()
    assert served.process.poll() is None


def test_hostile_formulas_are_shown_and_not_executed(open_page: Callable[..., Page]) -> None:
    page = open_page(f"?case=typed&V={quote('x ' + HOSTILE)}")
    warning = page.locator(".alert").first
    warning.wait_for()
    expect(warning).to_contain_text("Ignored the potential in the link: formula, character 3: '<' is not understood")
    ExplorerPage(page).wait_until_complete()
    page.get_by_role("button", name="Other …").click()
    box = page.get_by_label("V(x, y) =")
    box.fill(HOSTILE)
    box.press("Enter")
    reason = page.get_by_role("status").filter(has_text="formula, character 1")
    expect(reason).to_contain_text("'<' is not understood")
    assert page.evaluate("window.hit") is None


def test_lost_connection_is_shown(open_page: Callable[..., Page], served: RunningApp) -> None:
    # Must be the last test in this file, as it kills the server.
    page = open_page(QUICK)
    ExplorerPage(page).wait_until_complete()
    served.process.send_signal(signal.SIGKILL)
    served.process.wait(SECONDS)
    page.get_by_text("The connection to the server is lost.").wait_for(timeout=TIMEOUT_MS)
