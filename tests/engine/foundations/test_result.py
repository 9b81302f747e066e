"""Every result is a few lines of text, has read-only arrays even in copies, and has a dataset that NetCDF keeps unchanged."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from tests.results import ENERGY, POTENTIAL, RESULTS, result_of

# Results that consist of numbers only. Their text is that of dataclasses.
PLAIN = {"potential", "verdict", "divergent start", "entropy"}


def arrays_of(result: Any) -> Iterator[np.ndarray]:
    """Yield the arrays of a result and of the results that it contains, without the states of orbits in a map."""
    if isinstance(result, np.ndarray):
        yield result
    elif isinstance(result, tuple):
        for part in result:
            yield from arrays_of(part)
    elif is_dataclass(result) and not isinstance(result, type):
        for field in fields(result):
            if field.name != "batch":
                yield from arrays_of(getattr(result, field.name))


@pytest.mark.parametrize("name", [name for name in RESULTS if name not in PLAIN])
def test_a_result_takes_a_few_short_lines(name: str) -> None:
    result = result_of(name)
    lines = repr(result).splitlines()
    assert lines[0].startswith(type(result).__name__)
    assert len(lines) <= 7
    assert max(map(len, lines)) <= 100


@pytest.mark.parametrize("name", RESULTS)
def test_arrays_are_read_only_also_in_copies_as_between_processes(name: str) -> None:
    result = result_of(name)
    copies = pickle.loads(pickle.dumps(result)), copy.deepcopy(result)
    for each in copies:
        for original, copied in zip(arrays_of(result), arrays_of(each), strict=True):
            assert not original.flags.writeable
            assert not copied.flags.writeable
            np.testing.assert_array_equal(copied, original)


@pytest.mark.parametrize("name", RESULTS)
def test_datasets_have_unique_indexes_and_meanings_and_are_kept_by_netcdf(name: str, tmp_path: Path) -> None:
    expected = result_of(name).to_xarray()
    assert all(index.is_unique for index in expected.indexes.values())
    assert [str(key) for key, one in expected.variables.items() if one.dtype.kind in "iuf" and not one.attrs] == []
    expected.to_netcdf(tmp_path / "result.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as found:
        xr.testing.assert_equal(found.load(), expected)
        assert found.attrs.keys() == expected.attrs.keys()


def test_most_results_have_arrays() -> None:
    assert sum(any(True for _ in arrays_of(result_of(name))) for name in RESULTS) >= 13


def test_a_map_says_what_it_is_in_five_lines() -> None:
    text = repr(result_of("map"))
    assert len(text.splitlines()) <= 5
    for part in ("potential III", "plane (x, px)", "energy 0.36", "exit 3 0.", "bounded 0.", "fate escape_time", "30 × 40"):
        assert part in text


def test_the_path_of_a_lyapunov_orbit_has_its_times() -> None:
    exit_orbit: Any = result_of("Lyapunov orbit")
    path = exit_orbit.to_xarray()
    # The path starts on an exit, where rounding decides whether an orbit is outside. Its speed follows from the energy.
    velocity = [np.gradient(path[name], path["t"], edge_order=2) for name in ("x", "y")]
    expected = np.sqrt(2.0 * np.maximum(ENERGY - POTENTIAL.value(path["x"], path["y"]), 0.0))
    np.testing.assert_allclose(np.hypot(*velocity), expected, atol=2e-3)
    assert float(path["t"][-1]) == exit_orbit.period


def test_codes_have_their_meanings_in_the_attributes() -> None:
    outcomes = result_of("outcomes").to_xarray()
    assert outcomes["fate"].attrs["codes"].startswith("0: bounded; -1: forbidden")
    assert outcomes.sizes == {"orbit": 50}
