"""Fair scheduling of many clients' calls on one thread pool, by priority and then round-robin."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from enum import IntEnum
from typing import Any, NamedTuple

from engine.execution import count_workers, default_executor

# While background calls are paused, a long call of duration d is followed by a pause of 9 d: a duty cycle of 10 %.
_PAUSE_PER_LONG_CALL = 9.0


class Priority(IntEnum):
    """Priority of a call; lower values run first."""

    FIRST_FRAME = 0
    """Part of the first frame of a map, before which its page shows nothing."""

    LONG_CALL = 1
    """A single call of up to seconds, such as one orbit. If there are several threads, one is kept free of these."""

    BACKGROUND = 2
    """Part of a larger computation, about 50 ms long; under load most calls are of this kind."""


class _Call(NamedTuple):
    executor: QueueExecutor
    future: Future[Any]
    function: Callable[[], Any]

    def run(self) -> None:
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            result = self.function()
        except BaseException as error:
            self.future.set_exception(error)
        else:
            self.future.set_result(result)


class FairScheduler:
    """Chooses, whenever a thread is free, the next call: by priority, and within a priority by client, round-robin.

    Parameters
    ----------
    pool
        The threads; None for the default pool of this process.
    """

    def __init__(self, pool: ThreadPoolExecutor | None = None) -> None:
        self._pool = pool or default_executor()
        self.threads = count_workers(self._pool)
        self._lock = threading.Lock()
        # By client, in round-robin order; clients without pending calls are removed.
        self._pending: OrderedDict[Hashable, deque[_Call]] = OrderedDict()
        self._running_long_calls = 0
        self._background_paused = False
        # Earliest start of the next long call while background calls are paused, on the monotonic clock.
        self._next_long_call = 0.0
        # Pool tasks that ended without a call while background calls were paused.
        self._unused_runs = 0

    def executor(self, client: Hashable, priority: Callable[[], Priority]) -> QueueExecutor:
        """Create an executor for one job.

        Parameters
        ----------
        client
            Whose job it is. All jobs of one client share its turn.
        priority
            Evaluated for each pending call whenever a thread is free.
        """
        return QueueExecutor(self, client, priority)

    @property
    def pending_calls(self) -> int:
        """Number of calls that no thread has started."""
        with self._lock:
            return sum(map(len, self._pending.values()))

    def pause_background(self, paused: bool) -> None:
        """Pause or resume `Priority.BACKGROUND` calls, to relieve an overloaded process.

        While they are paused, long calls have a duty cycle of 10 % of one thread. To start the next of these, call this method
        about every 0.1 s during the pause.
        """
        with self._lock:
            self._background_paused = paused
            runs = min(1, self._unused_runs) if paused else self._unused_runs
            self._unused_runs -= runs
        for _ in range(runs):
            self._pool.submit(self._run_next)

    def add(self, call: _Call) -> None:
        """Queue a call."""
        with self._lock:
            self._pending.setdefault(call.executor.client, deque()).append(call)
        self._pool.submit(self._run_next)

    def cancel_futures(self, executor: QueueExecutor) -> None:
        """Cancel the calls of an executor that no thread has started."""
        with self._lock:
            cancelled = [call for call in self._pending.get(executor.client, ()) if call.executor is executor]
            for call in cancelled:
                self._remove(call)
        for call in cancelled:
            call.future.cancel()
            # Wakes the threads that wait for the future.
            call.future.set_running_or_notify_cancel()

    def _run_next(self) -> None:
        """Run the next eligible call, if any. The pool holds one task of this kind per pending call."""
        with self._lock:
            chosen = self._take_next()
            if chosen is None:
                # If not paused, the pending calls are long ones, and a running long call submits the next run when it ends.
                self._unused_runs += self._background_paused
                return
        call, priority = chosen
        begun = time.monotonic()
        try:
            call.run()
        finally:
            if priority is Priority.LONG_CALL:
                with self._lock:
                    self._running_long_calls -= 1
                    now = time.monotonic()
                    self._next_long_call = now + _PAUSE_PER_LONG_CALL * (now - begun)
                self._pool.submit(self._run_next)

    def _take_next(self) -> tuple[_Call, Priority] | None:
        for priority in filter(self._may_start, Priority):
            for client, calls in self._pending.items():
                for call in calls:
                    if call.executor.priority() is priority:
                        self._remove(call)
                        if client in self._pending:
                            self._pending.move_to_end(client)
                        self._running_long_calls += priority is Priority.LONG_CALL
                        return call, priority
        return None

    def _may_start(self, priority: Priority) -> bool:
        if priority is Priority.FIRST_FRAME:
            return True
        if priority is Priority.BACKGROUND:
            return not self._background_paused
        if self._background_paused:
            return self._running_long_calls == 0 and time.monotonic() >= self._next_long_call
        return self._running_long_calls < max(self.threads - 1, 1)

    def _remove(self, call: _Call) -> None:
        client = call.executor.client
        self._pending[client].remove(call)
        if not self._pending[client]:
            del self._pending[client]


class QueueExecutor(Executor):
    """Executor whose calls are queued in a `FairScheduler`."""

    def __init__(self, scheduler: FairScheduler, client: Hashable, priority: Callable[[], Priority]) -> None:
        self._scheduler = scheduler
        self.client = client
        self.priority = priority

    @property
    def _max_workers(self) -> int:
        """Number of threads, read by `engine.execution.count_workers`."""
        return self._scheduler.threads

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call and return its future."""
        future: Future[Any] = Future()
        self._scheduler.add(_Call(self, future, lambda: fn(*args, **kwargs)))
        return future

    def cancel_futures(self) -> None:
        """Cancel the calls that no thread has started."""
        self._scheduler.cancel_futures(self)
