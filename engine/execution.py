"""Executors for parallel computations, and cancellation."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from functools import cache
from typing import Any


def count_cores() -> int:
    """How many cores this process may use."""
    # Python 3.12 cannot tell the cores of this process from those of the machine.
    count = getattr(os, "process_cpu_count", os.cpu_count)
    return count() or 1


# Of threads that compute: where they compete with others, they get a tenth of a processor.
_NICENESS = 10


@cache
def default_executor() -> ThreadPoolExecutor:
    """The one bounded pool of this process: a thread for each core it may use; kernels hold no GIL."""
    return thread_pool(count_cores())


def thread_pool(count: int, *, only_idle: bool = False) -> ThreadPoolExecutor:
    """So many threads for kernels, which leave the processors to those of this process that answer people.

    Parameters
    ----------
    count
        At least 1.
    only_idle
        Whether they run only while a processor has nothing else to do, where the system is Linux: whoever answers people then
        never waits for them, but any other program that keeps all processors busy stops them. Without it they have
        a tenth of a processor at least.
    """
    manners = _take_what_is_left if only_idle else _take_little
    return ThreadPoolExecutor(count, thread_name_prefix="orbits", initializer=manners)


def _take_little() -> None:
    # Elsewhere priorities belong to whole processes.
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)


def _take_what_is_left() -> None:
    if sys.platform == "linux":
        os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))


def count_workers(executor: Executor) -> int:
    """How many calls an executor runs at once; 2 when it does not say."""
    # Dask's executor knows its client, and that the workers it has now: they may come and go.
    threads = getattr(getattr(executor, "_client", None), "nthreads", None)
    if threads is not None:
        return sum(threads().values()) or 2
    return int(getattr(executor, "_max_workers", 2))


class SerialExecutor(Executor):
    """Runs everything at once in the calling thread: for one orbit, or inside a worker of a pool."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The future of a call that is already over."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


def is_cancelled(cancel: threading.Event | None) -> bool:
    """Whether a cancel event was given and is set."""
    return cancel is not None and cancel.is_set()


def raise_if_cancelled(cancel: threading.Event | None) -> None:
    """Raise `concurrent.futures.CancelledError` if a cancel event was given and is set."""
    if is_cancelled(cancel):
        raise CancelledError
