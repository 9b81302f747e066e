"""Semaphore that bounds the number of orbits held in memory by all jobs together."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from engine.foundations.execution import Execution

SMALL_JOB = 2**16
"""Jobs of at most this many orbits, such as a map of 256 × 256, are not counted and never wait."""

_CANCEL_POLL_SECONDS = 0.2


class OrbitSemaphore:
    """Weighted semaphore for large jobs: each job acquires one unit for each orbit that it holds.

    Parameters
    ----------
    limit
        Largest number of orbits held at the same time. A job with more orbits runs when no other large job does.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.held = 0
        self._released = threading.Condition()

    @contextmanager
    def acquire(self, orbits: int, execution: Execution) -> Iterator[None]:
        """Hold this many orbits while the context is active; CancelledError if the wait is cancelled."""
        orbits = orbits if orbits > SMALL_JOB else 0
        with self._released:
            while orbits and self.held and self.held + orbits > self.limit:
                self._released.wait(_CANCEL_POLL_SECONDS)
                execution.raise_if_cancelled()
            self.held += orbits
        try:
            yield
        finally:
            with self._released:
                self.held -= orbits
                self._released.notify_all()
