"""Python's search for garbage, put off until nobody waits: with twenty-five pages it stops everything for two seconds."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

SEARCHED_EVERY = 120.0
"""Seconds between two searches of everything at the least."""

QUIET_SECONDS = 3.0
"""Nobody waits any more when nobody has waited for this long."""

_LONGEST = 10.0

# What is older than this is left out of searches by others, as Panel's some time after a page has gone.
_OLD_SECONDS = 30.0

# Young objects, as always; the old ones never by count.
_THRESHOLDS = 5000, 20, 1_000_000


class GarbagePolicy:
    """Searches everything when nobody waits, and at the latest after ten times the usual pause.

    Parameters
    ----------
    is_waited
        Whether somebody waits for something.
    """

    def __init__(self, is_waited: Callable[[], bool]) -> None:
        self._is_waited = is_waited
        self._searched = self._waited = self._set_aside = time.monotonic()
        gc.set_threshold(*_THRESHOLDS)

    def look(self) -> None:
        """Search if it is time; to be called every second or so."""
        now = time.monotonic()
        if self._is_waited():
            self._waited = now
        since = now - self._searched
        is_quiet = now - self._waited >= QUIET_SECONDS
        if since >= SEARCHED_EVERY and (is_quiet or since >= _LONGEST * SEARCHED_EVERY):
            gc.unfreeze()
            gc.collect()
            self._searched = time.monotonic()
            self._put_aside()
        elif now - self._set_aside >= _OLD_SECONDS:
            self._put_aside()

    def _put_aside(self) -> None:
        gc.freeze()
        self._set_aside = time.monotonic()
