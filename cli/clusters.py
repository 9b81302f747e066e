"""Executors of Dask clusters; Dask is imported only when requested."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from distributed import Client


@contextmanager
def cluster_executor(scheduler: str | None, local_workers: int | None, threads: int | None) -> Iterator[Executor | None]:
    """Yield the executor of a cluster, or None if neither a scheduler nor local workers are requested.

    Parameters
    ----------
    scheduler
        Address of a running scheduler, ``tcp://host:port``.
    local_workers
        Number of worker processes to start on this machine, with one thread each.
    threads
        Number of threads in this process; None with a cluster.

    Raises
    ------
    ValueError
        If more than one of the three is given.
    ModuleNotFoundError
        If Dask is not installed.
    OSError
        If the scheduler does not answer; ConnectionError if the scheduler or the workers are lost during the computation.
    """
    given = [name for name, value in (("scheduler", scheduler), ("local_cluster", local_workers), ("threads", threads)) if value]
    if len(given) > 1:
        raise ValueError(f"{' and '.join(given)}: choose one place to compute")
    if scheduler is None and local_workers is None:
        yield None
        return
    with _connect(scheduler, local_workers) as client, _describing_losses():
        yield client.get_executor()


def _connect(scheduler: str | None, local_workers: int | None) -> Client:
    from engine.foundations.extras import require_package

    require_package("distributed", "cluster")
    import distributed

    if scheduler is not None:
        return distributed.Client(scheduler)  # type: ignore[no-untyped-call]
    with _ignoring_ctrl_c():
        # The dashboard takes a free port on the loopback interface.
        return distributed.Client(n_workers=local_workers, threads_per_worker=1, dashboard_address="127.0.0.1:0")  # type: ignore[no-untyped-call]


@contextmanager
def _describing_losses() -> Iterator[None]:
    """Replace Dask's errors of a lost scheduler or lost workers by sentences."""
    from distributed import KilledWorker
    from distributed.comm.core import CommClosedError

    try:
        yield
    except KilledWorker as error:
        raise ConnectionError(
            "several workers died in turn of the same part of the computation; check their memory, then run the command again"
        ) from error
    except (BrokenExecutor, OSError) as error:
        # Errors of the operating system have a number, and a plain OSError without one is a scheduler that does not answer.
        if isinstance(error, BrokenExecutor | CommClosedError) or (type(error) is OSError and error.errno is None):
            raise ConnectionError("the scheduler of the cluster is lost; start it, then run the same command again") from error
        raise


@contextmanager
def _ignoring_ctrl_c() -> Iterator[None]:
    """Make child processes ignore Ctrl-C, which a terminal sends to the whole process group; this process stops them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
