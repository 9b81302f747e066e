"""Priority of the calls of a map: its first frame first, and last what the next map may replace before anyone looks at it."""

from __future__ import annotations

import time
from collections.abc import Callable

from engine.jobs.clock import Clock
from engine.jobs.scheduler import Priority

REST_SECONDS = 1.0
"""Time after the request of a map within which it is often replaced by another, as its user still searches."""

CROWDED_REST_SECONDS = 3.0
"""The same while the process is crowded: most maps are then replaced before more than their first frame is computed."""


class MapPriority:
    """Priority of one map, from its request on.

    The calls until the first frame have `Priority.FIRST_FRAME`. The longer integration times after that of the first frame, which
    change few pixels, have `Priority.UNSETTLED` for `REST_SECONDS`: other calls run first, but no thread is idle instead. While
    the process is crowded, all calls after the first frame have it for `CROWDED_REST_SECONDS`.

    Parameters
    ----------
    is_crowded
        Whether the process is.
    clock
        By default that of this process.
    """

    def __init__(self, is_crowded: Callable[[], bool], clock: Clock = time) -> None:
        self._is_crowded, self._clock = is_crowded, clock
        self._requested = clock.monotonic()
        self._first_horizon: float | None = None
        self._horizon = 0.0

    def add_frame(self, horizon: float) -> None:
        """Count a frame; `horizon` as in `EscapeMap`."""
        if self._first_horizon is None:
            self._first_horizon = horizon
        self._horizon = horizon

    def __call__(self) -> Priority:
        """Return the priority of the next call."""
        if self._first_horizon is None:
            return Priority.FIRST_FRAME
        return Priority.UNSETTLED if self._may_be_replaced(self._first_horizon) else Priority.BACKGROUND

    def _may_be_replaced(self, first_horizon: float) -> bool:
        seconds = self._clock.monotonic() - self._requested
        if self._is_crowded():
            return seconds < CROWDED_REST_SECONDS
        return seconds < REST_SECONDS and self._horizon > first_horizon
