"""Datasets of results: indexed by different values, with units, and written as NetCDF and read back unchanged."""

from __future__ import annotations

import functools
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import (
    CASES,
    MapSpec,
    Plane,
    Result,
    classify_orbits,
    compute_basin_entropy,
    compute_map,
    compute_separation,
    compute_statistics,
    compute_wada_test,
    find_divergent_start,
    find_lyapunov_orbits,
    find_stable_manifolds,
    fit_decay_laws,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    review_potential,
    sample_starts,
)
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits

POTENTIAL, STATE = CASES["I"], (0.1, 0.0, 0.05, 0.6)


@functools.cache
def orbit() -> Result:
    return integrate_orbit(POTENTIAL, STATE, t_max=10.0)


RESULTS: dict[str, Callable[[], Result | None]] = {
    "potential": lambda: POTENTIAL,
    "review": lambda: review_potential(POTENTIAL),
    "review of a degenerate potential": lambda: review_potential(parse_formula("x⁴ + y⁴")),
    "review of a curve of critical points": lambda: review_potential(parse_formula("(x² + y² − 1)²")),
    "orbit": orbit,
    "verdict": lambda: judge_orbit(integrate_orbit(POTENTIAL, STATE, t_max=10.0)),
    "outcomes": lambda: classify_orbits(POTENTIAL, 0.2, sample_starts(POTENTIAL, 0.2, 50), t_max=20.0),
    "Lyapunov orbit": lambda: find_lyapunov_orbits(POTENTIAL, 0.2)[0],
    "manifolds": lambda: find_stable_manifolds(POTENTIAL, 0.19, images=1),
    "separation": lambda: compute_separation(POTENTIAL, STATE, (0.1, 0.0, 0.05, 0.60001), 10.0),
    "digits": lambda: compute_birkhoff_digits(POTENTIAL, (0.1, 0.0, 0.05, 0.3), 2e3),
    "divergent start": lambda: find_divergent_start(POTENTIAL, Plane.X_PX, 0.2, 0.1, 0.0, 50.0),
    "statistics": lambda: compute_statistics(compute_map(SPEC)),
    "decay laws": lambda: fit_decay_laws(compute_statistics(compute_map(SPEC))),
    "entropy": lambda: compute_basin_entropy(compute_map(SPEC)),
    "Wada test": lambda: compute_wada_test(compute_map(SPEC)),
}
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.5, (20, 20), t_max=50.0)


@functools.cache
def dataset(name: str) -> xr.Dataset:
    result = RESULTS[name]()
    assert result is not None
    return result.to_xarray()


@pytest.mark.parametrize("name", RESULTS)
def test_datasets_have_unique_indexes_and_meanings_and_are_kept_by_netcdf(name: str, tmp_path: Path) -> None:
    expected = dataset(name)
    assert all(index.is_unique for index in expected.indexes.values())
    assert [str(key) for key, one in expected.variables.items() if one.dtype.kind in "iuf" and not one.attrs] == []
    expected.to_netcdf(tmp_path / "result.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as found:
        xr.testing.assert_equal(found.load(), expected)
        assert found.attrs.keys() == expected.attrs.keys()


def test_path_of_a_lyapunov_orbit_has_its_times() -> None:
    exit_orbit = find_lyapunov_orbits(POTENTIAL, 0.2)[1]
    path = exit_orbit.to_xarray()
    # It starts on an exit, where rounding decides whether an integrated orbit is outside; its speed follows from the energy.
    velocity = [np.gradient(path[name], path["t"], edge_order=2) for name in ("x", "y")]
    expected = np.sqrt(2.0 * np.maximum(0.2 - POTENTIAL.value(path["x"], path["y"]), 0.0))
    np.testing.assert_allclose(np.hypot(*velocity), expected, atol=1e-3)
    assert float(path["t"][-1]) == exit_orbit.period


def test_codes_say_what_they_mean() -> None:
    assert dataset("outcomes")["fate"].attrs["codes"].startswith("0: bounded; -1: forbidden")
    assert dataset("outcomes").sizes == {"orbit": 50}
