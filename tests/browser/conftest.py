"""Fixtures: the app, served on loopback, and pages in Chromium whose errors and external requests are recorded."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import (
    Browser,
    BrowserContext,
    ConsoleMessage,
    Page,
    Request,
    Response,
)

from tests.browser.explorer_page import ExplorerPage
from tests.browser.host_page import host_server
from tests.browser.served_app import served_app
from tests.conftest import TIMEOUT_MS

QUICK = "?case=I&plane=x_px&h=0.19&t_max=100&resolution=112"
"""Link to a map that is computed in moments."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.browser)


@pytest.fixture(scope="session")
def host() -> Iterator[str]:
    """Yield the origin whose pages may contain the page in a frame."""
    with host_server() as origin:
        yield origin


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory, host: str) -> Iterator[str]:
    """Yield the address of the app, whose log must not have a traceback."""
    log = tmp_path_factory.mktemp("server") / "log"
    with pytest.MonkeyPatch.context() as patch, ExitStack() as stack:
        patch.setenv("ESCAPE_EXPLORER_FRAME_ANCESTORS", host)
        # Tests read the pixels of the chosen resolution.
        patch.setenv("ESCAPE_EXPLORER_SHARPEST_RESOLUTION", "0")
        address = stack.enter_context(served_app(log))
        yield address
        # The log is read before the server stops, because Bokeh then logs errors of pages that are still connecting.
        text = log.read_text()
    assert "Traceback" not in text, text


# Messages that are no problems. Without a graphics card, the driver of Chromium reports that it is slow. Bokeh rebuilds the label
# of a button before the previous rebuild ends (`AbstractButtonView._rebuild_label`), and warns that it removes a label twice.
_HARMLESS = re.compile(r"GL Driver Message|bokeh\.models\.dom\.TextView\(\w+\)\.remove\(\): view was already destroyed")


class Watch:
    """Records errors, warnings, failed requests, and requests that do not begin with an origin, by default that of the app."""

    def __init__(self, page: Page, origin: str = "http://127.0.0.1:") -> None:
        self.problems: list[str] = []
        self._origins = (origin, "data:", "blob:")
        page.on("console", self._console)
        page.on("pageerror", lambda error: self.problems.append(f"page error: {error.stack}"))
        page.on("request", self._request)
        page.on("response", self._response)

    def _console(self, message: ConsoleMessage) -> None:
        if message.type in ("error", "warning") and not _HARMLESS.search(message.text):
            self.problems.append(f"console: {message.text}")

    def _request(self, request: Request) -> None:
        if not request.url.startswith(self._origins):
            self.problems.append(f"external request: {request.url}")

    def _response(self, response: Response) -> None:
        if response.status >= 400:
            self.problems.append(f"{response.status}: {response.url}")


@pytest.fixture
def open_explorer(chromium: Browser, server: str) -> Iterator[Callable[..., ExplorerPage]]:
    """Yield a function that opens the page, or a link to a view, in a new browser context with a window of a given size."""
    with _opening(chromium, server) as open_page:
        yield open_page


@pytest.fixture(scope="module")
def open_for_all(chromium: Browser, server: str) -> Iterator[Callable[..., ExplorerPage]]:
    """Yield the function of `open_explorer` for pages that the tests of a module share, and leave as they were."""
    with _opening(chromium, server) as open_page:
        yield open_page


@pytest.fixture
def open_offline(chromium: Browser) -> Iterator[Callable[..., Page]]:
    """Yield a function that opens a file without a network, in a window of a given width, which may read files of its folder."""
    contexts: list[BrowserContext] = []
    watches: list[Watch] = []

    def open_file(file: Path, width: int = 1280, theme: str = "light", **options: Any) -> Page:
        window = {"width": width, "height": 900}
        contexts.append(chromium.new_context(viewport=window, color_scheme=theme, offline=True, **options))
        page = contexts[-1].new_page()
        page.set_default_timeout(TIMEOUT_MS)
        watches.append(Watch(page, f"{file.parent.as_uri()}/"))
        page.goto(file.as_uri())
        return page

    yield open_file
    _close(contexts, watches)


@contextmanager
def _opening(chromium: Browser, server: str) -> Iterator[Callable[..., ExplorerPage]]:
    contexts: list[BrowserContext] = []
    watches: list[Watch] = []

    def open_page(
        width: int = 1600,
        height: int = 1400,
        link: str = "",
        *,
        touch: bool = False,
        theme: str = "light",
    ) -> ExplorerPage:
        context = chromium.new_context(
            viewport={"width": width, "height": height},
            has_touch=touch,
            color_scheme=theme,
            permissions=["clipboard-read", "clipboard-write"],
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(TIMEOUT_MS)
        watches.append(Watch(page))
        explorer = ExplorerPage(page, server + link, watches[-1].problems)
        explorer.open()
        return explorer

    yield open_page
    _close(contexts, watches)


def _close(contexts: list[BrowserContext], watches: list[Watch]) -> None:
    """Close pages, which must have had no problems."""
    for context in contexts:
        context.close()
    assert [problem for watch in watches for problem in watch.problems] == []


@pytest.fixture(scope="session")
def opened(chromium: Browser, server: str) -> Iterator[ExplorerPage]:
    """Yield the page behind `explorer`, with a map that takes little time. A module may override this fixture."""
    with _opening(chromium, server) as open_page:
        yield open_page(link=QUICK)


@pytest.fixture
def explorer(opened: ExplorerPage, request: pytest.FixtureRequest) -> Iterator[ExplorerPage]:
    """Yield a page that many tests share. Each test may change page and window, which return to their first state after it."""
    failed, window = request.session.testsfailed, opened.page.viewport_size
    assert window is not None
    yield opened
    opened.page.set_viewport_size(window)
    if request.session.testsfailed > failed:
        opened.open()
    else:
        opened.return_home()
    assert opened.take_problems() == []
