"""Computing elsewhere: the same files, and a word where it cannot be."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest
import xarray as xr

from cli.main import WENT_WRONG, WRONG_REQUEST

Run = Callable[..., tuple[int, str, str]]

MAP = ("map", "I", "--energy", 0.13, "--resolution", 12, "--t-max", 1000, "--format", "nc")
LOOKS = ("--judge", "--trust", "--origins")


@pytest.mark.slow
def test_a_map_of_a_cluster_is_that_of_threads(run: Run, tmp_path: Path) -> None:
    assert run(*MAP, *LOOKS, "--output", tmp_path / "threads")[0] == 0
    assert run(*MAP, *LOOKS, "--local-cluster", 1, "--output", tmp_path / "cluster")[0] == 0
    with (
        xr.open_dataset(tmp_path / "threads.nc", engine="h5netcdf") as wanted,
        xr.open_dataset(tmp_path / "cluster.nc", engine="h5netcdf") as found,
    ):
        assert {"character", "trust", "origin"} < set(found.data_vars)
        for name in set(wanted.variables) - {"energy_error"}:
            np.testing.assert_array_equal(found[name], wanted[name])


def test_a_map_is_computed_on_the_cluster_of_the_scheduler(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from engine.dynamics.batch import SerialExecutor

    asked: list[str] = []
    submitted = Mock(wraps=SerialExecutor())
    client = Mock()
    client.__enter__ = Mock(return_value=client)
    client.__exit__ = Mock(return_value=None)
    client.get_executor.return_value = submitted

    def connected(address: str) -> Mock:
        asked.append(address)
        return client

    monkeypatch.setattr("distributed.Client", connected)
    assert run(*MAP, "--scheduler", "tcp://node1:8786", "--output", tmp_path / "map")[0] == 0
    assert asked == ["tcp://node1:8786"]
    assert submitted.submit.called


def test_one_place_to_compute_can_be_chosen(run: Run, tmp_path: Path) -> None:
    code, _, err = run(*MAP, "--threads", 2, "--local-cluster", 2, "--output", tmp_path / "map")
    assert (code, err) == (WRONG_REQUEST, "escape-explorer: local_cluster and threads: choose one place to compute\n")
    assert not any(tmp_path.iterdir())


def test_without_dask_a_map_says_how_to_get_it(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, _, err = run(*MAP, "--local-cluster", 1, "--output", tmp_path / "map")
    assert code == WENT_WRONG
    assert err == "escape-explorer: a cluster needs Dask: pip install 'escape-explorer[cluster]'\n"
    assert not any(tmp_path.iterdir())
