"""Options ``--scheduler`` and ``--local-cluster`` give the same results as threads."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import distributed
import numpy as np
import pytest
import xarray as xr

from tests.cli.conftest import Run

MAP = ("map", "I", "--energy", 0.13, "--resolution", 12, "--t-max", 1000, "--format", "nc")
ANALYSES = ("--judge", "--trust", "--origins")


@pytest.fixture
def scheduler() -> Iterator[str]:
    """Yield the address of the scheduler of a cluster whose workers are threads."""
    with distributed.LocalCluster(
        n_workers=1, processes=False, protocol="tcp", host="127.0.0.1", dashboard_address="127.0.0.1:0"
    ) as cluster:
        yield cluster.scheduler_address


def assert_same_map(run: Run, folder: Path, *place: object) -> None:
    """Check that a map computed elsewhere is equal to a map computed by threads of this process."""
    assert run(*MAP, *ANALYSES, "--output", folder / "threads")[0] == 0
    assert run(*MAP, *ANALYSES, *place, "--output", folder / "cluster")[0] == 0
    with (
        xr.open_dataset(folder / "threads.nc", engine="h5netcdf") as wanted,
        xr.open_dataset(folder / "cluster.nc", engine="h5netcdf") as found,
    ):
        assert {"character", "trust", "origin"} < set(found.data_vars)
        for name in set(wanted.variables) - {"energy_error"}:
            np.testing.assert_array_equal(found[name], wanted[name])


def test_a_cluster_computes_the_same_map(run: Run, tmp_path: Path, scheduler: str) -> None:
    assert_same_map(run, tmp_path, "--scheduler", scheduler)


@pytest.mark.slow
def test_a_local_cluster_of_processes_computes_the_same_map(run: Run, tmp_path: Path) -> None:
    assert_same_map(run, tmp_path, "--local-cluster", 1)
