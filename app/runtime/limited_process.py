"""Processes with limits of time and memory, for formulas that visitors type. The server survives the end of such a process."""

from __future__ import annotations

import importlib
import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, Future, wait
from concurrent.futures import TimeoutError as FutureTimeoutError
from contextlib import suppress
from functools import partial
from math import ceil
from queue import PriorityQueue
from typing import NamedTuple

import psutil
from loky import ProcessPoolExecutor

REVIEW_SECONDS = 5
"""Limit of the processor time of a review of a formula, in seconds."""

COMPILATION_SECONDS = 60
"""Limit of the processor time for compiling one kernel, in seconds. The kernels of the largest formulas need 10 s."""

PROCESSES = 2
"""Number of processes for reviews. While one process is busy with a visitor's formula, the other serves other visitors."""

LONGEST_WAIT_SECONDS = 60.0
"""Longest time until a process has started, and longest time that a call waits for a processor, in seconds."""

IDLE_SECONDS = 300
"""Time without a call after which a process ends, in seconds. A process uses 100 MB."""

ADDITIONAL_BYTES = 2**30
"""Memory that a process may use in addition to its memory at the start, in bytes."""

# Interval at which a process checks whether the server still runs, in seconds.
_WATCH_SECONDS = 2.0
# Interval at which a waiting call checks whether it is cancelled, in seconds.
_POLL_SECONDS = 0.1
# Time from the start of a call during which the call cannot be cancelled, in seconds.
_UNCANCELLABLE_SECONDS = 1.0


class LimitError(ValueError):
    """A call needs more time or memory than is allowed."""


class CallTotals(NamedTuple):
    """The calls that one or more limited processes have made so far, and the present memory.

    Attributes
    ----------
    answered
        Number of calls that have returned a result.
    stopped
        Number of calls that have exceeded a limit.
    seconds
        Processor time of these calls, in seconds. A stopped call counts with its limit.
    resident_bytes
        Resident memory of the processes.
    """

    answered: int = 0
    stopped: int = 0
    seconds: float = 0.0
    resident_bytes: int = 0


class LimitedProcess:
    """Makes calls in a process, one at a time. The process starts with the first call, and again after it has ended.

    The process ends after `IDLE_SECONDS` without a call, or with the server. When a call exceeds a limit or is cancelled, another
    process is started at once, so that the next call need not wait for it.

    Parameters
    ----------
    seconds
        Limit of the processor time of a call, in whole seconds; at least 1.
    memory
        Memory that the process may use in addition to its memory at the start, in bytes.
    task
        The task of the process, in words. Messages about exceeded limits begin with it.
    longest_wait
        Longest time until the process has started, and longest time that a call waits for a processor, in seconds.

    Attributes
    ----------
    has_started
        Whether the process has answered a call.
    """

    def __init__(
        self,
        seconds: int = REVIEW_SECONDS,
        memory: int = ADDITIONAL_BYTES,
        task: str = "reviewing this formula",
        longest_wait: float = LONGEST_WAIT_SECONDS,
    ) -> None:
        self._seconds, self._memory, self._task, self._longest_wait = seconds, memory, task, longest_wait
        self._lock = threading.Lock()
        self._executor: ProcessPoolExecutor | None = None
        self._is_closed = False
        self._process_id: int | None = None
        self._totals = CallTotals()
        self.has_started = False

    def __call__[Result](self, function: Callable[[], Result], cancel: threading.Event | None = None) -> Result:
        """Return the result of a function. Function and result are pickled.

        Parameters
        ----------
        function
            The function to call.
        cancel
            Set when nobody waits for the result any longer.

        Raises
        ------
        LimitError
            If the function exceeds a limit.
        concurrent.futures.CancelledError
            If the call is cancelled.
        """
        with self._lock:
            try:
                cancel = cancel or threading.Event()
                self._wait_for_start(cancel)
                result, seconds = self._call(function, cancel)
            except LimitError:
                self._count(stopped=1, seconds=self._seconds)
                raise
            self._count(answered=1, seconds=seconds)
            return result

    def _count(self, *, answered: int = 0, stopped: int = 0, seconds: float) -> None:
        totals = self._totals
        self._totals = CallTotals(totals.answered + answered, totals.stopped + stopped, totals.seconds + seconds)

    @property
    def totals(self) -> CallTotals:
        """The calls so far, and the present memory."""
        resident_bytes = 0
        with suppress(psutil.Error):
            resident_bytes = psutil.Process(self._process_id).memory_info().rss if self._process_id is not None else 0
        return self._totals._replace(resident_bytes=resident_bytes)

    def start(self) -> None:
        """Start the process, unless it runs, and do not wait for it."""
        # During a call the process runs.
        if self._lock.acquire(blocking=False):
            try:
                self._start()
            finally:
                self._lock.release()

    def close(self) -> None:
        """End the process."""
        self._is_closed = True
        self._end()

    def _end(self) -> None:
        executor, self._executor, self._process_id, self.has_started = self._executor, None, None, False
        if executor is not None:
            executor.shutdown(wait=False, kill_workers=True)

    def _replace(self) -> None:
        """End the process, and start another one unless the server is stopping."""
        self._end()
        self._start()

    def _start(self) -> None:
        if not self._is_closed:
            # Any call starts the process; this one is cheap. If no process can start now, the next call starts one.
            with suppress(OSError, MemoryError):
                self._submit(os.getpid)

    def _wait_for_start(self, cancel: threading.Event) -> None:
        """Wait until the process has started. Start the process if it does not run."""
        try:
            # This call takes no time, so its result shows that the process has started.
            self._process_id = self._wait(self._submit(os.getpid), cancel, self._longest_wait)
            self.has_started = True
        except (BrokenExecutor, FutureTimeoutError, MemoryError):
            self._end()
            raise LimitError(f"{self._task} could not begin: the machine is busy or short of memory; try again later") from None

    def _call[Result](self, function: Callable[[], Result], cancel: threading.Event) -> tuple[Result, float]:
        """Return the result of a function and its processor time. Replace a process at a limit, or if its call is cancelled."""
        try:
            call = self._submit(partial(_call_limited, self._seconds, function))
            return self._wait(call, cancel, self._seconds + self._longest_wait)
        except FutureTimeoutError:
            self._replace()
            raise LimitError(f"{self._task} takes too long while the machine is busy; try again later") from None
        except (BrokenExecutor, MemoryError):
            self._replace()
        except CancelledError:
            self._replace()
            raise
        except RecursionError:
            # The process survives.
            pass
        raise LimitError(f"{self._task} needs more than {self._seconds} s or {self._memory // 2**20} MB; choose a simpler one")

    def _wait[Result](self, future: Future[Result], cancel: threading.Event, most_seconds: float) -> Result:
        """Return the result of a call. Raise an error if the call takes too long or is cancelled."""
        begin = time.monotonic()
        while not wait([future], _POLL_SECONDS).done:
            seconds = time.monotonic() - begin
            if cancel.is_set() and seconds > _UNCANCELLABLE_SECONDS:
                raise CancelledError
            if seconds > most_seconds:
                raise FutureTimeoutError
        return future.result()

    def _submit[Result](self, call: Callable[[], Result]) -> Future[Result]:
        """Start a call, in a new process if the previous process has ended."""
        if self._executor is not None:
            with suppress(BrokenExecutor):
                return self._executor.submit(call)
        self._executor = ProcessPoolExecutor(
            max_workers=1, timeout=IDLE_SECONDS, initializer=_prepare_process, initargs=(self._memory, os.getpid())
        )
        return self._executor.submit(call)


class LimitedProcesses:
    """Makes calls in several limited processes. A process that has not started is used only when the others are busy."""

    def __init__(self, count: int = PROCESSES) -> None:
        self._processes = [LimitedProcess() for _ in range(count)]
        # Free processes as (has not started, number), so that processes that have started come first.
        self._free: PriorityQueue[tuple[bool, int]] = PriorityQueue()
        for number in range(count):
            self._release(number)

    def _release(self, number: int) -> None:
        """Make a process available for another call."""
        self._free.put((not self._processes[number].has_started, number))

    def __call__[Result](self, function: Callable[[], Result], cancel: threading.Event | None = None) -> Result:
        """Return the result of a function, called in a free process as by `LimitedProcess`."""
        _, number = self._free.get()
        try:
            return self._processes[number](function, cancel)
        finally:
            self._release(number)

    def start(self) -> None:
        """Start a process on another thread. A call that follows need not wait until the process has loaded its modules."""
        process = next((each for each in self._processes if each.has_started), self._processes[0])
        threading.Thread(target=process.start, name="start of a limited process", daemon=True).start()

    @property
    def totals(self) -> CallTotals:
        """The calls of all processes so far, and their present memory."""
        totals = [process.totals for process in self._processes]
        return CallTotals(
            answered=sum(each.answered for each in totals),
            stopped=sum(each.stopped for each in totals),
            seconds=sum(each.seconds for each in totals),
            resident_bytes=sum(each.resident_bytes for each in totals),
        )

    def close(self) -> None:
        """End the processes."""
        for process in self._processes:
            process.close()


def _call_limited[Result](seconds: int, function: Callable[[], Result]) -> tuple[Result, float]:
    """Return the result of a function and its processor time. The operating system ends the process after `seconds`."""
    begin = time.process_time()
    # On Windows, `resource` is missing, and only the time that the caller waits is limited.
    with suppress(ImportError):
        import resource

        usage = resource.getrusage(resource.RUSAGE_SELF)
        _, hard_limit = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (ceil(usage.ru_utime + usage.ru_stime) + seconds, hard_limit))
    return function(), time.process_time() - begin


def _prepare_process(memory: int, server_id: int) -> None:
    """Limit the memory of the process, load what calls need, and watch the server."""
    threading.Thread(target=_end_with_server, args=(server_id,), daemon=True).start()
    # The first review needs this module. Import it before a visitor waits for it.
    importlib.import_module("engine.systems.review.potential_review")
    _limit_memory(memory)


def _end_with_server(server_id: int) -> None:
    """End the process when the server has ended, even if the server was killed."""
    while os.getppid() == server_id:
        time.sleep(_WATCH_SECONDS)
    os._exit(0)


def _limit_memory(additional_bytes: int) -> None:
    """Limit the address space of this process, except on Windows."""
    with suppress(ImportError):
        import resource

        # Write no core file when the operating system ends the process.
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        _, hard_limit = resource.getrlimit(resource.RLIMIT_AS)
        soft_limit = psutil.Process().memory_info().vms + additional_bytes
        resource.setrlimit(
            resource.RLIMIT_AS, (soft_limit if hard_limit == resource.RLIM_INFINITY else min(soft_limit, hard_limit), hard_limit)
        )
