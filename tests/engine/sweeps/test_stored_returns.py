"""A store of returns equals the returns in memory, and an interrupted store is continued."""

from __future__ import annotations

import shutil
import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import CASES, Execution, MapSpec, ParameterAxis, Plane, Slice, System, compute_returns, open_result, store_returns
from engine.results import Returns
from engine.slices.axes import Coordinate

SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.15, (5, 7), t_max=60.0, section="y = 0.05 both")


def assert_equal(found: Returns, wanted: Returns) -> None:
    assert (found.spec, found.complete) == (wanted.spec, wanted.complete)
    np.testing.assert_array_equal(found.states, wanted.states)
    np.testing.assert_array_equal(found.time, wanted.time)


@pytest.mark.parametrize("spec", [SPEC, MapSpec(CASES["I"], Plane.X_H, (0.1, 0.3), (6, 5), t_max=40.0)])
def test_the_store_equals_the_returns_in_memory(spec: MapSpec, tmp_path: Path) -> None:
    stored = store_returns(spec, 4, tmp_path / "store")
    wanted = compute_returns(spec, 4)
    xr.testing.assert_equal(stored.transpose("return", ...).load(), wanted.to_xarray())
    assert_equal(open_result(tmp_path / "store", Returns), wanted)


def test_an_interrupted_store_has_its_first_rows_and_is_continued(tmp_path: Path) -> None:
    cancel = threading.Event()

    def stop_later(share: float) -> None:
        if share > 0.3:
            cancel.set()

    with pytest.raises(CancelledError):
        store_returns(SPEC, 4, tmp_path / "store", execution=Execution(cancel=cancel, on_progress=stop_later))
    wanted = compute_returns(SPEC, 4)
    part = open_result(tmp_path / "store", Returns)
    assert not part.complete
    rows = np.flatnonzero(np.isfinite(part.time).any(axis=(0, 2)))
    assert 0 < rows.size < 7
    np.testing.assert_array_equal(part.time[:, rows], wanted.time[:, rows])
    store_returns(SPEC, 4, tmp_path / "store")
    assert_equal(open_result(tmp_path / "store", Returns), wanted)


def test_a_damaged_row_is_computed_again(tmp_path: Path) -> None:
    store_returns(SPEC, 4, tmp_path / "store")
    shutil.rmtree(tmp_path / "store" / "return_x" / "c" / "3")
    store_returns(SPEC, 4, tmp_path / "store")
    assert_equal(open_result(tmp_path / "store", Returns), compute_returns(SPEC, 4))


def test_another_request_is_not_continued(tmp_path: Path) -> None:
    store_returns(SPEC, 2, tmp_path / "store")
    with pytest.raises(ValueError, match="holds another request, with returns=2; must have returns=3"):
        store_returns(SPEC, 3, tmp_path / "store")
    with pytest.raises(ValueError, match=r"holds another request, with section='y = 0.05 both'"):
        store_returns(replace(SPEC, section="y = 0"), 2, tmp_path / "store")  # type: ignore[arg-type]


def test_a_parameter_as_axis_is_refused(tmp_path: Path) -> None:
    plane = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 1.0, System("I")))
    with pytest.raises(ValueError, match="must be a slice of one potential"):
        store_returns(MapSpec(CASES["I"], plane, 0.2, (3, 3)), 1, tmp_path / "store")
