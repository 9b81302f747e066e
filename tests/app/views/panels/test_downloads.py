"""Files contain the state at the click, and are made without blocking the event loop."""

from __future__ import annotations

import asyncio
import threading
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
import xarray as xr

from app.job_clients.orbit_requests import StartOrbit
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.panels.downloads import CROSSINGS, LIVE, MAPS, ORBITS, SCRIPT, Downloads, file_choices
from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    SweepSpec,
    System,
    compute_map,
    compute_returns,
    compute_sweep,
    integrate_orbit,
)
from engine.jobs.job import Job
from plots.pictures.orbit_curves import compute_orbit_curves
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS

STATE = (0.1, 0.0, 0.05, 0.6)


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e2))


@pytest.fixture
def results(escape_map: EscapeMap) -> ShownResults:
    orbit = integrate_orbit(CASES["I"], STATE, 50.0)
    return ShownResults(frame=escape_map, orbits=(StartOrbit((0.1, 0.05), compute_orbit_curves(CASES["I"], orbit)),))


@pytest.fixture
def downloads_view(results: ShownResults) -> Downloads:
    """Return the view of downloads, with a complete map and one orbit."""
    state = ViewState(system=System("I"), energy=0.19)
    return Downloads(state, results, lambda: None, lambda: None, lambda copied: None, may_embed=True)


@pytest.mark.parametrize("may_embed", [False, True])
def test_code_that_embeds_the_page_is_offered_where_pages_may_embed_it(may_embed: bool) -> None:
    offered = Downloads(ViewState(), ShownResults(), lambda: None, lambda: None, lambda copied: None, may_embed=may_embed)
    assert offered.embed.disabled == (not may_embed)


def test_the_event_loop_runs_while_a_file_is_made(downloads_view: Downloads) -> None:
    loop_has_run = threading.Event()

    def make() -> bytes:
        assert loop_has_run.wait(SECONDS), "the event loop was blocked"
        return b"file"

    async def save() -> None:
        asyncio.get_running_loop().call_later(0.0, loop_has_run.set)
        await downloads_view.save(("name", make))

    run_on_new_loop(save)


def test_the_last_map_can_be_saved_while_that_of_another_system_is_computed(results: ShownResults) -> None:
    state = ViewState(system=System("III"), energy=0.45)
    assert state.energies.low > 0.19
    offered = Downloads(state, results, lambda: None, lambda: None, lambda copied: None, may_embed=True)
    assert not offered.data[LIVE].disabled


def test_only_files_that_the_results_allow_can_be_saved(downloads_view: Downloads, results: ShownResults) -> None:
    def enabled() -> set[str]:
        return {label for label, save in downloads_view.data.items() if not save.disabled}

    assert enabled() == {LIVE, MAPS, ORBITS, CROSSINGS, SCRIPT}
    results.frame = replace(results.frame, complete=False)
    assert enabled() == {ORBITS, CROSSINGS}
    curves = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.3), (12, 12), t_max=10.0))
    results.param.update(orbits=(), studies={"energies": curves})
    assert enabled() == {"Curves against energy (CSV)"}


def test_the_script_contains_the_study_whose_tab_is_shown(results: ShownResults, escape_map: EscapeMap) -> None:
    results.calls = {"section": Job(compute_returns, (escape_map.spec,))}
    results.studies = {"section": compute_returns(escape_map.spec, returns=2)}
    scripts = []
    for analysis in ("section", "energies", "orbit"):
        _, make = file_choices(results, ViewState(system=System("I"), energy=0.19, analysis=analysis))[SCRIPT]
        scripts.append(make().decode())
        compile(scripts[-1], "script", "exec")
    assert ["study = compute_returns(" in script for script in scripts] == [True, False, False]


def test_a_live_figure_has_the_energies_and_orbits_of_the_view(results: ShownResults) -> None:
    state = ViewState(system=System("I"), energy=0.19)
    name, make = file_choices(results, state)[LIVE]
    page = make().decode()
    assert name == "escapes-I-x_px-h0.19-t100.html"
    assert f'"low":{state.energies.low},"high":{state.energies.high}' in page
    assert f'"starts":{[list(one.start) for one in results.orbits]}'.replace(" ", "") in page


def test_a_file_holds_what_is_shown_at_the_moment_of_the_click(results: ShownResults, escape_map: EscapeMap) -> None:
    choices = file_choices(results, ViewState(system=System("I"), energy=0.19))
    (name, make), (_, make_table) = choices[MAPS], choices[ORBITS]
    results.param.update(frame=compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (3, 3), t_max=10.0)), orbits=())
    assert name == "escapes-I-x_px-h0.19-t100.nc"
    with xr.open_dataset(BytesIO(make()), engine="h5netcdf") as dataset:
        np.testing.assert_array_equal(dataset["fate"], escape_map.fate)
    rows = [line for line in make_table().decode().splitlines() if not line.startswith("#")]
    assert {row.split(",")[0] for row in rows[1:]} == {"1"}
