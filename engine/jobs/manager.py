"""Job manager: background computations that are shared while in flight, cancellable, and cached in bounded memory."""

from __future__ import annotations

import logging
import threading
from collections import Counter
from collections.abc import Callable, Hashable
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from engine.execution import count_workers, create_thread_pool, is_cancelled, raise_if_cancelled
from engine.jobs.cache import ResultCache, SupportsNbytes
from engine.jobs.context import JobContext, JobRequest
from engine.jobs.map_priority import MapPriority
from engine.jobs.orbit_semaphore import OrbitSemaphore
from engine.jobs.scheduler import FairScheduler, Priority, QueueExecutor
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.sweeps.complete_map import require_complete

DEFAULT_CACHE_BYTES = 512 * 2**20
"""Default memory limit of cached results, in bytes."""

DEFAULT_ORBITS = 4 * 2**20
"""Default limit on the orbits of large running jobs; about 500 MiB."""

# Coordinating threads mostly wait for the pool; further jobs are queued.
_COORDINATORS = 1024

log = logging.getLogger(__name__)


@dataclass(eq=False)
class _Job:
    key: Hashable
    subscriptions: list[Subscription]
    client: Hashable
    map_priority: MapPriority | None
    """Of a map that is shown; all calls of other jobs are in the background."""
    cancel: threading.Event = field(default_factory=threading.Event)
    latest: Any = None
    """The last partial result."""
    executors: list[QueueExecutor] = field(default_factory=list)

    def stop(self) -> None:
        """Cancel the job and its queued calls."""
        self.cancel.set()
        for executor in self.executors:
            executor.cancel_futures()

    def release(self) -> list[Subscription]:
        """Drop all references, so that reference counting alone frees the memory, and return the subscriptions."""
        subscriptions, self.subscriptions, self.executors, self.latest = self.subscriptions, [], [], None
        return subscriptions

    def priority(self) -> Priority:
        return Priority.BACKGROUND if self.map_priority is None else self.map_priority()


class Jobs:
    """Job manager of a process.

    Parameters
    ----------
    executor
        Any `concurrent.futures.Executor` for the computations; None for a thread pool that is scheduled fairly among clients.
    cache_bytes
        Memory limit of complete and interrupted results, in bytes.
    most_orbits
        Most orbits of all large running jobs together, at about 120 bytes per orbit.
    threads
        Size of a thread pool of its own; None for the default pool of this process.
    idle_priority
        Whether that pool of its own runs on idle cores only; see `engine.execution.create_thread_pool`.
    """

    def __init__(
        self,
        executor: Executor | None = None,
        cache_bytes: int = DEFAULT_CACHE_BYTES,
        most_orbits: int = DEFAULT_ORBITS,
        threads: int | None = None,
        idle_priority: bool = False,
    ) -> None:
        self._executor = executor
        self._scheduler = FairScheduler(None if threads is None else create_thread_pool(threads, idle_priority=idle_priority))
        # Numba compiles one function at a time: more threads would only wait for each other, and orbits for all of them.
        self._compilations = FairScheduler(create_thread_pool(1, idle_priority=idle_priority))
        self._semaphore = OrbitSemaphore(most_orbits)
        self._ended: Counter[str] = Counter()
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
        client: Hashable = None,
    ) -> Subscription:
        """Request a map.

        A cached map is delivered at once, a map in flight is shared, and an interrupted map, or one with a shorter t_max, is
        resumed.

        Parameters
        ----------
        spec
            The map.
        on_frame
            Called from another thread with each frame; the last one has ``complete`` True.
        on_error
            Called from another thread with the exception if the computation fails.
        client
            Identifies the client for fair scheduling: clients are served in turn, and the first frame of every map comes before
            the second frame of any.
        """

        def run(context: JobContext) -> EscapeMap:
            return self._compute_map(spec, context, context.publish)

        return self._request(spec, on_frame, on_error, run, client, MapPriority())

    def request[Result: SupportsNbytes](
        self,
        spec: JobRequest[Result],
        on_result: Callable[[Result], None],
        on_error: Callable[[Exception], None],
        *,
        client: Hashable = None,
    ) -> Subscription:
        """Request any other result; see `engine.jobs.requests`.

        Parameters
        ----------
        spec
            The request.
        on_result
            Called from another thread with the result; if it has an attribute ``complete``, partial results come before.
        on_error, client
            As in `request_map`.
        """
        return self._request(spec, on_result, on_error, spec.run, client, None)

    @property
    def in_flight(self) -> int:
        """Number of running and queued jobs."""
        return len(self._in_flight)

    def stats(self) -> JobStats:
        """Return the current load, totals and memory."""
        return JobStats(
            in_flight=self.in_flight,
            calls_waiting=self._scheduler.pending_calls,
            done=self._ended["done"],
            failed=self._ended["failed"],
            cancelled=self._ended["cancelled"],
            cache_bytes=self.cache.nbytes,
            cache_limit=self.cache.limit,
            orbits_held=self._semaphore.held,
            orbits_limit=self._semaphore.limit,
            threads=count_workers(self._executor) if self._executor is not None else self._scheduler.threads,
        )

    def take_first_frame_wait(self) -> float:
        """Longest recent wait of a first frame for a thread; see `FairScheduler.take_first_frame_wait`."""
        return self._scheduler.take_first_frame_wait()

    def pause_background(self, paused: bool) -> None:
        """Pause or resume everything but first frames and long calls; see `FairScheduler.pause_background`."""
        self._scheduler.pause_background(paused)
        self._compilations.pause_background(paused)

    def stop(self) -> None:
        """Cancel all jobs and subscriptions; the computations end within about 0.2 s."""
        with self._lock:
            subscriptions = [subscription for job in self._in_flight.values() for subscription in job.subscriptions]
        for subscription in subscriptions:
            subscription.cancel()

    def _request(
        self,
        key: Hashable,
        on_result: Callable[[Any], None],
        on_error: Callable[[Exception], None],
        run: Callable[[JobContext], SupportsNbytes],
        client: Hashable,
        map_priority: MapPriority | None,
    ) -> Subscription:
        subscription = Subscription(partial(self._unsubscribe, key), on_result, on_error)
        with self._lock:
            cached = self.cache.get(key)
            complete = _is_complete(cached)
            if complete:
                latest = cached
            elif key in self._in_flight:
                self._in_flight[key].subscriptions.append(subscription)
                latest = self._in_flight[key].latest
            else:
                latest = None
                job = self._in_flight[key] = _Job(key, [subscription], client, map_priority)
                self._coordinators.submit(self._run_job, job, run)
        if latest is not None:
            subscription.deliver(latest, last=complete)
        return subscription

    def _unsubscribe(self, key: Hashable, subscription: Subscription) -> None:
        with self._lock:
            job = self._in_flight.get(key)
            if job is None or subscription not in job.subscriptions:
                return
            job.subscriptions.remove(subscription)
            if not job.subscriptions:
                job.stop()
                del self._in_flight[key]

    def _run_job(self, job: _Job, run: Callable[[JobContext], SupportsNbytes]) -> None:
        error: Exception | None = None
        result: SupportsNbytes | None = None
        try:
            with self._semaphore.acquire(_count_orbits(job.key), job.cancel):
                raise_if_cancelled(job.cancel)
                result = run(self._context(job))
        except CancelledError:
            pass
        except Exception as raised:
            log.info("job %s ended with %r", job.key, raised)
            error = raised
        for subscription in self._finish(job, result, error):
            if error is not None:
                subscription.fail(error)
            elif result is not None:
                subscription.deliver(result, last=True)

    def _finish(self, job: _Job, result: SupportsNbytes | None, error: Exception | None) -> list[Subscription]:
        """Cache the result, remove the job and return its subscriptions."""
        with self._lock:
            # An interrupted result must not replace a complete one.
            if result is not None and (_is_complete(result) or not _is_complete(self.cache.get(job.key))):
                self.cache.put(job.key, result)
            if self._in_flight.get(job.key) is job:
                del self._in_flight[job.key]
            self._ended["failed" if error else "cancelled" if is_cancelled(job.cancel) else "done"] += 1
            return job.release()

    def _context(self, job: _Job) -> JobContext:
        job.executors = [
            self._scheduler.executor(job.client, job.priority),
            self._scheduler.executor(job.client, lambda: Priority.LONG_CALL),
            self._compilations.executor(job.client, lambda: Priority.LONG_CALL),
        ]
        calls, long_calls, compilations = (self._executor or executor for executor in job.executors)
        publish = partial(self._publish, job)
        return JobContext(calls, long_calls, compilations, job.cancel, publish, self._find_map, self._find_result)

    def _find_result(self, context: JobContext, request: JobRequest[Any]) -> Any:
        result = self.cache.get(request)
        if not _is_complete(result):
            result = request.run(context)
            self.cache.put(request, result)
        return result

    def _find_map(self, context: JobContext, spec: MapSpec) -> EscapeMap:
        cached: EscapeMap | None = self.cache.get(spec)
        if cached is not None and cached.complete:
            return cached
        return require_complete(self._compute_map(spec, context, on_frame=None))

    def _compute_map(self, spec: MapSpec, context: JobContext, on_frame: Callable[[EscapeMap], None] | None) -> EscapeMap:
        return compute_map(spec, on_frame, context.cancel, context.executor, resume=self._find_resumable(spec))

    def _publish(self, job: _Job, result: Any) -> None:
        """Deliver a partial result. A complete one is left to `_run_job`, which delivers it with all its data."""
        if result.complete:
            return
        with self._lock:
            job.latest = result
            if job.map_priority is not None:
                job.map_priority.add_frame(result.horizon)
            subscriptions = list(job.subscriptions)
        for subscription in subscriptions:
            subscription.deliver(result, last=False)

    def _find_resumable(self, spec: MapSpec) -> EscapeMap | None:
        """Return the cached map that differs from `spec` by the smallest reduction of t_max and can be resumed, or None."""
        with self._lock:
            # Compare energies first: cheap, and there may be thousands of maps.
            same_energy = [key for key in self.cache if isinstance(key, MapSpec) and key.energy == spec.energy]
            shorter = [key for key in same_energy if key.t_max <= spec.t_max and replace(key, t_max=spec.t_max) == spec]
            cached = self.cache.get(max(shorter, key=lambda key: key.t_max)) if shorter else None
            return cached if cached is not None and cached.batch is not None else None


def _is_complete(result: Any) -> bool:
    """Whether there is a result and it is final; only results that grow have an attribute ``complete``."""
    return result is not None and getattr(result, "complete", True)


def _count_orbits(spec: Any) -> int:
    """Number of orbits that a job holds in memory: those of its map, or 0 without one."""
    map_spec = getattr(spec, "map_spec", spec)
    if not isinstance(map_spec, MapSpec):
        return 0
    columns, rows = map_spec.resolution
    return min(columns * rows, LARGEST_RUN)
