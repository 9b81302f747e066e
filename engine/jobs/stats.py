"""What a process' jobs come to, in numbers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class JobStats:
    """How busy `Jobs` is.

    Attributes
    ----------
    in_flight
        Jobs that somebody waits for.
    calls_waiting
        Parts of them that no thread has taken up yet; 0 where the computing is not done by the threads of this process.
    done, failed, cancelled
        Jobs that have ended so far, by how.
    cache_bytes, cache_limit
        Memory that kept results hold, and may hold.
    orbits_held, orbits_limit
        Orbits of large jobs under way, and how many there may be.
    threads
        That compute.
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
