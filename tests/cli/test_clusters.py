"""Options ``--scheduler`` and ``--local-cluster``: same results, and an error message without Dask."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import distributed
import numpy as np
import pytest
import xarray as xr

from tests.cli.conftest import Run

MAP = ("map", "I", "--energy", 0.13, "--resolution", 12, "--t-max", 1000, "--format", "nc")
ANALYSES = ("--judge", "--trust", "--origins")


# Threads as workers, with messages as between processes; processes are in the long verification.
@pytest.mark.parametrize("processes", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["threads", "processes"])
def test_local_cluster_computes_the_same_map(processes: bool, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[int] = []

    def start(*, n_workers: int, **options: Any) -> Any:
        started.append(n_workers)
        return distributed.LocalCluster(n_workers=n_workers, **options, processes=processes, protocol="tcp", host="127.0.0.1")

    monkeypatch.setattr("distributed.deploy.LocalCluster", start)
    assert run(*MAP, *ANALYSES, "--output", tmp_path / "threads")[0] == 0
    assert run(*MAP, *ANALYSES, "--local-cluster", 1, "--output", tmp_path / "cluster")[0] == 0
    assert started == [1]
    with (
        xr.open_dataset(tmp_path / "threads.nc", engine="h5netcdf") as wanted,
        xr.open_dataset(tmp_path / "cluster.nc", engine="h5netcdf") as found,
    ):
        assert {"character", "trust", "origin"} < set(found.data_vars)
        for name in set(wanted.variables) - {"energy_error"}:
            np.testing.assert_array_equal(found[name], wanted[name])
