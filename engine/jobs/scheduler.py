"""Fair scheduling of the calls of many clients on one thread pool: by priority, and then by the time since the last turn.

Clients form groups that take turns, and the clients of a group take turns within it: all pages of one visitor get as much as one
page of another visitor.
"""

from __future__ import annotations

import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextvars import copy_context
from enum import IntEnum
from functools import partial
from typing import Any, NamedTuple, Protocol
from weakref import WeakSet

from engine.foundations.execution import count_workers, default_executor
from engine.jobs.last_turns import LastTurns

# Pause after a long call while background calls are paused, in units of its duration: a duty cycle of 10 %.
_PAUSE_PER_LONG_CALL = 9.0

Client = tuple[Hashable, ...]
"""The groups of a client, the largest first, and the client itself."""


class Clock(Protocol):
    """The functions of the module `time` that jobs use. In tests, another clock can replace them."""

    def monotonic(self) -> float:
        """Return seconds since a fixed moment."""

    def thread_time(self) -> float:
        """Return the processor time of the calling thread, in seconds."""


class Priority(IntEnum):
    """Priority of a call; lower values run first."""

    FIRST_FRAME = 0
    """Part of the first frame of a map. The page shows nothing until this frame is complete."""

    LONG_CALL = 1
    """A single call that takes up to some seconds, such as one orbit. One of several threads is kept free of such calls."""

    BACKGROUND = 2
    """Part of a larger computation, about 50 ms long. Under load, most calls have this priority."""

    UNSETTLED = 3
    """Like `BACKGROUND`, for a result that is likely to be replaced before anyone sees it, or that can wait."""


class _Call(NamedTuple):
    """A queued call with its future."""

    executor: QueueExecutor
    future: Future[Any]
    function: Callable[[], Any]

    def cancel(self) -> None:
        self.future.cancel()
        # This wakes the threads that wait for the future.
        self.future.set_running_or_notify_cancel()

    def run(self) -> None:
        """Call the function, unless the call was cancelled, and set the result or the exception of the future."""
        if not self.future.set_running_or_notify_cancel():
            return
        try:
            result = self.function()
        except BaseException as error:
            self.future.set_exception(error)
        else:
            self.future.set_result(result)


class FairScheduler:
    """Chooses the next call when a thread is free: by priority, then by the times since the last turns of its group and client.

    Groups and clients with many calls are thus served in turn, and those without recent calls are served before them.

    Parameters
    ----------
    pool
        The threads; None for the default pool of this process.
    clock
        The clock; by default the clock of this process.
    one_call_per_client
        Whether a client may run only one call at a time, which leaves the other threads to other clients.

    Attributes
    ----------
    threads
        Number of threads of the pool.
    processor_time
        Processor time of the calls that have ended, in seconds.
    first_frames_preferred
        Whether `prefer_first_frames` is in force.
    """

    def __init__(self, pool: ThreadPoolExecutor | None = None, clock: Clock = time, *, one_call_per_client: bool = False) -> None:
        self._pool = pool or default_executor()
        self._clock = clock
        self._one_call_per_client = one_call_per_client
        self.threads = count_workers(self._pool)
        self._lock = threading.Lock()
        # Queues of calls by client, then by executor, oldest first. Clients without pending calls are removed.
        self._pending: dict[Client, dict[QueueExecutor, deque[_Call]]] = {}
        self._turns = LastTurns[Client]()
        self._cancelled: WeakSet[QueueExecutor] = WeakSet()
        # Number of threads that run calls.
        self._active_threads = 0
        self._running_by_priority: Counter[Priority] = Counter()
        self._running_by_client: Counter[Client] = Counter()
        self._background_paused = False
        self.first_frames_preferred = False
        self.processor_time = 0.0
        # Earliest start of the next long call while background calls are paused, on the monotonic clock.
        self._next_long_call = 0.0

    def executor(self, client: Client, priority: Callable[[], Priority]) -> QueueExecutor:
        """Return a new executor for one job.

        Parameters
        ----------
        client
            The client of the job, with its groups. All jobs of one client share its turn.
        priority
            Returns the present priority of the calls. It is called whenever a thread is free.
        """
        return QueueExecutor(self, client, priority)

    @property
    def pending_calls(self) -> int:
        """Number of calls that no thread has started."""
        with self._lock:
            return sum(len(calls) for queues in self._pending.values() for calls in queues.values())

    def pause_background(self, paused: bool) -> None:
        """Pause or resume `Priority.BACKGROUND` calls and calls of lower priority, to relieve an overloaded process.

        During the pause, long calls have a duty cycle of 10 % of one thread. The next long call starts only when this method is
        called, so call it about every 0.1 s during the pause.
        """
        with self._lock:
            resumed = self._background_paused and not paused
            self._background_paused = paused
        if resumed or paused:
            self._start_threads(self.threads if resumed else 1)

    def prefer_first_frames(self, preferred: bool) -> None:
        """Start or end a preference that keeps one thread free for first frames, and delays `Priority.UNSETTLED` calls.

        When other programs use the processor, short calls take long, and the first frame of a map would wait for several of them.
        The only thread of a pool is not kept free. Delayed calls whose priority has changed start only when this method is
        called, so call it about every 0.1 s.
        """
        with self._lock:
            ended = self.first_frames_preferred and not preferred
            self.first_frames_preferred = preferred
        if ended or preferred:
            self._start_threads(self.threads if ended else 1)

    def add(self, call: _Call) -> None:
        """Queue a call. If the calls of its executor have been cancelled, cancel this call."""
        with self._lock:
            is_cancelled = call.executor in self._cancelled
            if not is_cancelled:
                self._pending.setdefault(call.executor.client, {}).setdefault(call.executor, deque()).append(call)
        if is_cancelled:
            call.cancel()
        else:
            self._start_threads(1)

    def cancel_futures(self, executor: QueueExecutor) -> None:
        """Cancel the calls of an executor that no thread has started, and all its later calls."""
        with self._lock:
            self._cancelled.add(executor)
            cancelled = self._pending.get(executor.client, {}).pop(executor, ())
            self._forget_if_empty(executor.client)
        for call in cancelled:
            call.cancel()

    def _start_threads(self, most_threads: int) -> None:
        """Start up to `most_threads` further threads of the pool, if calls are pending."""
        with self._lock:
            count = min(most_threads, self.threads - self._active_threads) if self._pending else 0
            self._active_threads += count
        for _ in range(count):
            self._pool.submit(self._run_calls)

    def _run_calls(self) -> None:
        """Run calls until no call may start."""
        while chosen := self._take_next():
            call, priority = chosen
            start, start_processor_time = self._clock.monotonic(), self._clock.thread_time()
            call.run()
            duration, processor_time = self._clock.monotonic() - start, self._clock.thread_time() - start_processor_time
            self._end_call(call.executor.client, priority, duration, processor_time)

    def _end_call(self, client: Client, priority: Priority, duration: float, processor_time: float) -> None:
        """Record that a call has ended, with its times in seconds."""
        with self._lock:
            self._running_by_priority[priority] -= 1
            self.processor_time += processor_time
            # This subtraction also removes clients without running calls.
            self._running_by_client -= Counter([client])
            if priority is Priority.LONG_CALL:
                self._next_long_call = self._clock.monotonic() + _PAUSE_PER_LONG_CALL * duration

    def _take_next(self) -> tuple[_Call, Priority] | None:
        """Remove the next call that may start from its queue, and return it with its priority.

        If no call may start, return None, and count the thread as no longer active.
        """
        with self._lock:
            chosen = self._find_next()
            if chosen is None:
                self._active_threads -= 1
                return None
            executor, priority = chosen
            self._running_by_priority[priority] += 1
            self._running_by_client[executor.client] += 1
            queues = self._pending[executor.client]
            call = queues[executor].popleft()
            if not queues[executor]:
                del queues[executor]
            self._turns.record(_groups(executor.client))
            self._forget_if_empty(executor.client)
            return call, priority

    def _find_next(self) -> tuple[QueueExecutor, Priority] | None:
        """Return the executor of the next call that may start, and its priority; None if there is no such call."""
        allowed = [client for client in self._pending if not (self._one_call_per_client and self._running_by_client[client])]
        allowed.sort(key=lambda client: [self._turns.last(group) for group in _groups(client)])
        candidates = [(executor, executor.priority()) for client in allowed for executor in self._pending[client]]
        startable = [candidate for candidate in candidates if self._may_start(candidate[1])]
        # The first of equal minima, which belongs to the client whose last turn is longest ago.
        return min(startable, key=lambda candidate: candidate[1], default=None)

    def _forget_if_empty(self, client: Client) -> None:
        """Remove a client without pending calls."""
        if client in self._pending and not self._pending[client]:
            del self._pending[client]

    def _may_start(self, priority: Priority) -> bool:
        """Return whether a call of a priority may start now."""
        if priority is Priority.FIRST_FRAME:
            return True
        # Keep one thread free, unless it is the only one.
        most_threads = max(self.threads - 1, 1)
        running_other_calls = self._running_by_priority.total() - self._running_by_priority[Priority.FIRST_FRAME]
        if self.first_frames_preferred and (running_other_calls >= most_threads or priority is Priority.UNSETTLED):
            return False
        if priority is not Priority.LONG_CALL:
            return not self._background_paused
        running_long_calls = self._running_by_priority[Priority.LONG_CALL]
        if self._background_paused:
            return running_long_calls == 0 and self._clock.monotonic() >= self._next_long_call
        return running_long_calls < most_threads


def _groups(client: Client) -> list[Client]:
    """Return the groups of a client, the largest first, and the client with all its groups."""
    return [client[:length] for length in range(1, len(client) + 1)]


class QueueExecutor(Executor):
    """Executor whose calls are queued in a `FairScheduler`."""

    def __init__(self, scheduler: FairScheduler, client: Client, priority: Callable[[], Priority]) -> None:
        self._scheduler = scheduler
        self.client = client
        self.priority = priority

    @property
    def _max_workers(self) -> int:
        """Number of threads, read by `engine.foundations.execution.count_workers`."""
        return self._scheduler.threads

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Queue a call, which runs in the context of the caller, and return its future."""
        future: Future[Any] = Future()
        call = partial(copy_context().run, fn, *args, **kwargs)
        self._scheduler.add(_Call(self, future, call))
        return future

    def cancel_futures(self) -> None:
        """Cancel the calls that no thread has started, and all later calls."""
        self._scheduler.cancel_futures(self)
