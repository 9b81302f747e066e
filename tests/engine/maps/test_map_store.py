"""A map with a store is the same as without, also after interruptions."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, compute_map, open_result
from engine.maps.result import PIXEL_ARRAYS

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.4, (520, 520), t_max=20.0)
"""A map of two blocks."""

SMALL = MapSpec(CASES["III"], Plane.X_PX, 0.4, (20, 21), t_max=20.0)


def test_a_cancelled_map_continues_from_its_store_and_is_bit_identical(tmp_path: Path) -> None:
    store = tmp_path / "map.nc"
    cancel = threading.Event()
    begun = compute_map(SPEC, store=store, cancel=cancel, on_progress=lambda _share: cancel.set())
    assert not begun.complete
    assert open_result(store, EscapeMap).fate.tobytes() == begun.fate.tobytes()
    shares: list[float] = []
    continued, whole = compute_map(SPEC, store=store, on_progress=shares.append), compute_map(SPEC)
    assert len(shares) == 1
    for result in (continued, open_result(store, EscapeMap)):
        assert result.complete
        for name in PIXEL_ARRAYS:
            np.testing.assert_array_equal(getattr(result, name), getattr(whole, name), err_msg=name)


def test_a_finished_map_is_read_from_its_store(tmp_path: Path) -> None:
    store = tmp_path / "map.nc"
    first = compute_map(SMALL, store=store)
    shares: list[float] = []
    second = compute_map(SMALL, store=store, on_progress=shares.append)
    assert shares == []
    assert second.identical(first)


def test_a_store_without_its_folder_or_of_another_request_is_refused(tmp_path: Path) -> None:
    store = tmp_path / "map.nc"
    compute_map(SMALL, store=store)
    other = MapSpec(CASES["III"], Plane.X_PX, 0.45, (20, 21), t_max=20.0)
    with pytest.raises(ValueError, match=r"map.nc: holds a map with another energy; must be new, or the store of this map"):
        compute_map(other, store=store)
    with pytest.raises(ValueError, match=r"map.zarr: must end in .nc"):
        compute_map(SMALL, store=tmp_path / "map.zarr")
    with pytest.raises(ValueError, match="nowhere does not exist; make it first"):
        compute_map(SMALL, store=tmp_path / "nowhere" / "map.nc")
    with pytest.raises(ValueError, match="resume: must be None with a store"):
        compute_map(SMALL, store=store, resume=compute_map(SMALL))


def test_a_damaged_store_is_refused_by_name(tmp_path: Path) -> None:
    store = tmp_path / "map.nc"
    compute_map(SMALL, store=store)
    store.write_bytes(store.read_bytes()[:2000])
    with pytest.raises(OSError, match=r"map.nc: cannot be read as a NetCDF file"):
        compute_map(SMALL, store=store)
