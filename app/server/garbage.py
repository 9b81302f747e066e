"""Python's search for garbage, put off while visitors wait: with twenty pages it stops everything for more than a second."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

SEARCHED_EVERY = 120.0
"""Seconds between two searches at the least; Panel searches too, some time after a page has gone."""

_LONGEST = 10.0

# Young objects, as always; the old ones never by count.
_THRESHOLDS = 5000, 20, 1_000_000


class Garbage:
    """Searches everything when nobody waits, and at the latest after ten times that long.

    Parameters
    ----------
    is_pressed
        Whether somebody waits.
    """

    def __init__(self, is_pressed: Callable[[], bool]) -> None:
        self._is_pressed = is_pressed
        self._last = time.monotonic()
        gc.set_threshold(*_THRESHOLDS)

    def look(self) -> None:
        """Search if it is time; to be called every second or so."""
        since = time.monotonic() - self._last
        if since >= SEARCHED_EVERY and not (self._is_pressed() and since < _LONGEST * SEARCHED_EVERY):
            gc.collect()
            self._last = time.monotonic()
