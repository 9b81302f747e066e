"""Command ``ensemble``: shares, entering orbits, movies and tables are those of the engine."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image

from engine import (
    CASES,
    classify_orbits,
    compute_exit_matching,
    compute_flux,
    sample_entrances,
    sample_entrances_by_exit,
    sample_starts,
)
from tests.cli.conftest import Run

ENSEMBLE = ("ensemble", "III", "--energy", 0.45, "--count", 200, "--t-max", 20)


def test_printed_shares_are_those_of_the_engine(run: Run) -> None:
    code, out, _ = run(*ENSEMBLE, "--seed", 3, "--json")
    outcomes = classify_orbits(CASES["III"], 0.45, sample_starts(CASES["III"], 0.45, 200, rng=3), 20.0)
    answer = json.loads(out)
    shares = {row["outcome"]: row["share"] for row in answer["outcomes"]}
    assert code == 0
    assert shares["exit 2"] == pytest.approx((outcomes.fate == 2).mean())
    assert all(row["interval"][0] <= row["share"] <= row["interval"][1] for row in answer["outcomes"])
    assert answer["flux"]["decay_rate"] == compute_flux(CASES["III"], 0.45).decay_rate


def test_orbits_can_enter_through_the_exits(run: Run, tmp_path: Path) -> None:
    assert run(*ENSEMBLE, "--entering", "--output", tmp_path / "gaps.csv")[0] == 0
    table = np.genfromtxt(tmp_path / "gaps.csv", delimiter=",", names=True)
    entrances = sample_entrances(CASES["III"], 0.45, 200, rng=0)
    np.testing.assert_array_equal(np.column_stack([table[name] for name in ("x", "y", "px", "py")]), entrances)
    np.testing.assert_array_equal(table["escape_time"], classify_orbits(CASES["III"], 0.45, entrances, 20.0).escape_time)


def test_entering_orbits_are_counted_by_entrance_and_exit(run: Run) -> None:
    _, out, _ = run(*ENSEMBLE, "--entering", "--json")
    entrances, starts = sample_entrances_by_exit(CASES["III"], 0.45, 200, rng=0)
    matching = compute_exit_matching(entrances, classify_orbits(CASES["III"], 0.45, starts, 20.0))
    found = json.loads(out)["matching"]
    assert [(row["entrance"], row["exit"], row["count"]) for row in found] == [
        (entrance, end, int(matching.counts[i, k]))
        for i, entrance in enumerate(matching.entrances.tolist())
        for k, end in enumerate(matching.ends.tolist())
    ]
    _, table, _ = run(*ENSEMBLE, "--entering")
    assert table.count("entered through") == 1
    assert matching.describe() in table


def test_a_stem_gets_a_film_and_a_table(run: Run, tmp_path: Path) -> None:
    options = ("--frames", 4, "--width", 8, "--dpi", 60, "--output", tmp_path / "draining")
    assert run(*ENSEMBLE, *options)[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["draining.csv", "draining.webp"]
    with Image.open(tmp_path / "draining.webp") as film:
        assert film.n_frames == 4


def test_paths_are_written_as_netcdf(run: Run, tmp_path: Path) -> None:
    box = ("--plane", "x_px", "--window", 0.0, 0.1, 0.0, 0.1)
    assert run(*ENSEMBLE, *box, "--frames", 3, "--output", tmp_path / "box.nc")[0] == 0
    with xr.open_dataset(tmp_path / "box.nc", engine="h5netcdf") as paths:
        assert dict(paths.sizes) == {"orbit": 200, "t": 3}
        assert float(paths["x"][:, 0].min()) >= 0.0
        assert float(paths["x"][:, 0].max()) <= 0.1
        assert paths["t"].values.tolist() == [0.0, 10.0, 20.0]
