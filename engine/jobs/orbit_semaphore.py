"""A semaphore that bounds the number of orbits that all jobs together hold in memory."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from engine.foundations.execution import Execution

SMALL_JOB = 2**16
"""Largest number of orbits of a small job, such as a map of 256 × 256. Small jobs are not counted and never wait."""

# Interval between checks whether a waiting job is cancelled, in seconds.
_CANCEL_POLL_SECONDS = 0.2


class OrbitSemaphore:
    """A weighted semaphore for large jobs: each job acquires one unit for each orbit that it holds.

    Parameters
    ----------
    limit
        Largest number of orbits held at the same time. A job with more orbits runs when no other large job runs.

    Attributes
    ----------
    limit
        The same limit.
    held
        Number of orbits held by large jobs at present.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0
        self._released = threading.Condition()

    @contextmanager
    def acquire(self, orbits: int, execution: Execution) -> Iterator[None]:
        """Wait until this many orbits may be held, and hold them in this context; CancelledError if the wait is cancelled."""
        counted_orbits = orbits if orbits > SMALL_JOB else 0
        with self._released:
            while counted_orbits and self.held and self.held + counted_orbits > self.limit:
                self._released.wait(_CANCEL_POLL_SECONDS)
                execution.raise_if_cancelled()
            self.held += counted_orbits
        try:
            yield
        finally:
            with self._released:
                self.held -= counted_orbits
                self._released.notify_all()
