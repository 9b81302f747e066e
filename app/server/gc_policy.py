"""Run full garbage collections when the process is idle: with 25 open pages one takes two seconds, and blocks everything."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

CHECK_SECONDS = 1.0
"""Interval between two calls of `GarbagePolicy.check`."""

COLLECT_SECONDS = 120.0
"""Minimum interval between two full collections."""

IDLE_SECONDS = 3.0
"""Time without activity after which the process counts as idle."""

# Multiple of COLLECT_SECONDS after which a collection runs in any case.
_LONGEST = 10.0

# Interval of gc.freeze(), which exempts older objects from collections that others start, as Panel does when a page closes.
_FREEZE_SECONDS = 30.0

# Generations 0 and 1 nearly as by default, generation 2 never by count.
_THRESHOLDS = 5000, 20, 1_000_000


class GarbagePolicy:
    """Collects all generations when the process is idle, and at the latest after ten times the usual interval.

    Parameters
    ----------
    is_busy
        Whether requests or jobs are being processed.
    """

    def __init__(self, is_busy: Callable[[], bool]) -> None:
        self._is_busy = is_busy
        self._collected = self._last_busy = self._frozen = time.monotonic()
        gc.set_threshold(*_THRESHOLDS)

    def check(self) -> None:
        """Collect if it is time; call every `CHECK_SECONDS`."""
        now = time.monotonic()
        if self._is_busy():
            self._last_busy = now
        since = now - self._collected
        is_idle = now - self._last_busy >= IDLE_SECONDS
        if since >= COLLECT_SECONDS and (is_idle or since >= _LONGEST * COLLECT_SECONDS):
            gc.unfreeze()
            gc.collect()
            self._collected = time.monotonic()
            self._freeze()
        elif now - self._frozen >= _FREEZE_SECONDS:
            self._freeze()

    def _freeze(self) -> None:
        gc.freeze()
        self._frozen = time.monotonic()
