"""One pool for many: those who wait take turns, and nobody's fine picture is computed before everybody's first coarse one."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from enum import IntEnum
from typing import Any, NamedTuple

from engine.execution import count_workers, default_executor

# While tiles are put off: how many times as long as a call has lasted the next one that lasts waits.
_REST = 9.0


class Priority(IntEnum):
    """What is computed before what."""

    FIRST_LOOK = 0
    """For somebody who sees nothing yet."""

    WHOLE = 1
    """All of something at once, as an orbit that was clicked; it may take a second or more, so one thread is kept free of these,
    where there are two."""

    TILE = 2
    """A part of something larger, back within about 50 ms: there are always more of these where many look at maps."""


class _Task(NamedTuple):
    line: Line
    future: Future[Any]
    call: Callable[[], Any]


class FairScheduler:
    """Threads whose work is chosen at the last moment: by rank, and within a rank by turns.

    Parameters
    ----------
    pool
        The threads; None for those of this process.
    """

    def __init__(self, pool: ThreadPoolExecutor | None = None) -> None:
        self._pool = pool or default_executor()
        self.threads = count_workers(self._pool)
        self._lock = threading.Lock()
        # In the order of their turns; only those who wait for something.
        self._waiting: OrderedDict[Hashable, deque[_Task]] = OrderedDict()
        self._whole_ones = 0
        self._puts_off_tiles = False
        # Until when whole ones wait while tiles are put off.
        self._rest_until = 0.0
        # Threads that came for work while there was none that is not put off.
        self._sent_away = 0

    def line(self, owner: Hashable, rank: Callable[[], Priority]) -> Line:
        """Where one job hands its work in.

        Parameters
        ----------
        owner
            Whose job it is: all jobs of one owner together have one turn in each round.
        rank
            Asked each time that a thread is free.
        """
        return Line(self, owner, rank)

    @property
    def waiting(self) -> int:
        """Number of calls that no thread has taken up yet."""
        with self._lock:
            return sum(map(len, self._waiting.values()))

    def put_off_tiles(self, put_off: bool) -> None:
        """Leave them waiting, or with False take them up again: for a process that is behind with other things.

        Meanwhile calls that last have a tenth of a thread. To be called again and again, every tenth of a second or so.
        """
        with self._lock:
            self._puts_off_tiles = put_off
            again = min(1, self._sent_away) if put_off else self._sent_away
            self._sent_away -= again
        for _ in range(again):
            self._pool.submit(self._serve)

    def drop(self, line: Line) -> None:
        """Cancel those calls of a line that no thread has taken up."""
        with self._lock:
            dropped = [task for task in self._waiting.get(line.owner, ()) if task.line is line]
            for task in dropped:
                self._take_out(task)
        for task in dropped:
            # The first says so, the second wakes those who wait for it.
            task.future.cancel()
            task.future.set_running_or_notify_cancel()

    def _take_in(self, task: _Task) -> None:
        with self._lock:
            self._waiting.setdefault(task.line.owner, deque()).append(task)
        self._pool.submit(self._serve)

    def _serve(self) -> None:
        """The work of a thread: whatever is next. As many of these are under way as there are calls."""
        with self._lock:
            chosen = self._choose()
            if chosen is None:
                # Whoever ends a call that lasts comes for the next of these.
                self._sent_away += self._puts_off_tiles
                return
        task, rank = chosen
        begun = time.monotonic()
        try:
            _carry_out(task)
        finally:
            if rank is Priority.WHOLE:
                with self._lock:
                    self._whole_ones -= 1
                    now = time.monotonic()
                    self._rest_until = now + _REST * (now - begun)
                self._pool.submit(self._serve)

    def _choose(self) -> tuple[_Task, Priority] | None:
        for rank in Priority:
            if rank is Priority.TILE and self._puts_off_tiles:
                continue
            if rank is Priority.WHOLE and not self._has_room_for_whole_ones():
                continue
            for owner, tasks in self._waiting.items():
                for task in tasks:
                    if task.line.rank() is rank:
                        self._take_out(task)
                        if owner in self._waiting:
                            self._waiting.move_to_end(owner)
                        self._whole_ones += rank is Priority.WHOLE
                        return task, rank
        return None

    def _has_room_for_whole_ones(self) -> bool:
        if self._puts_off_tiles:
            return self._whole_ones == 0 and time.monotonic() >= self._rest_until
        return self._whole_ones < max(self.threads - 1, 1)

    def _take_out(self, task: _Task) -> None:
        tasks = self._waiting[task.line.owner]
        tasks.remove(task)
        if not tasks:
            del self._waiting[task.line.owner]


class Line(Executor):
    """An executor whose calls wait for their turn in a `FairScheduler`."""

    def __init__(self, pool: FairScheduler, owner: Hashable, rank: Callable[[], Priority]) -> None:
        self._fair_pool = pool
        self.owner = owner
        self.rank = rank

    def drop(self) -> None:
        """Cancel those calls that no thread has taken up."""
        self._fair_pool.drop(self)

    @property
    def _max_workers(self) -> int:
        """As executors say how many calls they run at once."""
        return self._fair_pool.threads

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """The future of a call that waits for its turn."""
        future: Future[Any] = Future()
        self._fair_pool._take_in(_Task(self, future, lambda: fn(*args, **kwargs)))
        return future


def _carry_out(task: _Task) -> None:
    if not task.future.set_running_or_notify_cancel():
        return
    try:
        result = task.call()
    except BaseException as error:
        task.future.set_exception(error)
    else:
        task.future.set_result(result)
