"""Options ``--scheduler`` and ``--local-cluster``: same results, and an error message without Dask."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import distributed
import numpy as np
import pytest
import xarray as xr

from cli.main import FAILED, INVALID_REQUEST

Run = Callable[..., tuple[int, str, str]]

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


def test_scheduler_address_is_used(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from engine.execution import SerialExecutor

    addresses: list[str] = []
    executor = Mock(spec=SerialExecutor, wraps=SerialExecutor())
    client = Mock()
    client.__enter__ = Mock(return_value=client)
    client.__exit__ = Mock(return_value=None)
    client.get_executor.return_value = executor

    def connect(address: str) -> Mock:
        addresses.append(address)
        return client

    monkeypatch.setattr("distributed.Client", connect)
    assert run(*MAP, "--scheduler", "tcp://node1:8786", "--output", tmp_path / "map")[0] == 0
    assert addresses == ["tcp://node1:8786"]
    assert executor.submit.called


def test_threads_and_cluster_exclude_each_other(run: Run, tmp_path: Path) -> None:
    code, _, err = run(*MAP, "--threads", 2, "--local-cluster", 2, "--output", tmp_path / "map")
    assert (code, err) == (INVALID_REQUEST, "escape-explorer: local_cluster and threads: choose one place to compute\n")
    assert not any(tmp_path.iterdir())


def test_missing_dask_is_reported_with_the_install_command(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, _, err = run(*MAP, "--local-cluster", 1, "--output", tmp_path / "map")
    assert code == FAILED
    assert err == "escape-explorer: distributed is not installed: pip install 'escape-explorer[cluster]'\n"
    assert not any(tmp_path.iterdir())
