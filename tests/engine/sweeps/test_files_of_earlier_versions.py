"""Files of earlier versions are read."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import zarr

from engine import CASES, MapSpec, Plane, SweepSpec, compute_map, compute_statistics, compute_sweep, open_result, read_section

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (12, 10), t_max=200.0, use_evidence=False)
SWEEP = SweepSpec(CASES["III"], Plane.X_PX, (0.3, 0.4, 0.5), (12, 10), t_max=300.0, measures=("maps",))


def as_earlier(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset as earlier versions, which had one section, wrote it."""
    earlier = dataset.rename({"evidence": "certificate"} if "evidence" in dataset else {})
    earlier.attrs = {"certify" if name == "use_evidence" else name: value for name, value in dataset.attrs.items()}
    del earlier.attrs["section"]
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
    found = open_result(tmp_path / "sweep.zarr").dataset.load()
    xr.testing.assert_equal(found, wanted.dataset)
    assert set(wanted.dataset.attrs) - set(found.attrs) == {"section"}


def test_the_sweep_of_an_earlier_version_is_continued(tmp_path: Path) -> None:
    compute_sweep(SWEEP, tmp_path / "sweep.zarr")
    group = zarr.open_group(tmp_path / "sweep.zarr")
    group.attrs.put({name: value for name, value in group.attrs.items() if name not in ("section", "checksum")})
    xr.testing.assert_equal(compute_sweep(SWEEP, tmp_path / "sweep.zarr").dataset, compute_sweep(SWEEP).dataset)
    with pytest.raises(ValueError, match="holds another request, with section='y = 0 up'; must have section='x = 0 up'"):
        compute_sweep(replace(SWEEP, section=read_section("x = 0")), tmp_path / "sweep.zarr")


def test_measures_take_the_dataset_of_an_earlier_version() -> None:
    whole = compute_map(SPEC)
    assert compute_statistics(as_earlier(whole.to_xarray())).shares[0] == compute_statistics(whole).shares[0]


def test_a_store_without_a_sweep_is_not_continued(tmp_path: Path) -> None:
    maps = xr.Dataset({"crossings": ("h", [3]), "done": ("h", [True])}, {"h": [0.3]})
    maps.to_zarr(tmp_path / "store", consolidated=False, zarr_format=3)
    with pytest.raises(ValueError, match=r"store=.*: holds another request"):
        compute_sweep(SWEEP, tmp_path / "store")
