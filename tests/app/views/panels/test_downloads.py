"""Files are made of what was there when they were asked for, and nobody else waits for them."""

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
from app.rendering.orbit_curves import compute_orbit_curves
from app.state.view_state import ViewState
from app.views.panels import downloads
from app.views.panels.downloads import Downloads
from engine import CASES, EscapeMap, MapSpec, Plane, compute_map, integrate_orbit
from tests.app.other_loop import run_elsewhere

STATE = (0.1, 0.0, 0.05, 0.6)


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (15, 15), t_max=1e2))


@pytest.fixture
def along(escape_map: EscapeMap) -> Downloads:
    """With a whole map, and one orbit."""
    shown = Downloads(ViewState(case="I", energy=0.19), lambda: None)
    shown.show_map(escape_map)
    orbit = integrate_orbit(CASES["I"], STATE, 50.0)
    shown.show_orbits([ChosenOrbit((0.1, 0.05), compute_orbit_curves(CASES["I"], orbit))])
    return shown


@pytest.mark.parametrize(
    ("maker", "button", "begins"),
    [("png_bytes", "picture", b"\x89PNG"), ("netcdf_bytes", "maps", b"\x89HDF"), ("orbits_csv", "orbits", b"# escape-explorer")],
)
def test_the_loop_goes_on_while_a_file_is_made(
    along: Downloads, maker: str, button: str, begins: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    others_answered = threading.Event()
    make: Callable[..., Any] = getattr(downloads, maker)

    def make_after_the_others(*arguments: Any, **named: Any) -> Any:
        assert others_answered.wait(30), "everybody waited for the file"
        return make(*arguments, **named)

    async def press() -> BytesIO:
        asyncio.get_running_loop().call_later(0.05, others_answered.set)
        return await getattr(along, button).callback()

    monkeypatch.setattr(downloads, maker, make_after_the_others)
    assert run_elsewhere(press).getvalue().startswith(begins)


def test_a_file_is_of_the_map_that_was_there_when_it_was_asked_for(
    along: Downloads, escape_map: EscapeMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    make = downloads.netcdf_bytes

    def make_late(*arguments: Any) -> bytes:
        along.show_map(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (3, 3), t_max=10.0)))
        return make(*arguments)

    monkeypatch.setattr(downloads, "netcdf_bytes", make_late)
    file = run_elsewhere(along.maps.callback)
    assert along.maps.filename == "escapes-I-x_px-h0.19.nc"
    with xr.open_dataset(file, engine="h5netcdf") as dataset:
        np.testing.assert_array_equal(dataset["fate"], escape_map.fate)
