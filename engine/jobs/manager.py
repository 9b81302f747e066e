"""Requests from many people to one pool: in the background, shared while in flight, cancellable, kept in bounded memory."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Hashable
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import partial
from typing import Any, Protocol

from engine.execution import count_workers, thread_pool
from engine.jobs.cache import ResultCache, Sized
from engine.jobs.context import JobContext
from engine.jobs.orbit_semaphore import OrbitSemaphore
from engine.jobs.scheduler import FairScheduler, Line, Priority
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec

DEFAULT_CACHE_BYTES = 512 * 2**20
"""Memory for kept results."""

DEFAULT_ORBITS = 4 * 2**20
"""Orbits of large jobs under way together: some 500 MiB."""

# Threads that only wait for the pool and hand frames on; more jobs than this wait for their turn.
_COORDINATORS = 1024

log = logging.getLogger(__name__)


class JobRequest[Result: Sized](Protocol):
    """A request that knows how it is answered."""

    def __hash__(self) -> int: ...

    def run(self, bench: JobContext) -> Result:
        """The answer."""


class _End(Enum):
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"


@dataclass(eq=False)
class _Job:
    key: Hashable
    tickets: list[Subscription]
    owner: Hashable
    interactive: bool
    """Whether somebody sees nothing until this is there."""
    cancel: threading.Event = field(default_factory=threading.Event)
    latest: Any = None
    lines: list[Line] = field(default_factory=list)
    """Where its calls wait for their turn."""

    def stop(self) -> None:
        """Nobody waits for it any more."""
        self.cancel.set()
        for line in self.lines:
            line.drop()

    def empty(self) -> list[Subscription]:
        """It is over: let go of all that refers to it, so that its memory is free at once, and return its tickets."""
        tickets, self.tickets, self.lines, self.latest = self.tickets, [], [], None
        return tickets

    def rank(self) -> Priority:
        return Priority.FIRST_LOOK if self.interactive and self.latest is None else Priority.TILE


class Jobs:
    """The background work of a process.

    Parameters
    ----------
    executor
        Any `concurrent.futures.Executor` for the computing; None for the pool of this process, in which those who ask take turns.
    cache_bytes
        Most memory for finished and interrupted results, in bytes.
    most_orbits
        Of all large jobs under way together, which bounds the memory that they hold, by about 120 bytes an orbit.
    threads
        Of a pool of its own; None for that of this process.
    only_idle
        Whether that pool of its own takes no more than what the processors have left (`thread_pool`).
    """

    def __init__(
        self,
        executor: Executor | None = None,
        cache_bytes: int = DEFAULT_CACHE_BYTES,
        most_orbits: int = DEFAULT_ORBITS,
        threads: int | None = None,
        only_idle: bool = False,
    ) -> None:
        self._executor = executor
        self._pool = FairScheduler(None if threads is None else thread_pool(threads, only_idle=only_idle))
        self._room = OrbitSemaphore(most_orbits)
        self._ended = dict.fromkeys(_End, 0)
        self._coordinators = ThreadPoolExecutor(_COORDINATORS, thread_name_prefix="jobs")
        self._lock = threading.RLock()
        self._in_flight: dict[Hashable, _Job] = {}
        self.cache = ResultCache(cache_bytes)

    def request_map(
        self,
        spec: MapSpec,
        on_frame: Callable[[EscapeMap], None],
        on_error: Callable[[Exception], None],
        *,
        owner: Hashable = None,
    ) -> Subscription:
        """Ask for a map; frames come to `on_frame` from another thread, the last one with ``complete`` True.

        A map that is kept comes at once; one that somebody already waits for is shared; one that was interrupted, or is kept
        to a shorter t_max, goes on from there. All jobs of an `owner` together have one turn in each round; the first frame of
        every map comes before the second one of any.
        """

        def run(bench: JobContext) -> EscapeMap:
            return self._compute_map(spec, bench, bench.publish)

        return self._request(spec, on_frame, on_error, run, owner, interactive=True)

    def request[Result: Sized](
        self,
        spec: JobRequest[Result],
        on_result: Callable[[Result], None],
        on_error: Callable[[Exception], None],
        *,
        owner: Hashable = None,
    ) -> Subscription:
        """Ask for anything else (`engine.jobs.requests`); it comes to `on_result` from another thread.

        What grows as it is computed comes more than once, the last time with ``complete`` True.
        """
        return self._request(spec, on_result, on_error, spec.run, owner, interactive=False)

    @property
    def in_flight(self) -> int:
        """Number of jobs under way."""
        return len(self._in_flight)

    def figures(self) -> JobStats:
        """How busy this is, and has been."""
        done, failed, cancelled = (self._ended[end] for end in _End)
        return JobStats(
            in_flight=self.in_flight,
            calls_waiting=self._pool.waiting,
            done=done,
            failed=failed,
            cancelled=cancelled,
            cache_bytes=self.cache.nbytes,
            cache_limit=self.cache.limit,
            orbits_held=self._room.taken,
            orbits_limit=self._room.orbits,
            threads=count_workers(self._executor) if self._executor is not None else self._pool.threads,
        )

    def put_off_tiles(self, put_off: bool) -> None:
        """Whether what makes pictures finer, and quick looks, wait, however long; first frames and orbits do not."""
        self._pool.put_off_tiles(put_off)

    def stop(self) -> None:
        """Stop all jobs, within about 0.2 s; those who wait for them hear nothing any more."""
        with self._lock:
            tickets = [ticket for job in self._in_flight.values() for ticket in job.tickets]
        for ticket in tickets:
            ticket.cancel()

    def _request(
        self,
        key: Hashable,
        on_result: Callable[[Any], None],
        on_error: Callable[[Exception], None],
        run: Callable[[JobContext], Sized],
        owner: Hashable,
        interactive: bool,
    ) -> Subscription:
        ticket = Subscription(lambda ticket: self._leave(key, ticket), on_result, on_error)
        with self._lock:
            kept = self.cache.get(key)
            whole = kept is not None and getattr(kept, "complete", True)
            if whole:
                latest = kept
            elif key in self._in_flight:
                self._in_flight[key].tickets.append(ticket)
                latest = self._in_flight[key].latest
            else:
                latest = None
                job = self._in_flight[key] = _Job(key, [ticket], owner, interactive)
                self._coordinators.submit(self._work, job, run)
        if latest is not None:
            ticket.deliver(latest, last=whole)
        return ticket

    def _leave(self, key: Hashable, ticket: Subscription) -> None:
        with self._lock:
            job = self._in_flight.get(key)
            if job is None or ticket not in job.tickets:
                return
            job.tickets.remove(ticket)
            if not job.tickets:
                job.stop()
                del self._in_flight[key]

    def _work(self, job: _Job, run: Callable[[JobContext], Sized]) -> None:
        error: Exception | None = None
        result: Sized | None = None
        try:
            with self._room.hold(_count_orbits(job.key), job.cancel):
                if not job.cancel.is_set():
                    result = run(self._bench(job))
        except CancelledError:
            pass
        except Exception as raised:
            log.info("job %s ended with %r", job.key, raised)
            error = raised
        with self._lock:
            if result is not None and not _is_less_than_kept(result, self.cache.get(job.key)):
                self.cache.put(job.key, result)
            if self._in_flight.get(job.key) is job:
                del self._in_flight[job.key]
            tickets = job.empty()
            self._ended[_End.FAILED if error else _End.CANCELLED if job.cancel.is_set() else _End.DONE] += 1
        for ticket in tickets:
            if error is not None:
                ticket.fail(error)
            elif result is not None:
                ticket.deliver(result, last=True)

    def _bench(self, job: _Job) -> JobContext:
        job.lines = [self._pool.line(job.owner, rank) for rank in (job.rank, lambda: Priority.WHOLE)]
        tiles, calls = (self._executor or line for line in job.lines)
        return JobContext(tiles, calls, job.cancel, partial(self._publish, job), self._find_map, self._find_answer)

    def _find_answer(self, bench: JobContext, spec: JobRequest[Any]) -> Any:
        kept = self.cache.get(spec)
        if kept is None or not getattr(kept, "complete", True):
            kept = spec.run(bench)
            self.cache.put(spec, kept)
        return kept

    def _find_map(self, bench: JobContext, spec: MapSpec) -> EscapeMap | None:
        whole: EscapeMap | None = self.cache.get(spec)
        if whole is None or not whole.complete:
            whole = self._compute_map(spec, bench, on_frame=None)
        return whole if whole.complete else None

    def _compute_map(self, spec: MapSpec, bench: JobContext, on_frame: Callable[[EscapeMap], None] | None) -> EscapeMap:
        return compute_map(spec, on_frame, bench.cancel, bench.executor, resume=self._find_resumable(spec))

    def _publish(self, job: _Job, frame: Any) -> None:
        """Hand a frame on; the complete one is the result, which follows at once with all that belongs to it."""
        if frame.complete:
            return
        with self._lock:
            job.latest = frame
            tickets = list(job.tickets)
        for ticket in tickets:
            ticket.deliver(frame, last=False)

    def _find_resumable(self, spec: MapSpec) -> EscapeMap | None:
        """The kept map of the same picture that has been followed longest, though not beyond t_max."""
        with self._lock:
            # By energy first, as there may be thousands of others.
            alike = [key for key in self.cache if isinstance(key, MapSpec) and key.energy == spec.energy]
            candidates = [key for key in alike if replace(key, t_max=spec.t_max) == spec]
            earlier = [key for key in candidates if key.t_max <= spec.t_max]
            kept = self.cache.get(max(earlier, key=lambda key: key.t_max)) if earlier else None
            return kept if kept is not None and kept.batch is not None else None


def _is_less_than_kept(result: Sized, kept: Any) -> bool:
    """An interrupted result never replaces a finished one."""
    return kept is not None and getattr(kept, "complete", True) and not getattr(result, "complete", True)


def _count_orbits(spec: Any) -> int:
    """How many orbits the job holds at the same time: those of its map, when it has one."""
    map_spec = getattr(spec, "map_spec", spec)
    if not isinstance(map_spec, MapSpec):
        return 0
    columns, rows = map_spec.resolution
    return min(columns * rows, LARGEST_RUN)
