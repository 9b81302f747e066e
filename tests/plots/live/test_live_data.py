"""The data of a live figure give the browser the orbits of the map, also backward in time."""

from __future__ import annotations

import base64
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Coordinate, Fate, MapSpec, Plane, Slice, Trust, compute_map, compute_trust
from engine.foundations.execution import DEFAULT_EXECUTION
from plots.live.live_data import figure_data
from plots.live.live_view import LiveView
from tests.node import needs_node, run_node

SIDE = 24
ROTATING = CASES["I"].in_rotating_frame(0.2)

BACKWARD = {
    "well": MapSpec(CASES["II"], Plane.X_PX, 0.22, (SIDE, SIDE), t_max=20.0, backward=True),
    "section with a sign": MapSpec(CASES["I"], Plane.X_PX, 0.2, (SIDE, SIDE), t_max=20.0, backward=True, section="x = 0, px < 0"),
    "rotating frame": MapSpec(ROTATING, Plane.X_PX, 0.2, (SIDE, SIDE), t_max=20.0, backward=True),
    "rotating frame, tangential": MapSpec(ROTATING, Plane.TANGENTIAL, 0.2, (SIDE, SIDE), t_max=20.0, backward=True),
    "rotating frame, angle of the velocity": MapSpec(
        ROTATING,
        Slice(Coordinate.X, Coordinate.THETA, fixed=((Coordinate.Y, 0.05),)),
        0.2,
        (SIDE, SIDE),
        t_max=20.0,
        backward=True,
    ),
    "rotating frame, a fixed momentum": MapSpec(
        ROTATING, Slice(Coordinate.X, Coordinate.Y, fixed=((Coordinate.PX, 0.1),)), 0.2, (SIDE, SIDE), t_max=20.0, backward=True
    ),
    "bodies": MapSpec(
        POTENTIALS["Copenhagen"], Plane.X_PX, -1.6, (SIDE, SIDE), (-2.0, 2.0, -2.0, 2.0), t_max=10.0, backward=True
    ),
}


def test_a_reader_can_choose_only_energies_at_which_the_exits_are_tabulated() -> None:
    spec = MapSpec(POTENTIALS["Separable"], Plane.X_PX, 0.1, (4, 4), t_max=10.0)
    data = figure_data(LiveView(spec), compute_map(spec), DEFAULT_EXECUTION)
    unit = data["system"]["units"]["energy"]
    assert data["energy"] < data["high"] < LiveView(spec).find_energies()[1]
    assert data["high"] == min(table["highest"] * unit for table in data["system"]["exits"])


def test_exits_are_tabulated_up_to_the_energy_of_the_map_where_a_longer_table_ends_below_it() -> None:
    spec = MapSpec(POTENTIALS["Separable"], Plane.X_PX, 0.16, (4, 4), t_max=10.0)
    data = figure_data(LiveView(spec), compute_map(spec), DEFAULT_EXECUTION)
    longer = figure_data(LiveView(replace(spec, energy=0.1)), compute_map(spec), DEFAULT_EXECUTION)
    assert longer["high"] < spec.energy == data["high"]
    unit = data["system"]["units"]["energy"]
    assert [table["highest"] * unit for table in data["system"]["exits"]] == [spec.energy] * 2


def test_exits_are_tabulated_up_to_the_highest_energy_of_a_window_on_a_slice_with_an_axis_of_energy() -> None:
    spec = MapSpec(CASES["III"], Plane.X_H, (0.3, 0.6), (4, 4), (-0.5, 0.5, 0.4, 1.3), t_max=10.0)
    data = figure_data(LiveView(spec), compute_map(spec), DEFAULT_EXECUTION)
    assert min(table["highest"] for table in data["system"]["exits"]) * data["system"]["units"]["energy"] == 1.3


@needs_node
@pytest.mark.parametrize("spec", [pytest.param(spec, id=name) for name, spec in BACKWARD.items()])
def test_pixels_backward_in_time_are_those_of_the_map(spec: MapSpec, tmp_path: Path) -> None:
    found = compute_map(spec)
    data = figure_data(LiveView(spec), found, DEFAULT_EXECUTION)
    shape = {"columns": SIDE, "rows": SIDE, "horizon": spec.t_max / spec.potential.units.time}
    view = {"slice": data["slice"], "energy": data["energy"], "window": data["window"], **shape}
    (pixels,) = run_node(
        "run_view.js", {"system": data["system"], "module": base64.b64decode(data["module"]), "views": [view]}, tmp_path
    )
    robust = np.isin(compute_trust(found).trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED)).ravel()
    escaped = robust & (found.fate > 0).ravel()
    assert escaped.sum() > 40
    expected = np.where(found.fate == Fate.BOUNDED, Fate.NOT_COMPUTED, found.fate).ravel()
    np.testing.assert_array_equal(np.array(pixels["fate"])[robust], expected[robust])
    np.testing.assert_array_equal(np.array(pixels["crossings"])[escaped], found.crossings.ravel()[escaped])
    np.testing.assert_allclose(np.array(pixels["time"], float)[escaped], found.escape_time.ravel()[escaped], rtol=0.01)
