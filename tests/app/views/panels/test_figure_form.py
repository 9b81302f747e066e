"""Figures show the state at the click, are made without blocking the event loop, and faults are told in a sentence."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import replace
from typing import Any

import pytest

from app.browser.components.file_components import FileSaver
from app.job_clients.orbit_requests import StartOrbit
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.panels.figure_form import ALL_MAPS, FigureForm, figure_choices
from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    SweepSpec,
    System,
    compute_map,
    compute_regularity,
    compute_sweep,
    integrate_orbit,
)
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.printed.figure_style import FigureFormat, FigureStyle
from tests.app.browser_messages import send
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e2))


@pytest.fixture(scope="module")
def shown(escape_map: EscapeMap) -> ShownResults:
    """Return results of every kind that can be drawn."""
    curves = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.3), (12, 12), t_max=100.0, measures="shares"))
    orbit = compute_orbit_curves(CASES["I"], integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), 50.0))
    analyses = {"judge": compute_regularity(escape_map)}
    return ShownResults(
        frame=escape_map, analyses=analyses, orbits=(StartOrbit((0.1, 0.05), orbit),), studies={"energies": curves}
    )


class KeptFiles(FileSaver):
    """Keeps the names of files instead of sending them to the browser."""

    def __init__(self) -> None:
        super().__init__()
        self.names: list[str] = []

    def save(self, name: str, content: bytes) -> None:
        self.names.append(name)


@pytest.fixture
def saved() -> KeptFiles:
    return KeptFiles()


@pytest.fixture
def results(shown: ShownResults) -> ShownResults:
    """Return a copy of the results, for a test that changes them."""
    return ShownResults(frame=shown.frame, analyses=shown.analyses, orbits=shown.orbits, studies=shown.studies)


@pytest.fixture
def form(results: ShownResults, saved: KeptFiles) -> FigureForm:
    state = ViewState(system=System("I"), energy=0.19)
    return FigureForm(state, results, saved, lambda ending: f"escapes{ending}", lambda copied: None)


def test_figures_are_offered_for_the_shown_results(shown: ShownResults) -> None:
    state = ViewState(system=System("I"), energy=0.19)
    assert list(figure_choices(ShownResults(), state)) == []
    maps = [ALL_MAPS, "Basins of escape", "Escape time", "Crossings of the section"]
    assert list(figure_choices(ShownResults(frame=shown.frame), state)) == [*maps, "The well in (x, y)", "Statistics"]
    others = ["Regular or chaotic", "The well in (x, y)", "Orbits", "Statistics", "Curves against energy"]
    assert list(figure_choices(shown, state)) == [*maps, *others]


@pytest.mark.parametrize("title", ["The well in (x, y)", "Orbits", "Statistics", "Curves against energy", "Regular or chaotic"])
def test_each_figure_can_be_made(title: str, shown: ShownResults) -> None:
    make = figure_choices(shown, ViewState(system=System("I"), energy=0.19))[title]
    assert make(FigureFormat.PNG, FigureStyle(8.5, 60.0)).startswith(b"\x89PNG")


def test_the_event_loop_runs_while_a_figure_is_made(form: FigureForm) -> None:
    loop_has_run = threading.Event()

    def make() -> bytes:
        assert loop_has_run.wait(SECONDS), "the event loop was blocked"
        return b"figure"

    async def save() -> None:
        asyncio.get_running_loop().call_later(0.0, loop_has_run.set)
        await form.make(make, sent.append)

    sent: list[bytes | None] = []
    run_on_new_loop(save)
    assert sent == [b"figure"]


def test_a_choice_stays_while_the_next_map_is_computed(form: FigureForm, results: ShownResults, shown: ShownResults) -> None:
    form.what.value = "Regular or chaotic"
    results.param.update(frame=None, orbits=(), studies={})
    assert (form.what.options, form.what.value) == ([ALL_MAPS, "Regular or chaotic"], "Regular or chaotic")
    results.param.update(frame=shown.frame, orbits=shown.orbits, studies=shown.studies)
    assert {"Basins of escape", "Regular or chaotic"} < set(form.what.options)
    assert "Origin and exit" not in form.what.options


def test_a_figure_of_an_incomplete_map_is_refused_with_the_reason(
    form: FigureForm, results: ShownResults, shown: ShownResults, saved: KeptFiles
) -> None:
    results.frame = replace(shown.frame, complete=False)
    assert (form.save.disabled, form.copy.disabled) == (True, True)
    assert form.text.object == "All maps: this is not computed yet."
    form.save.clicks += 1
    assert send(form.copy, {"wanted": True}) == [{"image": None}]
    assert saved.names == []
    form.what.value = "Orbits"
    assert (form.save.disabled, form.copy.disabled, form.text.object) == (False, False, "")


@pytest.mark.parametrize(("name", "number"), [("width", 1.0), ("dpi", 5000.0), ("font_size", 0.0)])
def test_an_illegal_number_is_named_and_nothing_is_saved_or_copied(
    name: str, number: float, form: FigureForm, saved: KeptFiles
) -> None:
    form.set_number(name, number)
    form.save.clicks += 1
    assert form.text.object.startswith(f"{name}={number!r}: must be from ")
    assert send(form.copy, {"wanted": True}) == [{"image": None}]
    assert saved.names == []


def test_too_many_pixels_are_named(form: FigureForm, shown: ShownResults) -> None:
    make = figure_choices(shown, ViewState(system=System("I"), energy=0.19))[ALL_MAPS]
    style = FigureStyle(100.0, 1200.0)

    def draw() -> Any:
        return make(FigureFormat.PNG, style)

    sent: list[bytes | None] = []
    run_on_new_loop(lambda: form.make(draw, sent.append))
    assert form.text.object.startswith("dpi=1200: must be at most ")
    assert sent == [None]


def test_figures_have_the_most_pixels_of_the_map_unless_layers_have_fewer(results: ShownResults) -> None:
    sharper = compute_map(replace(results.frame.spec, resolution=(30, 30)))
    results.param.update(analyses={}, sharper_map=sharper)
    assert results.drawn_map is sharper
    results.analyses = {"judge": compute_regularity(results.frame)}
    assert results.drawn_map is results.frame
    results.param.update(analyses={}, frame=replace(results.frame, complete=False), sharper_map=None)
    assert results.drawn_map is None
