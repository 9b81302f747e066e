"""Executors for parallel computations, and cancellation."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np

# Smallest part of an index array that is worth a task.
_LEAST_PART = 1000
# Nice value of compute threads: under contention they get about a tenth of the CPU time of a normal thread. With idle priority
# they could be stopped by another program while they hold the interpreter lock, for which all other threads would wait.
_NICE_VALUE = 10


def count_cores() -> int:
    """How many cores this process may use."""
    # os.process_cpu_count is new in Python 3.13.
    count = getattr(os, "process_cpu_count", os.cpu_count)
    return count() or 1


@cache
def default_executor() -> ThreadPoolExecutor:
    """The thread pool shared by this process, one thread per core; kernels release the GIL."""
    return create_thread_pool(count_cores())


def create_thread_pool(threads: int) -> ThreadPoolExecutor:
    """A thread pool for kernels, of lower priority than the threads of this process that serve requests."""
    return ThreadPoolExecutor(threads, thread_name_prefix="orbits", initializer=_lower_priority)


def _lower_priority() -> None:
    """Raise the nice value of the calling thread; on other systems than Linux it belongs to the whole process."""
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICE_VALUE)


def count_workers(executor: Executor) -> int:
    """How many calls an executor runs at once; 2 if it does not tell."""
    # Dask's executor: ask its client each time, as the number of workers may change.
    threads = getattr(getattr(executor, "_client", None), "nthreads", None)
    if threads is not None:
        return sum(threads().values()) or 2
    return int(getattr(executor, "_max_workers", 2))


def run_parts(
    work: Callable[..., Any],
    indices: np.ndarray,
    select: Callable[[np.ndarray], tuple[Any, ...]],
    *,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Iterator[tuple[np.ndarray, Any]]:
    """Run ``work(*select(part))`` in parallel for the parts of an index array; each part of `indices` with its result.

    Parts that never ran because of `cancel` are left out. `work` must be a module-level function, so that it can be pickled for
    other processes, and should release the GIL.
    """
    executor = executor or default_executor()
    count = min(2 * count_workers(executor), -(-indices.size // _LEAST_PART))
    parts = np.array_split(indices, count) if count else []
    futures = [executor.submit(work, *select(part)) for part in parts]
    for part, future in zip(parts, futures, strict=True):
        result = collect_result(future, cancel)
        if result is not None:
            yield part, result


class SerialExecutor(Executor):
    """Runs each call at once in the calling thread: for single orbits, or inside a worker of another pool."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function and return its completed future."""
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


def collect_result[T](future: Future[T], cancel: threading.Event | None) -> T | None:
    """The result of a call, after waiting for it; None if it never ran because the computation was cancelled.

    Raises
    ------
    concurrent.futures.BrokenExecutor
        When the executor has dropped the call although nobody cancelled it, as a cluster does that loses its scheduler.
    """
    try:
        return future.result()
    except CancelledError:
        if is_cancelled(cancel):
            return None
        raise BrokenExecutor("the executor has dropped a part of the computation; run it again") from None
