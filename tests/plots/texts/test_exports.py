"""Downloaded files contain the same numbers as the results."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import replace
from io import BytesIO
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot

from engine import (
    CASES,
    MapSpec,
    Orbit,
    ParameterAxis,
    Plane,
    Potential,
    Result,
    SweepSpec,
    System,
    compute_map,
    compute_returns,
    compute_sweep,
    integrate_orbit,
    judge_orbit,
    start_states,
)
from engine.jobs.job import Job
from engine.systems.system import TYPED
from plots.texts.exports import file_stem, netcdf_bytes, orbits_csv, python_lines, section_csv, table_csv

START = (0.1, 0.0, 0.05, 0.6)
SPECS = {
    "another section": MapSpec(CASES["II"], Plane.X_PX, 0.18, (9, 7), t_max=50.0, section="x = 0.1 both"),
    "a window": MapSpec(CASES["II"], Plane.X_PX, 0.18, (20, 15), window=(-1.0, 1.4, -0.8, 0.8), t_max=200.0),
    "the whole interior": MapSpec(CASES["II"], Plane.X_Y, 0.1 + 0.2, (11, 11), t_max=100.0),
    "energies": MapSpec(CASES["II"], Plane.X_H, (1 / 6, 0.4), (11, 11), t_max=100.0),
    "a deep zoom": MapSpec(
        CASES["II"], Plane.X_PX, 0.18, (7, 7), (0.1, 0.1 + 1e-10, 1 / 3, 1 / 3 + 1e-10), 100.0, use_evidence=False
    ),
    "NumPy's numbers, backward in time": MapSpec(
        CASES["II"],
        Plane.X_PX,
        np.float64(0.2),
        (np.int64(9), 9),
        tuple(np.linspace(-0.3, 0.3, 2)) * 2,
        np.float64(50.0),
        backward=True,
    ),
}

EPSILON = ParameterAxis("epsilon", 0.9, 1.1, System("II"))
ALONG_EPSILON = CASES["II"], Plane.X_PX, (0.95, 1.05)


def test_the_energy_of_an_orbit_has_no_rounding_error_of_its_start() -> None:
    [start] = start_states(CASES["II"], Plane.X_PX, 0.12, np.array([0.1]), np.array([0.15]))
    orbit = integrate_orbit(CASES["II"], start, t_max=10.0)
    assert repr(orbit.energy) != "0.12"
    assert "# orbit 1: energy 0.12\n" in section_csv([orbit])


@pytest.fixture(scope="module")
def orbit() -> Orbit:
    return integrate_orbit(CASES["I"], START, 100.0)


@pytest.mark.parametrize("name", ["a window", "energies"])
def test_netcdf_contains_the_map(name: str) -> None:
    dataset = compute_map(SPECS[name]).to_xarray()
    with xr.open_dataset(BytesIO(netcdf_bytes(compute_map(SPECS[name]))), engine="h5netcdf") as back:
        xr.testing.assert_equal(back, dataset)
        assert {name: variable.dtype for name, variable in back.items()} == {name: v.dtype for name, v in dataset.items()}
        assert set(back.attrs) == set(dataset.attrs)
        for key, value in dataset.attrs.items():
            np.testing.assert_array_equal(back.attrs[key], value)
        for key, variable in dataset.variables.items():
            assert back[key].attrs == variable.attrs


def test_without_h5netcdf_the_file_is_of_netcdf_3(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("plots.texts.exports.find_spec", lambda _name: None)
    frame = compute_map(SPECS["energies"])
    with xr.open_dataset(BytesIO(netcdf_bytes(frame)), engine="scipy") as back:
        xr.testing.assert_equal(back.load(), frame.to_xarray())


def table(text: str) -> tuple[list[str], list[dict[str, str]]]:
    lines = text.splitlines()
    comments = [line for line in lines if line.startswith("#")]
    return comments, list(csv.DictReader(lines[len(comments) :]))


def test_a_table_of_orbits_contains_them_bit_for_bit(orbit: Orbit) -> None:
    other = integrate_orbit(CASES["III"], (0.1, 0.0, 0.05, 0.9), 50.0)
    comments, rows = table(orbits_csv([orbit, other]))
    for number, one in enumerate((orbit, other), 1):
        own = [row for row in rows if row["orbit"] == str(number)]
        for column in ("t", "x", "y", "px", "py", "sali", "lyapunov_exponent", "r2"):
            np.testing.assert_array_equal([float(row[column]) for row in own], getattr(one, column))
        assert f"# orbit {number}: {judge_orbit(one).describe()}" in comments
        assert f"# orbit {number}: energy {one.energy:.15g}" in comments
    assert "# orbit 1: start x = 0.1, y = 0.0, px = 0.05, py = 0.6" in comments


def test_a_table_of_crossings_lists_them_with_their_times(orbit: Orbit) -> None:
    other = integrate_orbit(CASES["III"], (0.1, 0.0, 0.05, 0.9), 50.0, section="x = 0 both")
    comments, rows = table(section_csv([orbit, other]))
    assert [comments[k] for k in (3, 6)] == ["# orbit 1: upward crossings of y = 0", "# orbit 2: crossings of x = 0"]
    assert comments[5] == f"# orbit 2: energy {other.energy:.15g}"
    for number, one in enumerate((orbit, other), 1):
        own = [row for row in rows if row["orbit"] == str(number)]
        assert [int(row["crossing"]) for row in own] == list(range(1, one.crossings + 1))
        found = np.array([[float(row[name]) for name in ("t", "x", "y", "px", "py")] for row in own])
        np.testing.assert_array_equal(found[:, 0], one.find_section_states()[1])
        np.testing.assert_allclose(np.interp(found[:, 0], one.t, one.px), found[:, 3], atol=0.05)
        assert np.abs(found[:, 2 if number == 1 else 1]).max() < 1e-12


def test_a_long_orbit_is_thinned_evenly_with_a_note(orbit: Orbit) -> None:
    comments, rows = table(orbits_csv([orbit, orbit], most_rows=100))
    assert 50 < len(rows) <= 100
    times = np.array([float(row["t"]) for row in rows if row["orbit"] == "2"])
    assert times[0] == 0.0
    np.testing.assert_allclose(np.diff(times), times[1], rtol=1e-9)
    stride = int(np.flatnonzero(orbit.t == times[1])[0])
    assert f"# orbit 2: one in {stride} of {orbit.t.size} samples" in comments


def test_a_table_of_curves_has_a_row_for_each_energy() -> None:
    measures = ("shares", "basin_entropy")
    curves = compute_sweep(SweepSpec(CASES["I"], Plane.X_PX, (0.13, 0.2), (20, 20), t_max=100.0, measures=measures))
    comments, rows = table(table_csv(curves))
    assert "# t_max: 100.0" in comments
    assert [float(row["h"]) for row in rows] == [0.13, 0.2]
    np.testing.assert_array_equal([float(row["share_exit_2"]) for row in rows], curves["share"][:, 2])
    np.testing.assert_array_equal([float(row["s_b"]) for row in rows], curves["s_b"])


@pytest.mark.parametrize("name", ["energies", "a deep zoom", "NumPy's numbers, backward in time", "another section"])
def test_the_script_reproduces_and_draws_the_map_and_the_orbits(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    spec = SPECS[name]
    made: dict[str, Any] = {}
    drawn: list[int] = []
    pyplot.close("all")
    monkeypatch.setattr(pyplot, "show", lambda: drawn.extend(pyplot.get_fignums()))
    exec(python_lines(spec, System("II"), [START, (np.float64(1 / 3), 0.0, 0.0, 0.3)]), made)
    assert made["spec"] == replace(spec, window=spec.find_window())
    whole = compute_map(spec)
    for image in ("fate", "escape_time", "crossings", "x", "ordinate"):
        np.testing.assert_array_equal(getattr(made["escape_map"], image), getattr(whole, image))
    for one, start in zip(made["orbits"], (START, (1 / 3, 0.0, 0.0, 0.3)), strict=True):
        expected = integrate_orbit(CASES["II"], start, spec.t_max, section=spec.section)
        assert (one.fate, one.crossings) == (expected.fate, expected.crossings)
        np.testing.assert_array_equal(one.x, expected.x)
    # The script draws the map and two orbits.
    assert len(drawn) == 3
    pyplot.close("all")


@pytest.mark.parametrize(
    ("function", "request_of_study", "options"),
    [
        (compute_returns, SPECS["another section"], {"returns": 3}),
        (compute_sweep, SweepSpec(CASES["II"], Plane.X_PX, (0.18, 0.2), (9, 9), t_max=50.0, measures=("shares",)), {}),
        (compute_sweep, SweepSpec(*ALONG_EPSILON, (9, 9), t_max=50.0, measures=("shares",), along=EPSILON, energy=0.2), {}),
    ],
    ids=["section", "energies", "a parameter"],
)
def test_the_script_reproduces_the_study(
    function: Callable[..., Result], request_of_study: Any, options: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    made: dict[str, Any] = {}
    monkeypatch.setattr(pyplot, "show", lambda: None)
    study = Job(function, (request_of_study,), tuple(options.items()))
    exec(python_lines(SPECS["another section"], System("II"), study=study), made)
    expected = function(request_of_study, **options).columns()
    assert made["study"].columns().keys() == expected.keys()
    for name, values in made["study"].columns().items():
        np.testing.assert_array_equal(values, expected[name])
    pyplot.close("all")


def study_of_another_package(potential: Potential, energies: Sequence[float]) -> Result:
    raise NotImplementedError


def test_the_script_imports_the_study_of_another_package_from_there() -> None:
    study = Job(study_of_another_package, (CASES["II"], (0.18, 0.2)))
    lines = python_lines(SPECS["another section"], System("II"), study=study).splitlines()
    assert f"from {__name__} import study_of_another_package" in lines
    assert "study = study_of_another_package(potential, (0.18, 0.2))" in lines


@pytest.mark.parametrize(
    "system",
    [
        System("C5"),
        System("III", parameters={"omega_1": 1.1}),
        System(TYPED, "x²/2 + y²/2 − x²y", {"omega_2": 0.9}),
        System(TYPED, "x²/2 + y²/2 − αx²y", {"α": 0.7, "rotation": 0.1}),
    ],
)
def test_the_script_reproduces_the_potential(system: System) -> None:
    head = python_lines(SPECS["a window"], system).split("spec = ")[0]
    made: dict[str, Any] = {}
    exec(head, made)
    assert made["potential"] == system.potential
    assert made["potential"].system == system


@pytest.mark.parametrize(
    ("name", "stem"),
    [
        ("a window", "escapes-II-x_px-h0.18-t200--1.0_1.4--0.8_0.8"),
        ("the whole interior", "escapes-II-x_y-h0.30000000000000004-t100"),
        ("energies", "escapes-II-x_h-h0.16666666666666666-0.4-t100"),
        ("another section", "escapes-II-x_px-h0.18-t50-x___0.1_both"),
    ],
)
def test_files_are_named_after_case_plane_energy_duration_and_window(name: str, stem: str) -> None:
    assert file_stem(SPECS[name], "II") == stem
