"""When a cluster loses workers or its scheduler, a sweep goes on, or ends with a sentence and resumes with the same bytes."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import distributed
import numpy as np
import pytest

from cli.commands import sweep
from cli.execution import describe_losses
from cli.main import FAILED, main
from engine import CASES, Plane, SweepSpec, compute_sweep
from engine.foundations.execution import Execution
from engine.propagation.tiles import map_tiles
from tests.forgetful_pool import ForgetfulPool
from tests.forked import run

SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.36, 0.4), (15, 15), t_max=2e4)
SWEEP = (
    "sweep", "III", "--energy", "0.36", "--energy", "0.4", "--resolution", "15", "--t-max", "2e4",
    "--store", "store.zarr",
)  # fmt: skip


def files_of(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the files of a sweep without losses."""
    folder = tmp_path_factory.mktemp("straight")
    compute_sweep(SPEC, folder / "store")
    return files_of(folder / "store")


# The calls of a map are first those of its tiles, then the tests for evidence.
@pytest.mark.parametrize("good_calls", [0, 20])
def test_dropped_call_ends_a_sweep_that_resumes_with_the_same_bytes(
    good_calls: int, tmp_path: Path, straight: dict[str, bytes]
) -> None:
    with ForgetfulPool(good_calls) as pool, pytest.raises(BrokenExecutor):
        compute_sweep(SPEC, tmp_path / "store", execution=Execution(pool))
    compute_sweep(SPEC, tmp_path / "store")
    assert files_of(tmp_path / "store") == straight


def test_a_dropped_call_is_not_taken_for_a_result() -> None:
    with ForgetfulPool(0) as pool, pytest.raises(BrokenExecutor):
        map_tiles(lambda *_: np.ones(1), CASES["I"], np.zeros((1, 4)), execution=Execution(pool))


@pytest.mark.parametrize(
    ("error", "expected"),
    [
        (distributed.KilledWorker("task", None, 3), "several workers died"),
        (BrokenExecutor("dropped"), "the scheduler of the cluster is lost"),
        (distributed.comm.CommClosedError("ConnectionPool closing."), "the scheduler of the cluster is lost"),
        (OSError("Timed out trying to connect to tcp://node1:8786 after 30 s"), "the scheduler of the cluster is lost"),
    ],
    ids=["workers", "scheduler restarted", "connection lost", "no connection"],
)
def test_losses_of_workers_and_schedulers_are_described(error: Exception, expected: str) -> None:
    with pytest.raises(ConnectionError, match=expected), describe_losses():
        raise error


def sweep_and_lose(folder: Path, lose: Callable[[Any], None]) -> None:
    """Run the command on a cluster of two processes, with a loss after the first map."""
    os.chdir(folder)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster:
        lost: list[float] = []

        def on_progress(share: float) -> None:
            if share > 0.0 and not lost:
                lost.append(share)
                lose(cluster)

        sweep.compute_sweep = lambda spec, store, *, execution: compute_sweep(
            spec, store, execution=replace(execution, on_progress=on_progress)
        )
        sys.exit(main((*SWEEP, "--scheduler", cluster.scheduler_address)))


def kill_worker(cluster: Any) -> None:
    with distributed.Client(cluster) as client:
        os.kill(min(client.run(os.getpid).values()), signal.SIGKILL)


def close_scheduler(cluster: Any) -> None:
    cluster.sync(cluster.scheduler.close)


@pytest.mark.slow
def test_a_sweep_continues_when_a_worker_is_killed(tmp_path: Path, straight: dict[str, bytes]) -> None:
    killed = run(tmp_path, sweep_and_lose, tmp_path, kill_worker)
    assert killed.code == 0, killed.err
    assert files_of(tmp_path / "store.zarr") == straight


@pytest.mark.slow
def test_a_sweep_whose_scheduler_is_lost_resumes_without_it(tmp_path: Path, straight: dict[str, bytes]) -> None:
    lost = run(tmp_path, sweep_and_lose, tmp_path, close_scheduler)
    assert lost.code == FAILED
    assert "escape-explorer: the scheduler of the cluster is lost; start it" in lost.err
    compute_sweep(SPEC, tmp_path / "store.zarr")
    assert files_of(tmp_path / "store.zarr") == straight
