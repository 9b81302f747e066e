"""Quoted text is shown on the page as text, and never interpreted as markup."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import partial
from html import escape

import panel as pn
import pytest
from playwright.sync_api import Browser

from app.job_clients.orbit_requests import StartOrbit
from app.state.system_review import review_catalogue_entry
from app.state.view_state import ViewState
from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.analysis.potential_panel import PotentialPanel
from app.views.analysis.study_view import StudyView
from app.views.components.notice import Notice
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from plots.studies.against import AGAINST
from tests.conftest import TIMEOUT_MS
from tests.waiting import SECONDS

HOSTILE = (
    '<img src=x onerror="window.hit=1"> &lt;img src=x onerror="window.hit=2"&gt; [a](javascript:window.hit=3) *b* `c` '
    "<script>window.hit=4</script> x**2 _d_ # e ~f~ | g"
)


def orbit_controls() -> OrbitControls:
    return OrbitControls(ViewState(), OrbitActions(*[lambda *_: None] * len(fields(OrbitActions))))


def test_quoted_text_is_escaped() -> None:
    notice, controls, panel = Notice(), orbit_controls(), PotentialPanel(review_catalogue_entry("I"), lambda system, done: None)
    curves = StudyView(AGAINST, ViewState(), lambda: None, lambda click: None)
    measures = BasinMeasuresView(ViewState(), lambda name: None, lambda text: None)
    says: list[tuple[Callable[[str], None], pn.pane.HTML]] = [
        (notice.warn, notice.layout()),
        (notice.show, notice.layout()),
        (controls.say, controls.note),
        (lambda text: controls.show([StartOrbit((0.1, 0.2), problem=text)], 0), controls.text),
        (curves.say, curves.text),
        (partial(measures.say, "wada"), measures.text),
        (panel.say, panel.message),
    ]
    for say, pane in says:
        say(HOSTILE)
        assert escape(HOSTILE) in pane.object
        assert "<img" not in pane.object


def _page() -> pn.viewable.Viewable:
    notice = Notice()
    notice.warn(HOSTILE)
    return notice.layout()


@pytest.fixture
def address() -> Iterator[str]:
    """Yield the address of a page that shows only a warning."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    thread = pn.serve({"page": _page}, threaded=True, show=False, port=port, address="127.0.0.1")
    yield f"http://127.0.0.1:{port}/page"
    thread.stop()
    thread.join(SECONDS)


@pytest.mark.browser
def test_warning_executes_nothing_in_the_browser(address: str, chromium: Browser) -> None:
    page = chromium.new_page()
    page.set_default_timeout(TIMEOUT_MS)
    page.goto(address)
    shown = page.locator(".alert")
    shown.wait_for(state="attached")
    # An image that fails to load is reported before the page has drawn two frames.
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert page.evaluate("window.hit") is None
    assert (shown.text_content() or "").strip() == HOSTILE
    page.close()
