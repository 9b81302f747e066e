"""Commands ``lyapunov``, ``measures`` and ``curves`` print and write the results of the engine."""

from __future__ import annotations

import csv
import json
import math
import re
from pathlib import Path

import numpy as np
import xarray as xr

from engine import (
    CASES,
    MEASURES,
    MapSpec,
    Plane,
    SweepSpec,
    compute_basin_entropy,
    compute_chaotic_share,
    compute_flux,
    compute_islands,
    compute_map,
    compute_regularity,
    compute_statistics,
    compute_sweep,
    compute_uncertainty_exponent,
    compute_wada_test,
    find_lyapunov_orbits,
    fit_decay_laws,
)
from engine.measures.basins.starts import exit_labels
from engine.measures.table import curve_names
from tests.cli.conftest import Run

MAP = ("II", "--energy", 0.2, "--resolution", 25, "--t-max", 100)
SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.2, (25, 25), t_max=100.0)
SWEEP = ("I", "--low", 0.12, "--high", 0.2, "--count", 3, "--resolution", 15, "--t-max", 50, "--no-exponent")
SWEEP_SPEC = SweepSpec(CASES["I"], Plane.X_PX, np.linspace(0.12, 0.2, 3), (15, 15), t_max=50.0, measures=curve_names(slow=False))


def test_lyapunov_json_and_csv_equal_the_engine_result(run: Run, tmp_path: Path) -> None:
    _, out, _ = run("lyapunov", "III", "--energy", 0.3, "--json", "--output", tmp_path / "paths.csv")
    wanted = find_lyapunov_orbits(CASES["III"], 0.3)
    assert json.loads(out)["decay_rate"] == compute_flux(CASES["III"], 0.3).decay_rate
    found = json.loads(out)["orbits"]
    assert [(one["channel"], one["period"]) for one in found] == [(orbit.channel, orbit.period) for orbit in wanted]
    with (tmp_path / "paths.csv").open() as file:
        rows = list(csv.DictReader(file))
    for name in ("x", "y"):
        assert [float(row[name]) for row in rows] == np.concatenate([getattr(orbit, name) for orbit in wanted]).tolist()
    assert [int(row["channel"]) for row in rows] == [orbit.channel for orbit in wanted for _ in orbit.x]
    times = np.concatenate([np.linspace(0.0, orbit.period, orbit.x.size) for orbit in wanted])
    np.testing.assert_allclose([float(row["t"]) for row in rows], times, rtol=1e-14)


def test_lyapunov_table_lists_all_orbits_and_says_when_there_are_none(run: Run) -> None:
    _, table, _ = run("lyapunov", "II", "--energy", 0.2)
    assert table.count(f"{find_lyapunov_orbits(CASES['II'], 0.2)[0].period:.11g}") == 3
    code, out, _ = run("lyapunov", "I", "--energy", 0.1)
    assert code == 0
    assert out == "No Lyapunov orbits: h = 0.1 is not above the escape energy 0.125.\n"


def test_measures_prints_the_descriptions_of_the_engine(run: Run) -> None:
    _, out, _ = run("measures", *MAP)
    frame = compute_map(SPEC)
    described = [
        compute_islands(frame).describe(),
        compute_basin_entropy(*exit_labels(frame.fate, bounded=True)).describe(),
        compute_wada_test(*exit_labels(frame.fate, bounded=False)).describe(),
        fit_decay_laws(compute_statistics(frame), 100.0).describe(),
        compute_flux(CASES["II"], 0.2).describe(),
        compute_uncertainty_exponent(SPEC, rng=0).describe(),
        compute_chaotic_share(compute_regularity(frame).character).describe(),
    ]
    assert [line for line in out.splitlines() if line in described] == described
    assert len(out.splitlines()) == sum(measure.sentence is not None for measure in MEASURES.values())


def test_measures_json_equals_the_engine_result(run: Run) -> None:
    _, out, _ = run("measures", *MAP, "--no-exponent", "--json")
    result, frame = json.loads(out), compute_map(SPEC)
    assert result["basin_entropy"]["s_b"] == compute_basin_entropy(*exit_labels(frame.fate, bounded=True)).s_b
    assert result["wada"]["radius"] == compute_wada_test(*exit_labels(frame.fate, bounded=False)).radius
    laws = fit_decay_laws(compute_statistics(frame), 100.0)
    assert laws.exponential is not None
    assert result["decay_rate"]["exponential"]["rate"] == laws.exponential.rate
    power_law = result["decay_rate"]["power_law"]
    assert (power_law and power_law["rate"]) == (laws.power_law and laws.power_law.rate)
    assert not {"uncertainty_exponent", "chaotic_share"} & result.keys()


def test_measures_are_chosen_by_name(run: Run) -> None:
    _, out, _ = run("measures", *MAP, "--measure", "wada", "--measure", "basin_entropy", "--json")
    assert list(json.loads(out)) == ["request", "basin_entropy", "wada"]
    code, _, err = run("measures", *MAP, "--measure", "size")
    assert code != 0
    assert re.search("measure=size: must be one of .*basin_entropy, wada", err)


def test_table_of_curves_is_printed_whole(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("curves", "III", *SWEEP[1:], "--output", tmp_path / "curves.csv")
    head, _, *rows = out.splitlines()
    columns = re.split(r" {2,}", head.strip())
    assert code == 0
    assert "…" not in out
    assert {"h", "share bounded", "share exit 4", "mean escape time", "s bb", "decay rate"} <= set(columns)
    assert [len(re.split(r" {2,}", row.strip())) for row in rows[:3]] == [len(columns)] * 3


def test_curves_equal_the_engine_result_as_netcdf_csv_and_json(run: Run, tmp_path: Path) -> None:
    code, out, err = run("curves", *SWEEP, "--json", "--output", tmp_path / "curves")
    assert (code, err) == (0, "")
    curves = compute_sweep(SWEEP_SPEC)
    with xr.open_dataset(tmp_path / "curves.nc", engine="h5netcdf") as found:
        xr.testing.assert_equal(found.load(), curves.dataset)
    with (tmp_path / "curves.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for name, wanted in (("h", curves.values), ("share_exit_2", curves["share"][:, 2]), ("s_b", curves["s_b"])):
        assert [float(row[name]) for row in rows] == wanted.tolist()
    lowest = json.loads(out)["points"][0]
    assert math.isnan(curves["mean_escape_time"][0])
    assert lowest["mean_escape_time"] is None
    assert lowest["share_bounded"] == 1.0
