"""What a sentence quotes is shown, and never taken for markup."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from html import escape
from html.parser import HTMLParser

import panel as pn
import pytest
from hypothesis import given
from playwright.sync_api import Browser

from app.job_clients.error_messages import as_markdown
from app.job_clients.orbit_requests import ChosenOrbit
from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.analysis.energy_curves import EnergyCurvesView
from app.views.analysis.potential_panel import PotentialPanel
from app.views.components.progress import ProgressView
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from tests.fuzz.hostile import texts

HOSTILE = (
    '<img src=x onerror="window.hit=1"> &lt;img src=x onerror="window.hit=2"&gt; [a](javascript:window.hit=3) *b* `c` '
    "<script>window.hit=4</script> x**2 _d_ # e ~f~ | g"
)


class Text(HTMLParser):
    """Reads the text of HTML that may hold no element."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.read = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        raise AssertionError(f"an element {tag}")

    def handle_data(self, data: str) -> None:
        self.read += data


@given(texts)
def test_a_text_is_without_markup_and_reads_as_before(text: str) -> None:
    written = as_markdown(text)
    assert not set(written) & set("<>[]()*_`~|\"'\\!")
    if not any(0xD800 <= ord(one) <= 0xDFFF or ord(one) < 32 or 127 <= ord(one) < 160 for one in text):
        reader = Text()
        reader.feed(written)
        reader.close()
        assert reader.read == text


def test_a_warning_on_the_page_is_written_that_way() -> None:
    view = ProgressView(lambda: None, lambda: None)
    view.warn(HOSTILE)
    assert view.problem.object == as_markdown(HOSTILE)


def _desk() -> tuple[Callable[[str], None], pn.pane.HTML]:
    desk = OrbitControls(OrbitActions(*[lambda *_: None] * len(fields(OrbitActions))))
    return desk.say, desk.note


def _verdict() -> tuple[Callable[[str], None], pn.pane.HTML]:
    desk = OrbitControls(OrbitActions(*[lambda *_: None] * len(fields(OrbitActions))))
    return lambda said: desk.show([ChosenOrbit((0.1, 0.2), problem=said)], 0), desk.text


def _curves() -> tuple[Callable[[str], None], pn.pane.HTML]:
    curves = EnergyCurvesView(lambda *_: None, lambda *_: None)
    return curves.say, curves.text


def _measures() -> tuple[Callable[[str], None], pn.pane.HTML]:
    measures = BasinMeasuresView(lambda *_: None)
    return measures.say, measures.text


def _potential() -> tuple[Callable[[str], None], pn.pane.HTML]:
    panel = PotentialPanel(lambda _: None, lambda _: None)
    return panel.say, panel.said


@pytest.mark.parametrize("make", [_desk, _verdict, _curves, _measures, _potential])
def test_every_pane_of_html_shows_a_sentence_as_text(make: Callable[[], tuple[Callable[[str], None], pn.pane.HTML]]) -> None:
    say, pane = make()
    say(HOSTILE)
    assert escape(HOSTILE) in pane.object
    assert "<img" not in pane.object


def _warning() -> pn.viewable.Viewable:
    view = ProgressView(lambda: None, lambda: None)
    view.warn(HOSTILE)
    return view.layout()


@pytest.fixture
def address() -> Iterator[str]:
    """Of a page with nothing but a warning."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    thread = pn.serve({"page": _warning}, threaded=True, show=False, port=port, address="127.0.0.1")
    yield f"http://127.0.0.1:{port}/page"
    thread.stop()
    thread.join(10)


@pytest.mark.browser
def test_a_warning_runs_nothing_in_the_browser(address: str, chromium: Browser) -> None:
    page = chromium.new_page()
    page.goto(address, timeout=120_000)
    shown = page.locator(".MuiAlert-message")
    shown.wait_for(timeout=60_000)
    time.sleep(0.5)
    assert page.evaluate("window.hit") is None
    assert shown.inner_text().strip() == HOSTILE
    page.close()
