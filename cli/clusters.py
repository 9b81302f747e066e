"""A Dask cluster to compute on; Dask is loaded only when somebody asks for one."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from distributed import Client


@contextmanager
def cluster_executor(scheduler: str | None, local_workers: int | None, threads: int | None) -> Iterator[Executor | None]:
    """The executor of a cluster, or None where neither a scheduler nor workers on this machine are asked for.

    Parameters
    ----------
    scheduler
        Address of a running scheduler, ``tcp://host:port``.
    local_workers
        How many workers to start on this machine, each a process with one thread.
    threads
        None: threads are of the pool in this process, which a cluster replaces.

    Raises
    ------
    ValueError
        When more than one of them is asked for.
    ModuleNotFoundError
        When Dask is not installed.
    OSError
        When no scheduler answers.
    """
    asked = [name for name, value in (("scheduler", scheduler), ("local_cluster", local_workers), ("threads", threads)) if value]
    if len(asked) > 1:
        raise ValueError(f"{' and '.join(asked)}: choose one place to compute")
    if scheduler is None and local_workers is None:
        yield None
        return
    with _connect(scheduler, local_workers) as client:
        yield client.get_executor()


def _connect(scheduler: str | None, local_workers: int | None) -> Client:
    try:
        import distributed
    except ModuleNotFoundError:
        raise ModuleNotFoundError("a cluster needs Dask: pip install 'escape-explorer[cluster]'") from None
    if scheduler is not None:
        return distributed.Client(scheduler)  # type: ignore[no-untyped-call]
    with _ignoring_ctrl_c():
        # Whatever port is free for the dashboard, which no other machine can reach.
        return distributed.Client(n_workers=local_workers, threads_per_worker=1, dashboard_address="127.0.0.1:0")  # type: ignore[no-untyped-call]


@contextmanager
def _ignoring_ctrl_c() -> Iterator[None]:
    """Processes started here ignore it for good: a terminal sends it to all of them, and stopping is up to this one."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
