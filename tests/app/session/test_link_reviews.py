"""The potential of a link, of a preset or of the browser's history is reviewed in another process."""

from __future__ import annotations

import asyncio
import inspect
import sys
from collections.abc import Callable, Coroutine, Iterable, Iterator
from contextlib import contextmanager, suppress
from typing import Any
from urllib.parse import urlencode

import pytest

from app.runtime.limited_process import LimitedProcesses
from app.runtime.process_state import ProcessState
from app.session.explorer import Explorer
from app.state.system_review import review_catalogue_entry
from engine import CASES, Plane, System, Window, parse_formula
from engine.expressions.calculus import derivative, substitute
from engine.integrator.jit.code_outlines import find_outline
from engine.integrator.source.recurrence import find_structure
from engine.systems.forms.polynomial_form import find_critical_points
from engine.systems.forms.stored_points import stored_points
from engine.systems.review.potential_review import review_system
from engine.systems.system import TYPED
from engine.systems.well import find_exit_lines, find_maxima_beside
from plots.texts.mathml import equations, potential_formula
from tests.app.browser_messages import send
from tests.app.other_loop import run_on_new_loop
from tests.app.session.opened_page import on_loop, opened_page, tell_ready, wait_for

CIRCULAR = {"case": TYPED, "V": "r^2/2 - r^4 + r^6 - r^8 + r^10 - 1.0183r^12"}
LEGAL = {"case": TYPED, "V": "½(x² + y²) − 0.83x²y²"}
WITH_FUNCTIONS = {"case": TYPED, "V": "½(x² + y²) − a x²y exp(−0.017 y²)"}
# Functions that compute slow quantities of a potential.
SLOW = [parse_formula, review_system, find_critical_points, find_exit_lines, find_maxima_beside]
# Functions that derive other formulas, texts, and structures and outlines of code from a formula, or read its points from the
# disk. Jobs call `find_outline` for their kernels, and `stored_points` for the extent of the region of motion.
DERIVING = [derivative, substitute, equations, potential_formula, find_structure, find_outline, stored_points]
STARTED, TOOL = sys.monitoring.events.PY_START, 4


@contextmanager
def watching(functions: Iterable[Callable[..., Any]], note: Callable[[str], object]) -> Iterator[None]:
    """Pass the name of each function to `note` when it is called in this process."""
    # At the start of a server, the cases have been reviewed.
    for case in CASES:
        review_catalogue_entry(case)
    codes = [inspect.unwrap(function).__code__ for function in functions]
    sys.monitoring.use_tool_id(TOOL, "slow functions")
    sys.monitoring.register_callback(TOOL, STARTED, lambda code, offset: note(code.co_name))
    for code in codes:
        sys.monitoring.set_local_events(TOOL, code, STARTED)
    try:
        yield
    finally:
        for code in codes:
            sys.monitoring.set_local_events(TOOL, code, sys.monitoring.events.NO_EVENTS)
        sys.monitoring.free_tool_id(TOOL)


@pytest.fixture
def called() -> Iterator[list[str]]:
    """Yield the names of the slow functions that are called in this process."""
    called: list[str] = []
    with watching(SLOW, called.append):
        yield called


@pytest.fixture
def called_on_loop() -> Iterator[list[str]]:
    """Yield the names of the slow and the deriving functions that are called on an event loop of this process."""
    called: list[str] = []

    def note(name: str) -> None:
        with suppress(RuntimeError):
            asyncio.get_running_loop()
            called.append(name)

    with watching([*SLOW, *DERIVING], note):
        yield called


def with_page(parameters: dict[str, str], check: Callable[[Explorer], Coroutine[Any, Any, None]]) -> None:
    """Open a page with a link on a new event loop, tell the server that the page is shown, and check the page."""

    async def run() -> None:
        async with opened_page(parameters) as (explorer, session):
            await tell_ready(session)
            await check(explorer)

    run_on_new_loop(run)


class StartedProcesses(LimitedProcesses):
    """Processes for formulas that only count their starts."""

    def __init__(self) -> None:
        super().__init__()
        self.starts = 0

    def start(self) -> None:
        self.starts += 1


@pytest.mark.parametrize(("link", "starts"), [(LEGAL, [1, 2, 2]), ({}, [0, 1, 1])])
def test_the_process_for_formulas_starts_with_the_page_of_a_formula_and_with_the_drawer_of_the_potential(
    start_state: Callable[..., ProcessState], link: dict[str, str], starts: list[int]
) -> None:
    processes = start_state().limited = StartedProcesses()

    async def run() -> None:
        async with opened_page(link) as (explorer, session):
            counts = [processes.starts]
            for _ in ("open", "close"):
                await on_loop(session, lambda: explorer.controls.other.param.trigger("clicks"))
                counts.append(processes.starts)
            assert counts == starts

    run_on_new_loop(run)


def said(explorer: Explorer) -> str:
    return str(explorer.notice.layout().object)


async def wait_until_said(explorer: Explorer, text: str) -> None:
    await wait_for(explorer.notice.layout(), "object", lambda html: text in html)


def test_a_circular_potential_in_a_link_is_refused_in_another_process(called: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        assert "Reviewing" in explorer.maps.progress.text.object
        await wait_until_said(explorer, "Ignored the potential in the link")
        assert "circular potential" in said(explorer)
        assert (explorer.state.system.case, explorer.state.t_max) == ("I", 1e3)

    with_page(CIRCULAR | {"t_max": "1e3", "h": "0.7"}, check)
    assert not called


def test_a_link_is_shown_whole_after_the_review_of_its_potential(called: list[str]) -> None:
    asked = {"plane": "x_y", "h": "0.4", "window": "-1,1,-0.5,0.5", "orbits": "0.1,0.2", "resolution": "112", "t_max": "100"}

    async def check(explorer: Explorer) -> None:
        state = explorer.state
        assert (state.system.case, state.resolution, state.starts) == ("I", 112, ())
        await wait_for(explorer.state, "system", lambda system: system.case == TYPED)
        assert (state.plane, state.energy, state.starts) == (Plane.X_Y, 0.4, ((0.1, 0.2),))
        assert state.window == Window(-1.0, 1.0, -0.5, 0.5)
        assert explorer.links.history.entry == 0

    with_page(LEGAL | asked, check)
    assert not called


def test_a_view_to_compare_with_that_is_refused_is_told_beside_other_problems() -> None:
    async def check(explorer: Explorer) -> None:
        await wait_until_said(explorer, "Ignored the view in the link")
        assert "Ignored palette=none" in said(explorer)
        assert "the formula ends" in said(explorer)
        assert explorer.state.compared is None

    with_page({"with_V": "x +", "with_h": "0.2", "palette": "none"}, check)


def test_entries_of_the_browsers_history_are_reviewed_in_another_process(called: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        explorer.links.navigate("?" + urlencode(CIRCULAR | {"h": "0.5", "resolution": "112"}), 0, 0)
        assert "Reviewing" in explorer.maps.progress.text.object
        await wait_until_said(explorer, "Ignored the potential in the link")
        assert (explorer.state.system.case, explorer.state.energy, explorer.state.resolution) == ("I", 0.19, 224)
        assert "Reviewing" not in explorer.maps.progress.text.object
        explorer.links.navigate("?" + urlencode(LEGAL | {"h": "0.5"}), 0, 0)
        await wait_for(explorer.state, "system", lambda system: system.case == TYPED)
        assert explorer.state.energy == 0.5

    with_page({}, check)
    assert not called


def test_the_known_review_of_a_refused_entry_is_not_awaited() -> None:
    async def check(explorer: Explorer) -> None:
        for _ in ("first visit", "second visit"):
            explorer.notice.clear()
            explorer.links.navigate("?" + urlencode({"case": TYPED, "V": "-x^2 - y^2"}), 0, 0)
            await wait_until_said(explorer, "Ignored the potential in the link")
            assert "Reviewing" not in explorer.maps.progress.text.object

    with_page({}, check)


def test_a_choice_made_during_a_review_is_kept() -> None:
    async def check(explorer: Explorer) -> None:
        explorer.controls.case.value = "III"
        # This entry of the history is reviewed after the link.
        explorer.links.navigate("?" + urlencode({"case": TYPED, "V": "x +"}), 0, 0)
        await wait_until_said(explorer, "Ignored the potential in the link")
        assert explorer.state.system == System("III")

    with_page(LEGAL, check)


def test_nothing_is_derived_from_a_formula_on_the_event_loop(called_on_loop: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        panel = explorer.potential.panel
        await wait_for(explorer.state, "system", lambda system: system.case == TYPED)
        for drawer in ("potential", "help"):
            explorer.drawers.show(drawer)
        refused, of_same_structure, final = "x² + y²", "½(x² + y²) − b x²y exp(−0.02 y²)", "x² + y² − x^4"
        for count, text in enumerate((refused, of_same_structure, final), 1):
            panel.message.object = ""
            send(panel.formula, {"value": text, "count": count, "done": text == final})
            await wait_for(panel.message, "object", lambda html: html and "Reviewing" not in html)
        await wait_for(explorer.state, "system", lambda system: system.formula == final)
        await wait_for(explorer.results, "frame", lambda frame: frame and frame.spec.potential == explorer.state.potential)

    with_page(WITH_FUNCTIONS | {"resolution": "112", "t_max": "100"}, check)
    assert not called_on_loop


def test_no_potential_along_a_parameter_is_derived_on_the_event_loop(called_on_loop: list[str]) -> None:
    async def check(explorer: Explorer) -> None:
        await wait_for(explorer.state, "system", lambda system: system.case == TYPED)
        with pytest.raises(ValueError, match="not known before the first map"):
            explorer.maps.add_middle()
        await wait_for(explorer.results, "orbits", lambda orbits: orbits and orbits[0].orbit)
        await wait_for(explorer.results, "frame", bool)
        explorer.maps.add_start(0.0, 1.03)
        await wait_for(explorer.results, "orbits", lambda orbits: len(orbits) == 2 and orbits[1].orbit)

    along = {"V": "½(x² + y²) − 0.83a x²y²", "plane": "x,a=0.9:1.1", "orbits": "0.1,1.05", "resolution": "112", "t_max": "100"}
    with_page(LEGAL | along, check)
    assert not called_on_loop
