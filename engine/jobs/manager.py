"""The job manager. Background computations are shared while in flight, can be cancelled, and are cached in bounded memory.

The function of a job either submits many short calls, or is itself one long call (`Queue`).
"""

from __future__ import annotations

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable, Hashable, Mapping
from concurrent.futures import CancelledError, Executor, ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from engine.foundations.execution import Execution, count_workers, create_thread_pool
from engine.integrator.jit.compiled_operations import charged_to
from engine.jobs.cache import ABSENT, ResultCache
from engine.jobs.job import Job, Queue
from engine.jobs.map_priority import MapPriority
from engine.jobs.orbit_semaphore import OrbitSemaphore
from engine.jobs.scheduler import Clock, FairScheduler, Priority, QueueExecutor
from engine.jobs.stats import JobStats
from engine.jobs.subscription import Subscription

DEFAULT_CACHE_BYTES = 512 * 2**20
"""Default memory limit of cached results, in bytes."""

DEFAULT_MOST_ORBITS = 2 * 2**20
"""Default limit on the number of orbits of all large running jobs. This many orbits take about 250 MiB."""

# Number of coordinating threads, one for each running job. They mostly wait for the executor. Further jobs are queued.
_COORDINATING_THREADS = 1024

log = logging.getLogger(__name__)


@dataclass(eq=False)
class _Run:
    """A job that is queued or running."""

    job: Job[Any]
    subscriptions: list[Subscription]
    client: Hashable
    account: Hashable
    map_priority: MapPriority | None
    """Priority of a map on display; None for other jobs."""
    cancel: threading.Event = field(default_factory=threading.Event)
    partial_result: Any = None
    """The last partial result."""
    executors: Mapping[Queue, QueueExecutor] = field(default_factory=dict)

    def stop(self) -> None:
        """Cancel the job and its queued calls."""
        self.cancel.set()
        for executor in self.executors.values():
            executor.cancel_futures()

    def release(self) -> list[Subscription]:
        """Return the subscriptions, and drop all references so that reference counting alone frees the memory."""
        subscriptions = self.subscriptions
        self.subscriptions, self.executors, self.partial_result = [], {}, None
        return subscriptions

    def priority(self) -> Priority:
        """Return the priority of the short calls."""
        if self.map_priority is not None:
            return self.map_priority()
        return Priority.UNSETTLED if self.job.queue is Queue.SPARE else Priority.BACKGROUND


class Jobs:
    """Manages the jobs of a process.

    Parameters
    ----------
    executor
        Executor of the computations; None for a thread pool that is scheduled fairly among clients.
    cache_bytes
        Memory limit of complete and interrupted results, in bytes.
    most_orbits
        Largest number of orbits of all large running jobs together, at about 120 bytes per orbit.
    threads
        Number of threads of the manager's own pool, at least 1; None for the default pool of this process.
    run_limited
        Runs a function in a resource-limited process, which it ends when the event is set; None for a thread of this process.
    most_limited_calls
        Largest number of calls of `run_limited` at a time, each for a different account.
    clock
        The clock; by default the clock of this process.

    Attributes
    ----------
    cache
        The complete and interrupted results.
    """

    def __init__(
        self,
        executor: Executor | None = None,
        cache_bytes: int = DEFAULT_CACHE_BYTES,
        most_orbits: int = DEFAULT_MOST_ORBITS,
        threads: int | None = None,
        run_limited: Callable[[Callable[[], Any], threading.Event], Any] | None = None,
        most_limited_calls: int = 1,
        clock: Clock = time,
    ) -> None:
        self._executor = executor
        self._run_limited = run_limited
        self._clock = clock
        self._scheduler = FairScheduler(None if threads is None else create_thread_pool(threads), clock)
        # Numba compiles one function at a time, so more threads would only wait for each other.
        self._compilations = FairScheduler(create_thread_pool(1), clock)
        self._limited_calls = FairScheduler(create_thread_pool(most_limited_calls), clock, one_call_per_client=True)
        self._semaphore = OrbitSemaphore(most_orbits)
        # Number of ended jobs by outcome.
        self._ended: Counter[str] = Counter()
        self._coordinators = ThreadPoolExecutor(_COORDINATING_THREADS, thread_name_prefix="jobs")
        self._lock = threading.RLock()
        self._runs: dict[Job[Any], _Run] = {}
        self.cache = ResultCache(cache_bytes)

    def request[Result](
        self,
        job: Job[Result],
        on_result: Callable[[Result], None],
        on_error: Callable[[Exception], None],
        *,
        client: Hashable = None,
        account: Hashable = None,
    ) -> Subscription:
        """Request the result of a job.

        A cached result is delivered at once, and an equal job that is under way is shared.

        Parameters
        ----------
        job
            The job.
        on_result
            Called with the result and, if results have an attribute ``complete``, with partial results: in this thread with
            results that exist already, otherwise from another thread.
        on_error
            Called from another thread with the exception if the computation fails.
        client
            Identifies the client for fair scheduling: clients are served in turn, and the first frame of every map comes before
            the second frame of any map.
        account
            The account that is charged for the code that the job compiles. Accounts are served in turn, and the clients of an
            account in turn within it. Without an account, nothing is charged, and the client has its own turn.

        Returns
        -------
        The subscription. Cancel it when the result is no longer wanted: a job without subscriptions is stopped.
        """
        subscription = Subscription(partial(self._unsubscribe, job), on_result, on_error)
        with self._lock:
            cached_result = self.cache.get(job, ABSENT)
            is_complete = _is_complete(cached_result)
            partial_result: Any = None
            if not is_complete and job in self._runs:
                run = self._runs[job]
                run.subscriptions.append(subscription)
                partial_result = run.partial_result
            elif not is_complete:
                is_map = job.queue is Queue.FIRST_FRAME
                priority = MapPriority(lambda: self._scheduler.first_frames_preferred, self._clock) if is_map else None
                run = self._runs[job] = _Run(job, [subscription], client, account, priority)
                self._coordinators.submit(self._run_job, run)
        if is_complete:
            subscription.deliver(cached_result, last=True)
        elif partial_result is not None:
            subscription.deliver(partial_result, last=False)
        return subscription

    @property
    def in_flight(self) -> int:
        """Number of running and queued jobs."""
        return len(self._runs)

    def stats(self) -> JobStats:
        """Return the current load, totals and memory."""
        return JobStats(
            in_flight=self.in_flight,
            calls_waiting=sum(each.pending_calls for each in (self._scheduler, self._compilations, self._limited_calls)),
            limited_calls_waiting=self._limited_calls.pending_calls,
            done=self._ended["done"],
            failed=self._ended["failed"],
            cancelled=self._ended["cancelled"],
            cache_bytes=self.cache.nbytes,
            cache_limit=self.cache.limit,
            orbits_held=self._semaphore.held,
            orbits_limit=self._semaphore.limit,
            threads=count_workers(self._executor) if self._executor is not None else self._scheduler.threads,
            processor_time=sum(each.processor_time for each in (self._scheduler, self._compilations)),
        )

    def prefer_first_frames(self, preferred: bool) -> None:
        """Start or end the preference for first frames, see `FairScheduler.prefer_first_frames`."""
        self._scheduler.prefer_first_frames(preferred)

    def pause_background(self, paused: bool) -> None:
        """Pause or resume background calls, and slow down long calls and compilations; see `FairScheduler.pause_background`."""
        self._scheduler.pause_background(paused)
        self._compilations.pause_background(paused)

    def stop(self) -> None:
        """Cancel all jobs and subscriptions; the computations end within about 0.2 s."""
        with self._lock:
            subscriptions = [subscription for run in self._runs.values() for subscription in run.subscriptions]
        for subscription in subscriptions:
            subscription.cancel()

    def _unsubscribe(self, job: Job[Any], subscription: Subscription) -> None:
        """Remove a subscription; a job without subscriptions is stopped."""
        with self._lock:
            run = self._runs.get(job)
            if run is None or subscription not in run.subscriptions:
                return
            run.subscriptions.remove(subscription)
            if not run.subscriptions:
                run.stop()
                del self._runs[job]

    def _run_job(self, run: _Run) -> None:
        """Compute a job, and deliver its result or its error; a coordinating thread calls this."""
        error: Exception | None = None
        result: Any = ABSENT
        try:
            execution = Execution(cancel=run.cancel)
            with self._semaphore.acquire(run.job.orbits_held, execution), charged_to(run.account):
                execution.raise_if_cancelled()
                run.executors = self._create_executors(run)
                result = self._call_function(run.job, run, partial(self._publish, run))
        except CancelledError:
            pass
        except Exception as raised:
            log.info("job %s ended with %r", run.job, raised)
            error = raised
        for subscription in self._finish(run, result, error):
            if error is not None:
                subscription.fail(error)
            elif result is not ABSENT:
                subscription.deliver(result, last=True)

    def _call_function(self, job: Job[Any], run: _Run, publish: Callable[[Any], None] | None) -> Any:
        """Call the function of the job of a run, or of a job whose result that job needs. `publish` receives partial results."""
        arguments = [self._find_result(run, value) if isinstance(value, Job) else value for value in job.arguments]
        executors: Mapping[Queue, Executor] = dict.fromkeys(Queue, self._executor) if self._executor else run.executors
        offered_arguments = {
            "execution": Execution(executors[Queue.BACKGROUND], run.cancel),
            "on_frame": publish,
            "find_result": partial(self._find_result, run),
            "resume": job.find_earlier(job, self.cache) if job.find_earlier is not None else None,
        }
        call = partial(job.function, *arguments, **job.keywords(offered_arguments))
        if job.queue is Queue.LIMITED and self._run_limited is not None:
            call = partial(self._run_limited, call, run.cancel)
        if job.queue in (Queue.LONG_CALL, Queue.LIMITED, Queue.COMPILATION):
            return executors[job.queue].submit(call).result()
        return call()

    def _find_result[Result](self, run: _Run, job: Job[Result]) -> Result:
        """Return the complete result of a job that the job of the run needs. If it is not cached, compute and cache it."""
        result: Any = self.cache.get(job, ABSENT)
        if not _is_complete(result):
            result = self._call_function(job, run, None)
            self.cache.put(job, result)
        if not _is_complete(result):
            raise CancelledError
        return result

    def _create_executors(self, run: _Run) -> Mapping[Queue, QueueExecutor]:
        """Return an executor for each `Queue`."""
        account = run.client if run.account is None else run.account
        client = (account, run.client)
        short_calls = self._scheduler.executor(client, run.priority)
        return {
            Queue.FIRST_FRAME: short_calls,
            Queue.BACKGROUND: short_calls,
            Queue.SPARE: short_calls,
            Queue.LONG_CALL: self._scheduler.executor(client, lambda: Priority.LONG_CALL),
            # One of these calls may occupy a thread for seconds, so all clients of an account share a turn.
            Queue.LIMITED: self._limited_calls.executor((account,), lambda: Priority.BACKGROUND),
            Queue.COMPILATION: self._compilations.executor((account,), lambda: Priority.LONG_CALL),
        }

    def _finish(self, run: _Run, result: Any, error: Exception | None) -> list[Subscription]:
        """Cache the result, remove the job and return its subscriptions."""
        with self._lock:
            # An interrupted result must not replace a complete result.
            if result is not ABSENT and (_is_complete(result) or not _is_complete(self.cache.get(run.job, ABSENT))):
                self.cache.put(run.job, result)
            if self._runs.get(run.job) is run:
                del self._runs[run.job]
            outcome = "cancelled" if run.cancel.is_set() else "done"
            self._ended["failed" if error else outcome] += 1
            return run.release()

    def _publish(self, run: _Run, result: Any) -> None:
        """Deliver a partial result. `_run_job` delivers a complete result, with all its data."""
        if result.complete:
            return
        with self._lock:
            run.partial_result = result
            if run.map_priority is not None:
                run.map_priority.add_frame(result.horizon)
            subscriptions = list(run.subscriptions)
        for subscription in subscriptions:
            subscription.deliver(result, last=False)


def _is_complete(result: Any) -> bool:
    """Return whether there is a complete result. A result without an attribute ``complete`` is complete."""
    return result is not ABSENT and getattr(result, "complete", True)
