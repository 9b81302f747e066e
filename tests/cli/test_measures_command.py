"""Commands ``lyapunov``, ``measures`` and ``curves``: results of the engine as tables, text and JSON."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import (
    CASES,
    MapSpec,
    Plane,
    SweepSpec,
    compute_basin_entropy,
    compute_flux,
    compute_map,
    compute_statistics,
    compute_sweep,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_lyapunov_orbits,
    fit_decay_laws,
)
from engine.measures.labels import exit_labels
from engine.sweeps.measures import QUICK_CURVES

Run = Callable[..., tuple[int, str, str]]

MAP = ("II", "--energy", 0.2, "--resolution", 25, "--t-max", 100)
SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.2, (25, 25), t_max=100.0)
SWEEP = ("I", "--low", 0.12, "--high", 0.2, "--count", 3, "--resolution", 15, "--t-max", 50, "--no-exponent")
SWEEP_SPEC = SweepSpec(CASES["I"], Plane.X_PX, np.linspace(0.12, 0.2, 3), (15, 15), t_max=50.0, measures=QUICK_CURVES)


def test_lyapunov_json_and_csv_equal_the_engine_result(run: Run, tmp_path: Path) -> None:
    _, out, _ = run("lyapunov", "III", "--energy", 0.3, "--json", "--output", tmp_path / "paths.csv")
    wanted = find_lyapunov_orbits(CASES["III"], 0.3)
    found = json.loads(out)["orbits"]
    assert [(one["channel"], one["period"]) for one in found] == [(orbit.channel, orbit.period) for orbit in wanted]
    with (tmp_path / "paths.csv").open() as file:
        rows = list(csv.DictReader(file))
    for name in ("x", "y"):
        assert [float(row[name]) for row in rows] == np.concatenate([getattr(orbit, name) for orbit in wanted]).tolist()
    assert [int(row["channel"]) for row in rows] == [orbit.channel for orbit in wanted for _ in orbit.x]
    times = np.concatenate([np.linspace(0.0, orbit.period, orbit.x.size) for orbit in wanted])
    np.testing.assert_allclose([float(row["t"]) for row in rows], times, rtol=1e-14)


def test_flux_stands_beside_the_lyapunov_orbits(run: Run) -> None:
    _, out, _ = run("lyapunov", "III", "--energy", 0.45, "--json")
    found, wanted = json.loads(out), compute_flux(CASES["III"], 0.45)
    assert [one["flux"] for one in found["orbits"]] == wanted.flux.tolist()
    assert found["decay_rate"] == wanted.decay_rate
    _, text, _ = run("lyapunov", "III", "--energy", 0.45)
    assert "decay rate 0.167" in text


def test_lyapunov_orbits_end_on_the_zero_velocity_curve(run: Run) -> None:
    _, out, _ = run("lyapunov", "II", "--energy", 0.2, "--json")
    ends = np.array([one["ends"] for one in json.loads(out)["orbits"]])
    np.testing.assert_allclose(CASES["II"].value(ends[..., 0], ends[..., 1]), 0.2, rtol=0, atol=1e-12)


def test_lyapunov_table_lists_all_orbits(run: Run) -> None:
    _, out, _ = run("lyapunov", "II", "--energy", 0.2)
    assert out.count(f"{find_lyapunov_orbits(CASES['II'], 0.2)[0].period:.11g}") == 3


def test_no_lyapunov_orbits_below_the_escape_energy(run: Run) -> None:
    code, out, _ = run("lyapunov", "I", "--energy", 0.1)
    assert code == 0
    assert out == "No Lyapunov orbits: h = 0.1 is not above the escape energy 0.125.\n"


def test_measures_prints_the_descriptions_of_the_engine(run: Run) -> None:
    _, out, _ = run("measures", *MAP)
    frame = compute_map(SPEC)
    assert out.splitlines() == [
        compute_basin_entropy(*exit_labels(frame.fate, bounded=True)).describe(),
        compute_wada_test(*exit_labels(frame.fate, bounded=False)).describe(),
        fit_decay_laws(compute_statistics(frame), 100.0).describe(),
        compute_uncertainty_exponent(SPEC).describe(),
    ]


def test_measures_json_equals_the_engine_result(run: Run) -> None:
    _, out, _ = run("measures", *MAP, "--no-exponent", "--json")
    result, frame = json.loads(out), compute_map(SPEC)
    assert result["basin_entropy"]["s_b"] == compute_basin_entropy(*exit_labels(frame.fate, bounded=True)).s_b
    assert result["merging"]["radius"] == compute_wada_test(*exit_labels(frame.fate, bounded=False)).radius
    laws = fit_decay_laws(compute_statistics(frame), 100.0)
    assert laws.exponential is not None
    assert result["escape_laws"]["exponential"]["rate"] == laws.exponential.rate
    assert "uncertainty_exponent" not in result


def test_curves_netcdf_equals_the_engine_result(run: Run, tmp_path: Path) -> None:
    assert run("curves", *SWEEP, "--output", tmp_path / "curves")[0] == 0
    with xr.open_dataset(tmp_path / "curves.nc", engine="h5netcdf") as found:
        xr.testing.assert_equal(found.load(), compute_sweep(SWEEP_SPEC).dataset)


def test_curves_csv_equals_the_engine_result(run: Run, tmp_path: Path) -> None:
    run("curves", *SWEEP, "--output", tmp_path / "curves")
    with (tmp_path / "curves.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    curves = compute_sweep(SWEEP_SPEC)
    for name, wanted in (("h", curves.values), ("share_channel_2", curves["share"][:, 2]), ("s_b", curves["s_b"])):
        assert [float(row[name]) for row in rows] == wanted.tolist()


def test_nan_is_null_in_json(run: Run, tmp_path: Path) -> None:
    _, out, _ = run("curves", *SWEEP, "--json", "--output", tmp_path / "curves")
    lowest = json.loads(out)["points"][0]
    assert math.isnan(compute_sweep(SWEEP_SPEC)["mean_escape_time"][0])
    assert lowest["mean_escape_time"] is None
    assert lowest["share_bounded"] == 1.0


@pytest.mark.parametrize("command", [("measures", *MAP), ("curves", *SWEEP)])
def test_no_progress_without_a_terminal(
    command: tuple[object, ...], run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(*command, "--json")[2] == ""


@pytest.mark.parametrize(("ending", "begins"), [("csv", b"# escape"), ("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_the_ending_of_the_file_name_is_the_format_of_the_curves(ending: str, begins: bytes, run: Run, tmp_path: Path) -> None:
    energies = ("--low", 0.2, "--high", 0.3, "--count", 2, "--resolution", 12, "--t-max", 100, "--no-exponent")
    path = tmp_path / f"curves.{ending}"
    assert run("curves", "I", *energies, "--width", 8.5, "--no-titles", "--output", path)[0] == 0
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes().startswith(begins)
