"""Priority of the calls of a map: its first frame first, and last what the next map may replace before anyone looks at it."""

from __future__ import annotations

import time

from engine.jobs.clock import Clock
from engine.jobs.scheduler import Priority

REST_SECONDS = 1.0
"""Time after the request of a map within which it is often replaced by another, as its user still searches."""


class MapPriority:
    """Priority of one map, from its request on.

    The calls until the first frame have `Priority.FIRST_FRAME`. The longer integration times after that of the first frame, which
    change few pixels, have `Priority.UNSETTLED` for `REST_SECONDS`: other calls run first, but no thread is idle instead.

    Parameters
    ----------
    clock
        By default that of this process.
    """

    def __init__(self, clock: Clock = time) -> None:
        self._clock = clock
        self._requested = clock.monotonic()
        self._first_horizon: float | None = None
        self._horizon = 0.0

    def add_frame(self, horizon: float) -> None:
        """Count a frame; `horizon` as in `EscapeMap`."""
        if self._first_horizon is None:
            self._first_horizon = horizon
        self._horizon = horizon

    def seconds(self) -> float:
        """Time since the request."""
        return self._clock.monotonic() - self._requested

    def __call__(self) -> Priority:
        """Return the priority of the next call."""
        if self._first_horizon is None:
            return Priority.FIRST_FRAME
        if self._horizon > self._first_horizon and self.seconds() < REST_SECONDS:
            return Priority.UNSETTLED
        return Priority.BACKGROUND
