"""Requests from many people to one pool: in the background, shared while in flight, cancellable, kept in bounded memory."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Hashable
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from engine.escape_maps import EscapeMap
from engine.job_specs import OrbitSpec, Preview, PreviewSpec, RegularitySpec, SeparationSpec, TwinAnswer, TwinSpec
from engine.map_specs import MapSpec
from engine.maps import compute_map
from engine.orbit_batches import default_executor
from engine.orbits import Orbit, integrate_orbit
from engine.previews import compute_preview, preview_spec
from engine.regularity_maps import RegularityMap, judge_bounded_orbits
from engine.result_cache import ResultCache, Sized
from engine.separations import Separation, compute_separation
from engine.twins import Twin, find_twin

DEFAULT_CACHE_BYTES = 512 * 2**20
# Threads that only wait for the pool and hand frames on; more jobs than this wait for their turn.
_COORDINATORS = 32

log = logging.getLogger(__name__)


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
        return self._request(spec, on_frame, on_error, self._run_map)

    def request_preview(
        self, spec: MapSpec, on_preview: Callable[[EscapeMap], None], on_error: Callable[[Exception], None]
    ) -> Ticket:
        """Ask for a quick look at a map (`compute_preview`); it comes to `on_preview` from another thread, once."""
        return self._request(PreviewSpec(preview_spec(spec)), lambda kept: on_preview(kept.frame), on_error, self._run_preview)

    def request_orbit(self, spec: OrbitSpec, on_orbit: Callable[[Orbit], None], on_error: Callable[[Exception], None]) -> Ticket:
        """Ask for an orbit; it comes to `on_orbit` from another thread."""
        return self._request(spec, on_orbit, on_error, self._run_orbit)

    def request_twin(
        self, spec: TwinSpec, on_twin: Callable[[Twin | None], None], on_error: Callable[[Exception], None]
    ) -> Ticket:
        """Ask for the nearest start that leaves elsewhere; it comes to `on_twin` from another thread, None if there is none."""
        return self._request(spec, lambda answer: on_twin(answer.twin), on_error, self._run_twin)

    def request_separation(
        self, spec: SeparationSpec, on_separation: Callable[[Separation], None], on_error: Callable[[Exception], None]
    ) -> Ticket:
        """Ask how two orbits part; it comes to `on_separation` from another thread."""
        return self._request(spec, on_separation, on_error, self._run_separation)

    def request_regularity(
        self, spec: MapSpec, on_frame: Callable[[RegularityMap], None], on_error: Callable[[Exception], None]
    ) -> Ticket:
        """Ask which bounded orbits of a map are chaotic; the map itself is computed first where it is not kept."""
        return self._request(RegularitySpec(spec), on_frame, on_error, self._run_regularity)

    @property
    def in_flight(self) -> int:
        """Number of jobs under way."""
        return len(self._in_flight)

    def _request(
        self,
        key: Hashable,
        on_result: Callable[[Any], None],
        on_error: Callable[[Exception], None],
        run: Callable[[_Job], Sized],
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

    def _work(self, job: _Job, run: Callable[[_Job], Sized]) -> None:
        error: Exception | None = None
        result: Sized | None = None
        try:
            if not job.cancel.is_set():
                result = run(job)
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

    def _run_map(self, job: _Job) -> EscapeMap:
        spec = job.key
        assert isinstance(spec, MapSpec)

        publish = partial(self._publish, job)
        return compute_map(spec, publish, job.cancel, self._executor, resume=self._find_resumable(spec))

    def _run_separation(self, job: _Job) -> Separation:
        spec = job.key
        assert isinstance(spec, SeparationSpec)
        return self._on_pool(job, compute_separation, spec.potential, spec.first, spec.second, spec.t_end)

    def _run_preview(self, job: _Job) -> Preview:
        assert isinstance(job.key, PreviewSpec)
        frame = compute_preview(job.key.map_spec, self._executor, job.cancel)
        if job.cancel.is_set():
            raise CancelledError
        return Preview(frame)

    def _run_regularity(self, job: _Job) -> RegularityMap:
        assert isinstance(job.key, RegularitySpec)
        spec = job.key.map_spec
        whole = self.cache.get(spec)
        if whole is None or not whole.complete:
            whole = compute_map(spec, None, job.cancel, self._executor, resume=self._find_resumable(spec))
        if not whole.complete:
            raise CancelledError
        return judge_bounded_orbits(whole, partial(self._publish, job), job.cancel, self._executor)

    def _publish(self, job: _Job, frame: EscapeMap | RegularityMap) -> None:
        """Hand a frame on; the complete one is the result, which follows at once with all that belongs to it."""
        if frame.complete:
            return
        with self._lock:
            job.latest = frame
            tickets = list(job.tickets)
        for ticket in tickets:
            ticket.deliver(frame)

    def _run_orbit(self, job: _Job) -> Orbit:
        spec = job.key
        assert isinstance(spec, OrbitSpec)
        return self._on_pool(job, integrate_orbit, spec.potential, spec.state, spec.t_max)

    def _on_pool[Result](self, job: _Job, compute: Callable[..., Result], *arguments: Any) -> Result:
        """What one call comes to, made by a thread that is there for computing."""
        executor = self._executor or default_executor()
        return executor.submit(compute, *arguments, cancel=job.cancel).result()

    def _run_twin(self, job: _Job) -> TwinAnswer:
        spec = job.key
        assert isinstance(spec, TwinSpec)
        start = (spec.x, spec.ordinate, spec.t_max)
        return TwinAnswer(find_twin(spec.potential, spec.plane, spec.energy, *start, executor=self._executor, cancel=job.cancel))

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
