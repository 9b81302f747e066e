"""How many orbits may be held in memory at the same time by all jobs together."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager

SMALL = 2**16
"""A job of at most this many orbits, such as a map of 256 × 256, never waits for room."""

_LOOKS_AT_CANCEL_EVERY = 0.2


class OrbitSemaphore:
    """OrbitSemaphore for large jobs.

    Parameters
    ----------
    orbits
        Of all large jobs under way together; one larger than that has the room to itself.
    """

    def __init__(self, orbits: int) -> None:
        self.orbits = orbits
        self.taken = 0
        self._left = threading.Condition()

    @contextmanager
    def hold(self, orbits: int, cancel: threading.Event) -> Iterator[None]:
        """Wait for room, and have it. Raises CancelledError when `cancel` is set meanwhile."""
        orbits = orbits if orbits > SMALL else 0
        with self._left:
            while orbits and self.taken and self.taken + orbits > self.orbits:
                self._left.wait(_LOOKS_AT_CANCEL_EVERY)
                if cancel.is_set():
                    raise CancelledError
            self.taken += orbits
        try:
            yield
        finally:
            with self._left:
                self.taken -= orbits
                self._left.notify_all()
