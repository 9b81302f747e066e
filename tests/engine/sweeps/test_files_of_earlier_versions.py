"""Files of earlier versions are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import CASES, MapSpec, Plane, SweepSpec, compute_map, compute_statistics, compute_sweep, open_result

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (12, 10), t_max=200.0, use_evidence=False)
SWEEP = SweepSpec(CASES["III"], Plane.X_PX, (0.3, 0.4, 0.5), (12, 10), t_max=300.0, measures=("maps",))


def as_earlier(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset as earlier versions wrote it."""
    earlier = dataset.rename({"evidence": "certificate"} if "evidence" in dataset else {})
    earlier.attrs = {"certify" if name == "use_evidence" else name: value for name, value in dataset.attrs.items()}
    return earlier


def test_the_map_of_an_earlier_version_is_read(tmp_path: Path) -> None:
    wanted = compute_map(SPEC)
    as_earlier(wanted.to_xarray()).to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    found = open_result(tmp_path / "map.nc")
    assert found.spec == SPEC
    np.testing.assert_array_equal(found.evidence, wanted.evidence)


def test_the_sweep_of_an_earlier_version_is_read_and_measured(tmp_path: Path) -> None:
    wanted = compute_sweep(SWEEP)
    as_earlier(wanted.dataset).to_zarr(tmp_path / "sweep.zarr", consolidated=False, zarr_format=3)
    xr.testing.assert_identical(open_result(tmp_path / "sweep.zarr").dataset.load(), wanted.dataset)


def test_measures_take_the_dataset_of_an_earlier_version() -> None:
    whole = compute_map(SPEC)
    assert compute_statistics(as_earlier(whole.to_xarray())).shares[0] == compute_statistics(whole).shares[0]


def test_a_store_without_a_sweep_is_not_continued(tmp_path: Path) -> None:
    maps = xr.Dataset({"crossings": ("h", [3]), "done": ("h", [True])}, {"h": [0.3]})
    maps.to_zarr(tmp_path / "store", consolidated=False, zarr_format=3)
    with pytest.raises(ValueError, match=r"store=.*: holds another sweep"):
        compute_sweep(SWEEP, tmp_path / "store")
