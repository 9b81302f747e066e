"""Files hold the state at the moment of the click, and are made without blocking the event loop."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from io import BytesIO
from typing import Any

import numpy as np
import pytest
import xarray as xr

from app.job_clients.orbit_requests import ChosenOrbit
from app.state.view_state import ViewState
from app.views.panels import downloads
from app.views.panels.downloads import Downloads
from engine import CASES, EscapeMap, MapSpec, Plane, compute_map, integrate_orbit
from plots.orbit_curves import compute_orbit_curves
from tests.app.other_loop import run_on_new_loop

STATE = (0.1, 0.0, 0.05, 0.6)


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e2))


@pytest.fixture
def downloads_view(escape_map: EscapeMap) -> Downloads:
    """With a complete map and one orbit."""
    shown = Downloads(ViewState(case="I", energy=0.19), lambda: None, lambda: None, lambda copied: None)
    shown.show_map(escape_map)
    orbit = integrate_orbit(CASES["I"], STATE, 50.0)
    shown.show_orbits([ChosenOrbit((0.1, 0.05), compute_orbit_curves(CASES["I"], orbit))])
    return shown


@pytest.mark.parametrize(
    ("maker", "file", "begins"),
    [("netcdf_bytes", "netcdf_file", b"\x89HDF"), ("orbits_csv", "csv_file", b"# escape")],
)
def test_the_event_loop_runs_while_a_file_is_made(
    downloads_view: Downloads, maker: str, file: str, begins: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    loop_has_run = threading.Event()
    make: Callable[..., Any] = getattr(downloads, maker)

    def make_after_the_loop_has_run(*arguments: Any, **named: Any) -> Any:
        assert loop_has_run.wait(30), "the event loop was blocked"
        return make(*arguments, **named)

    async def save() -> None:
        asyncio.get_running_loop().call_later(0.05, loop_has_run.set)
        await downloads_view.save(getattr(downloads_view, file)())

    monkeypatch.setattr(downloads, maker, make_after_the_loop_has_run)
    saved = record_saved(downloads_view, monkeypatch)
    run_on_new_loop(save)
    assert [content.startswith(begins) for _, content in saved] == [True]


def test_a_file_holds_the_map_at_the_moment_of_the_click(
    downloads_view: Downloads, escape_map: EscapeMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    saved = record_saved(downloads_view, monkeypatch)
    file = downloads_view.netcdf_file()
    downloads_view.show_map(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (3, 3), t_max=10.0)))
    run_on_new_loop(lambda: downloads_view.save(file))
    (name, content), *_ = saved
    assert name == "escapes-I-x_px-h0.19-t100.nc"
    with xr.open_dataset(BytesIO(content), engine="h5netcdf") as dataset:
        np.testing.assert_array_equal(dataset["fate"], escape_map.fate)


def record_saved(view: Downloads, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, bytes]]:
    """Files that are sent to the browser from now on."""
    saved: list[tuple[str, bytes]] = []
    monkeypatch.setattr(view.saver, "save", lambda name, content: saved.append((name, content)))
    return saved
