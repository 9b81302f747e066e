"""The potential of a link, of a preset or of the browser's history is reviewed in another process."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any
from urllib.parse import urlencode

import pytest
from bokeh.application import Application
from bokeh.application.handlers import FunctionHandler
from bokeh.document import Document
from bokeh.server.callbacks import PeriodicCallback
from bokeh.server.contexts import ApplicationContext
from panel.io.state import set_curdoc
from tornado.httputil import HTTPHeaders, HTTPServerRequest, RequestStartLine

from app.session.explorer import Explorer
from app.session.page import explorer_page
from app.state import system_review as reviews_module
from engine import CASES, Plane, System, Window
from engine.potentials import system as system_module
from engine.potentials import well as well_module
from engine.potentials.forms import polynomial_form as polynomial_module
from engine.potentials.review.potential_review import review_system
from engine.potentials.system import TYPED
from tests.app.other_loop import run_on_new_loop

CIRCULAR = {"case": TYPED, "V": "r^2/2 - r^4 + r^6 - r^8 + r^10 - 1.0183r^12"}
LEGAL = {"case": TYPED, "V": "½(x² + y²) − 0.83x²y²"}
# Whatever takes time; a potential has no other costly quantities.
SLOW = [
    (system_module, "parse_formula"),
    (reviews_module, "review_system"),
    (polynomial_module, "find_critical_points"),
    (well_module, "leads_out_of_well"),
    (well_module, "find_maxima_beside"),
]


@pytest.fixture
def called(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The slow functions that are called in this process."""
    called: list[str] = []
    # As when the server starts.
    for case in CASES:
        reviews_module.review_catalogue_entry(case)

    def recording(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **options: Any) -> Any:
            called.append(name)
            return function(*arguments, **options)

        return call

    monkeypatch.setattr(well_module, "stored_points", lambda kind, terms, find: find())
    for module, name in SLOW:
        monkeypatch.setattr(module, name, recording(name, getattr(module, name)))
    return called


async def wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + 20.0
    while not condition() and time.monotonic() < end:
        await asyncio.sleep(0.01)
    assert condition()


async def settle(document: Document) -> None:
    """Wait until no callback is due or under way, also none that another one began: the loop ends after that."""
    for each in document.session_callbacks:
        if isinstance(each, PeriodicCallback):
            document.remove_periodic_callback(each)
    end, quiet = time.monotonic() + 10.0, 0
    while quiet < 10 and time.monotonic() < end:
        quiet = 0 if document.session_callbacks or len(asyncio.all_tasks()) > 1 else quiet + 1
        await asyncio.sleep(0.01)


def with_page(parameters: dict[str, str], check: Callable[[Explorer], Coroutine[Any, Any, None]]) -> None:
    """Open a page with a link on a new event loop and check it."""

    async def run() -> None:
        built: list[Explorer] = []

        def build(document: Document) -> None:
            with set_curdoc(document):
                built.append(Explorer())
                explorer_page(built[0]).server_doc(document)

        context = ApplicationContext(Application(FunctionHandler(build)))
        context._can_initialize_document_in_worker = lambda: False  # type: ignore[method-assign]
        line = RequestStartLine("GET", f"/app?{urlencode(parameters)}", "HTTP/1.1")
        request = HTTPServerRequest(start_line=line, headers=HTTPHeaders({"Host": "localhost"}))
        session = await context.create_session_if_needed("session", request)  # type: ignore[arg-type]
        try:
            with set_curdoc(session.document):
                built[0].links.begin(built[0]._begin_view)
                await check(built[0])
        finally:
            built[0].close()
            await settle(session.document)

    run_on_new_loop(run)


def test_a_circular_potential_in_a_link_is_refused_in_another_process(called: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        assert "Reviewing" in explorer.progress.text.object
        await wait_for(lambda: "Ignored the potential in the link" in explorer.notice._pane.object)
        assert "circular potential" in explorer.notice._pane.object
        assert (explorer.state.case, explorer.state.t_max) == ("I", 1e3)

    with_page(CIRCULAR | {"t_max": "1e3", "h": "0.7"}, check)
    assert not called


def test_a_link_is_shown_whole_when_its_potential_has_passed(called: list[str]) -> None:
    asked = {"plane": "x_y", "h": "0.4", "window": "-1,1,-0.5,0.5", "orbits": "0.1,0.2", "resolution": "112", "t_max": "100"}

    async def check(explorer: Explorer) -> None:
        state = explorer.state
        assert (state.case, state.resolution, state.starts) == ("I", 112, ())
        await wait_for(lambda: state.case == TYPED)
        assert (state.plane, state.energy, state.starts) == (Plane.X_Y, 0.4, ((0.1, 0.2),))
        assert state.window == Window(-1.0, 1.0, -0.5, 0.5)
        assert explorer.links.history.entry == 0

    with_page(LEGAL | asked, check)
    assert not called


def test_a_view_to_compare_with_that_is_refused_is_told_beside_other_problems() -> None:
    async def check(explorer: Explorer) -> None:
        await wait_for(lambda: "Ignored the view in the link" in explorer.notice._pane.object)
        assert "Ignored palette=none" in explorer.notice._pane.object
        assert "the formula ends" in explorer.notice._pane.object
        assert explorer.state.compared is None

    with_page({"with_V": "x +", "with_h": "0.2", "palette": "none"}, check)


def test_a_typed_potential_is_reviewed_in_another_process(called: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        explorer.potential.panel.formula._receive({"text": "½(x² + y²) − 0.79x²y²", "typed": 1, "done": True})
        await wait_for(lambda: explorer.state.case == TYPED)
        assert explorer.state.potential.channels == 4

    with_page({}, check)
    assert not called


def test_an_entry_of_the_browsers_history_is_reviewed_in_another_process(called: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        explorer.links.navigate("?" + urlencode(LEGAL | {"h": "0.5"}), 0, 0)
        assert explorer.state.case == "I"
        await wait_for(lambda: explorer.state.case == TYPED)
        assert explorer.state.energy == 0.5

    with_page({}, check)
    assert not called


def test_a_choice_made_during_a_review_is_kept() -> None:
    async def check(explorer: Explorer) -> None:
        explorer.controls.case.value = "III"
        explorer.potential._on_review(review_system(System(TYPED, LEGAL["V"])))
        assert explorer.state.system == System("III")

    with_page(LEGAL, check)


def test_a_refused_entry_of_the_history_leaves_the_view_with_a_reason() -> None:
    async def check(explorer: Explorer) -> None:
        explorer.links.navigate("?" + urlencode(CIRCULAR | {"h": "0.5", "resolution": "112"}), 0, 0)
        assert "Reviewing" in explorer.progress.text.object
        await wait_for(lambda: "Ignored the potential in the link" in explorer.notice._pane.object)
        assert (explorer.state.case, explorer.state.energy, explorer.state.resolution) == ("I", 0.19, 224)
        assert "Reviewing" not in explorer.progress.text.object

    with_page({}, check)
