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
    limited_calls_waiting
        Number of these calls that evaluate a visitor's text, see `Queue.LIMITED`.
    done, failed, cancelled
        Number of jobs that have ended, by outcome.
    cache_bytes, cache_limit
        Size of the cached results and its limit, in bytes.
    orbits_held, orbits_limit
        Number of orbits that large running jobs hold in memory, and its limit.
    threads
        Number of worker threads.
    processor_time
        Processor time of ended calls in seconds. Limited calls do not count, nor do calls in an executor of the caller.
    """

    in_flight: int
    calls_waiting: int
    limited_calls_waiting: int
    done: int
    failed: int
    cancelled: int
    cache_bytes: int
    cache_limit: int
    orbits_held: int
    orbits_limit: int
    threads: int
    processor_time: float
