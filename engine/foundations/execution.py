"""How computations run: executors, cancellation and progress."""

from __future__ import annotations

import functools
import inspect
import math
import os
import reprlib
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

# Approximate smallest number of indices in a part of `run_parts`.
_SMALLEST_PART = 1000
# Nice value of compute threads, which under contention get about a tenth of the processor time of a normal thread. At idle
# priority, another program could stop a thread that holds the interpreter lock, and all other threads would wait for the lock.
_NICE_VALUE = 10
# Time after which a progress bar appears, in seconds.
_BAR_DELAY = 1.0
# Format of a progress bar, for tqdm.
_BAR_FORMAT = "{desc}: {percentage:3.0f}% |{bar}| {elapsed}<{remaining}"
# Set while a progress bar is shown, so that nested calls show no bar.
_bar_is_shown = threading.Event()
# Environment variable that disables progress bars: that of tqdm, which reads it only when it is first imported.
_NO_BARS = "TQDM_DISABLE"


def count_cores() -> int:
    """Return the number of cores that this process may use."""
    # os.process_cpu_count is new in Python 3.13.
    count_cpus = getattr(os, "process_cpu_count", os.cpu_count)
    return count_cpus() or 1


@functools.cache
def default_executor() -> ThreadPoolExecutor:
    """Return the thread pool of this process, one thread per core. Kernels release the GIL, so threads run in parallel."""
    return create_thread_pool(count_cores())


if hasattr(os, "register_at_fork"):
    # A child process inherits the pool without its threads, and would wait for them forever.
    os.register_at_fork(after_in_child=default_executor.cache_clear)


def create_thread_pool(threads: int) -> ThreadPoolExecutor:
    """Return a thread pool for kernels. Its threads have a lower priority than the other threads of this process."""
    return ThreadPoolExecutor(threads, thread_name_prefix="orbits", initializer=_lower_priority)


def _lower_priority() -> None:
    """Raise the nice value of the calling thread, on Linux only; on other systems, a nice value applies to the whole process."""
    if sys.platform == "linux":
        thread = threading.get_native_id()
        # A program without privileges can only raise the value.
        os.setpriority(os.PRIO_PROCESS, thread, max(os.getpriority(os.PRIO_PROCESS, thread), _NICE_VALUE))


def count_workers(executor: Executor) -> int:
    """Return the number of calls that an executor runs in parallel; 2 if the number is unknown."""
    # The number of Dask's workers may change, so each call asks the client.
    thread_counts = getattr(getattr(executor, "_client", None), "nthreads", None)
    if thread_counts is not None:
        return sum(thread_counts().values()) or 2
    return int(getattr(executor, "_max_workers", 2))


class SerialExecutor(Executor):
    """An executor that runs each call immediately in the calling thread, for single orbits or inside a worker of another pool."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Call the function and return its completed future."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@dataclass(frozen=True)
class Execution:
    """Options of a computation: its executor, its cancellation, and the receiver of its progress.

    No option changes a complete result, not even its last bit. A cancelled computation raises
    `concurrent.futures.CancelledError`, except where the result marks what is missing: `compute_map` and the analyses of maps
    return a map whose ``complete`` is False, and `classify_orbits` returns a code of its own for orbits that were not computed.

    Parameters
    ----------
    executor
        Any `concurrent.futures.Executor`, including that of a Dask client; None for the thread pool of this process.
    cancel
        Setting this event ends the computation within about 0.2 s; None for a computation that cannot be cancelled.
    on_progress
        Called in the calling thread with the share done, 0 to 1; None for a progress bar in a terminal or a notebook,
        unless the environment variable TQDM_DISABLE is 1.
    """

    executor: Executor | None = None
    cancel: threading.Event | None = None
    on_progress: Callable[[float], None] | None = None

    def __post_init__(self) -> None:
        if hasattr(self.executor, "get_executor"):
            raise ValueError(f"executor={reprlib.repr(self.executor)}: must be an Executor, as client.get_executor() of Dask")
        if not isinstance(self.executor, Executor | None):
            raise ValueError(f"executor={reprlib.repr(self.executor)}: must be a concurrent.futures.Executor or None")
        if self.cancel is not None and not hasattr(self.cancel, "is_set"):
            raise ValueError(f"cancel={reprlib.repr(self.cancel)}: must be a threading.Event or None")
        if self.on_progress is not None and not callable(self.on_progress):
            raise ValueError(f"on_progress={reprlib.repr(self.on_progress)}: must be a function of the share done, or None")

    @property
    def _pool(self) -> Executor:
        """The executor, by default the thread pool of this process."""
        return self.executor or default_executor()

    @property
    def workers(self) -> int:
        """Number of calls that run in parallel."""
        return count_workers(self._pool)

    @property
    def is_cancelled(self) -> bool:
        """Whether the computation has been cancelled."""
        return self.cancel is not None and self.cancel.is_set()

    def raise_if_cancelled(self) -> None:
        """Raise `concurrent.futures.CancelledError` if the computation has been cancelled."""
        if self.is_cancelled:
            raise CancelledError

    def in_this_thread(self) -> Execution:
        """Return the same options for the calling thread alone, for single orbits or inside a worker of another pool."""
        return replace(self, executor=SerialExecutor())

    def report(self, share: Callable[[], float]) -> None:
        """Report the share done, 0 to 1; without a receiver, `share` is not called."""
        if self.on_progress is not None:
            self.on_progress(share())

    def part(self, number: int, count: int) -> Execution:
        """Return the options for part `number`, from 0, of `count` parts of equal work. Progress is reported for all parts."""
        report = self.on_progress
        return self if report is None else replace(self, on_progress=lambda share: report((number + share) / count))

    def submit[T](self, function: Callable[..., T], *arguments: Any) -> Future[T]:
        """Queue a call in the executor, and return its future."""
        return self._pool.submit(function, *arguments)

    def collect[T](self, future: Future[T]) -> T | None:
        """Wait for a call and return its result; None if it never ran because the computation was cancelled.

        Raises
        ------
        concurrent.futures.BrokenExecutor
            When the executor dropped a call that was not cancelled, for example because a cluster lost its scheduler.
        """
        try:
            return future.result()
        except CancelledError:
            if self.is_cancelled:
                return None
            raise BrokenExecutor("the executor has dropped a part of the computation; run it again") from None


DEFAULT_EXECUTION = Execution()
"""Execution in the thread pool of this process; it cannot be cancelled."""

SERIAL_EXECUTION = Execution(SerialExecutor())
"""Execution in the calling thread; it cannot be cancelled."""


def run_parts(
    work: Callable[..., Any],
    indices: np.ndarray,
    select: Callable[[np.ndarray], tuple[Any, ...]],
    execution: Execution,
) -> Iterator[tuple[np.ndarray, Any]]:
    """Run ``work(*select(part))`` in parallel for parts of an index array, and yield each part of `indices` with its result.

    Parts that never ran because of a cancellation are left out. `work` must be a function of a module, so that it can be pickled
    for other processes, and it should release the GIL.
    """
    # Two parts per worker, because parts differ in duration.
    count = min(2 * execution.workers, math.ceil(indices.size / _SMALLEST_PART))
    parts = np.array_split(indices, count) if count else []
    futures = [execution.submit(work, *select(part)) for part in parts]
    for part, future in zip(parts, futures, strict=True):
        result = execution.collect(future)
        if result is not None:
            yield part, result


def shows_progress[**P, T](label: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorate a function with a parameter ``execution`` to show a progress bar, unless the caller receives the progress.

    The caller receives it by `Execution.on_progress`, or by a parameter ``on_progress`` or ``on_frame`` of the function. A bar
    appears after a second, in the main thread of a terminal or a notebook only. The environment variable ``TQDM_DISABLE=1``
    disables all bars.
    """

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        signature = inspect.signature(function)

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> T:
            given_arguments = _arguments_by_name(signature, args, kwargs)
            execution = given_arguments.get("execution", DEFAULT_EXECUTION)
            if not isinstance(execution, Execution):
                # The function itself raises the error.
                return function(*args, **kwargs)
            receivers = execution.on_progress, given_arguments.get("on_progress"), given_arguments.get("on_frame")
            has_receiver = any(receiver is not None for receiver in receivers)
            if has_receiver or _bar_is_shown.is_set() or not _is_interactive():
                return function(*args, **kwargs)
            with _show_bar(label) as report:
                bound = signature.bind(*args, **kwargs)
                bound.arguments["execution"] = replace(execution, on_progress=report)
                return function(*bound.args, **bound.kwargs)

        return call

    return decorate


def _arguments_by_name(signature: inspect.Signature, args: Any, kwargs: Any) -> Mapping[str, Any]:
    """Return the arguments of a call by name; if the call does not fit the signature, only an `execution` of None."""
    try:
        return signature.bind(*args, **kwargs).arguments
    except TypeError:
        return {"execution": None}


def _is_interactive() -> bool:
    """Return whether this call runs in the main thread of a terminal or a notebook whose user wants bars."""
    if threading.current_thread() is not threading.main_thread() or os.environ.get(_NO_BARS, "0") not in ("", "0"):
        return False
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def _show_bar(label: str) -> Iterator[Callable[[float], None]]:
    """Show a progress bar while the context is active, and yield a function that receives the share done."""
    with warnings.catch_warnings():
        # Without Jupyter's widgets, tqdm shows a bar of text and a warning.
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm

        bar = tqdm(total=1.0, desc=label, delay=_BAR_DELAY, leave=False, bar_format=_BAR_FORMAT)

    def report(share: float) -> None:
        bar.update(max(share - bar.n, 0.0))

    _bar_is_shown.set()
    try:
        with bar:
            yield report
    finally:
        _bar_is_shown.clear()
