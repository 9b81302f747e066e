"""Statistics of a job manager."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JobStats:
    """Load, totals and memory of `Jobs`.

    Attributes
    ----------
    in_flight
        Running and queued jobs.
    calls_waiting
        Calls of these jobs that no thread has started; 0 if `Jobs` uses an executor of the caller.
    done, failed, cancelled
        Number of jobs that have ended, by outcome.
    cache_bytes, cache_limit
        Size of the cached results and its limit, in bytes.
    orbits_held, orbits_limit
        Number of orbits of large running jobs, and its limit.
    threads
        Number of worker threads.
    computed
        Processor time of calls that have ended, without limited calls, in seconds.
    """

    in_flight: int
    calls_waiting: int
    done: int
    failed: int
    cancelled: int
    cache_bytes: int
    cache_limit: int
    orbits_held: int
    orbits_limit: int
    threads: int
    computed: float
