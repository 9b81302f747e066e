"""Requests from many people to one pool: in the background, shared while in flight, cancellable, kept in bounded memory."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Hashable
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Protocol

from engine.bench import Bench
from engine.escape_maps import EscapeMap
from engine.map_specs import MapSpec
from engine.maps import compute_map
from engine.result_cache import ResultCache, Sized

DEFAULT_CACHE_BYTES = 512 * 2**20
# Threads that only wait for the pool and hand frames on; more jobs than this wait for their turn.
_COORDINATORS = 32

log = logging.getLogger(__name__)


class JobSpec[Result: Sized](Protocol):
    """A request that knows how it is answered."""

    def __hash__(self) -> int: ...

    def run(self, bench: Bench) -> Result:
        """The answer."""


class Ticket:
    """One person's claim on a job. Cancelling it stops the job when nobody else waits for it."""

    def __init__(
        self, release: Callable[[Ticket], None], on_result: Callable[[Any], None], on_error: Callable[[Exception], None]
    ):
        self._release = release
        self._on_result = on_result
        self._on_error = on_error
        self._open = True

    def cancel(self) -> None:
        """Hear no more of it; at once, and as often as you like."""
        self._open = False
        self._release(self)

    def deliver(self, result: Any) -> None:
        """Hand a frame or a result over, unless cancelled."""
        self._call(self._on_result, result)

    def fail(self, error: Exception) -> None:
        """Hand over what went wrong, unless cancelled."""
        self._call(self._on_error, error)

    def _call(self, receive: Callable[[Any], None], what: Any) -> None:
        if not self._open:
            return
        try:
            receive(what)
        except Exception:
            # One listener's fault is no other listener's.
            log.exception("a listener failed")


@dataclass(eq=False)
class _Job:
    key: Hashable
    tickets: list[Ticket]
    cancel: threading.Event = field(default_factory=threading.Event)
    latest: Any = None


class Jobs:
    """The background work of a process.

    Parameters
    ----------
    executor
        Any `concurrent.futures.Executor` for the computing; None for the pool of this process.
    cache_bytes
        Most memory for finished and interrupted results, in bytes.
    """

    def __init__(self, executor: Executor | None = None, cache_bytes: int = DEFAULT_CACHE_BYTES) -> None:
        self._executor = executor
        self._coordinators = ThreadPoolExecutor(_COORDINATORS, thread_name_prefix="jobs")
        self._lock = threading.RLock()
        self._in_flight: dict[Hashable, _Job] = {}
        self.cache = ResultCache(cache_bytes)

    def request_map(self, spec: MapSpec, on_frame: Callable[[EscapeMap], None], on_error: Callable[[Exception], None]) -> Ticket:
        """Ask for a map; frames come to `on_frame` from another thread, the last one with ``complete`` True.

        A map that is kept comes at once; one that somebody already waits for is shared; one that was interrupted, or is kept
        to a shorter t_max, goes on from there.
        """
        return self._request(spec, on_frame, on_error, lambda bench: self._compute_map(spec, bench.publish, bench.cancel))

    def request[Result: Sized](
        self, spec: JobSpec[Result], on_result: Callable[[Result], None], on_error: Callable[[Exception], None]
    ) -> Ticket:
        """Ask for anything else (`engine.job_specs`); it comes to `on_result` from another thread.

        What grows as it is computed comes more than once, the last time with ``complete`` True.
        """
        return self._request(spec, on_result, on_error, spec.run)

    @property
    def in_flight(self) -> int:
        """Number of jobs under way."""
        return len(self._in_flight)

    def _request(
        self,
        key: Hashable,
        on_result: Callable[[Any], None],
        on_error: Callable[[Exception], None],
        run: Callable[[Bench], Sized],
    ) -> Ticket:
        ticket = Ticket(lambda ticket: self._leave(key, ticket), on_result, on_error)
        with self._lock:
            kept = self.cache.get(key)
            if kept is not None and getattr(kept, "complete", True):
                latest = kept
            elif key in self._in_flight:
                self._in_flight[key].tickets.append(ticket)
                latest = self._in_flight[key].latest
            else:
                latest = None
                job = self._in_flight[key] = _Job(key, [ticket])
                self._coordinators.submit(self._work, job, run)
        if latest is not None:
            ticket.deliver(latest)
        return ticket

    def _leave(self, key: Hashable, ticket: Ticket) -> None:
        with self._lock:
            job = self._in_flight.get(key)
            if job is None or ticket not in job.tickets:
                return
            job.tickets.remove(ticket)
            if not job.tickets:
                job.cancel.set()
                del self._in_flight[key]

    def _work(self, job: _Job, run: Callable[[Bench], Sized]) -> None:
        error: Exception | None = None
        result: Sized | None = None
        try:
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
            tickets = list(job.tickets)
        for ticket in tickets:
            if error is not None:
                ticket.fail(error)
            elif result is not None:
                ticket.deliver(result)

    def _bench(self, job: _Job) -> Bench:
        def answer(spec: JobSpec[Any]) -> Any:
            kept = self.cache.get(spec)
            if kept is None or not getattr(kept, "complete", True):
                kept = spec.run(bench)
                self.cache.put(spec, kept)
            return kept

        publish, map_at_hand = partial(self._publish, job), partial(self._map_at_hand, cancel=job.cancel)
        bench = Bench(self._executor, job.cancel, publish, map_at_hand, answer)
        return bench

    def _map_at_hand(self, spec: MapSpec, cancel: threading.Event) -> EscapeMap | None:
        """The finished map, for a job that needs it; None when cancelled."""
        whole: EscapeMap | None = self.cache.get(spec)
        if whole is None or not whole.complete:
            whole = self._compute_map(spec, None, cancel)
        return whole if whole.complete else None

    def _compute_map(self, spec: MapSpec, on_frame: Callable[[EscapeMap], None] | None, cancel: threading.Event) -> EscapeMap:
        return compute_map(spec, on_frame, cancel, self._executor, resume=self._find_resumable(spec))

    def _publish(self, job: _Job, frame: Any) -> None:
        """Hand a frame on; the complete one is the result, which follows at once with all that belongs to it."""
        if frame.complete:
            return
        with self._lock:
            job.latest = frame
            tickets = list(job.tickets)
        for ticket in tickets:
            ticket.deliver(frame)

    def _find_resumable(self, spec: MapSpec) -> EscapeMap | None:
        """The kept map of the same picture that has been followed longest, though not beyond t_max."""
        with self._lock:
            candidates = [key for key in self.cache if isinstance(key, MapSpec) and replace(key, t_max=spec.t_max) == spec]
            earlier = [key for key in candidates if key.t_max <= spec.t_max]
            kept = self.cache.get(max(earlier, key=lambda key: key.t_max)) if earlier else None
            return kept if kept is not None and kept.batch is not None else None


def _is_less_than_kept(result: Sized, kept: Any) -> bool:
    """An interrupted result never replaces a finished one."""
    return kept is not None and getattr(kept, "complete", True) and not getattr(result, "complete", True)
