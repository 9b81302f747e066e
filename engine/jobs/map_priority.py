"""Priority of the calls of a map: highest for its first frame, lowest while the next map may soon replace it."""

from __future__ import annotations

import time
from collections.abc import Callable

from engine.jobs.scheduler import Clock, Priority

REST_SECONDS = 1.0
"""Time after the request of a map, in seconds, during which users often replace the map by another."""

CROWDED_REST_SECONDS = 3.0
"""The same time while the process is crowded, in seconds. Most maps are then replaced before a second frame is computed."""


class MapPriority:
    """Priority of the calls of one map. Construct it at the request of the map, because times count from the construction.

    Calls until the first frame have `Priority.FIRST_FRAME`. Calls with longer integration times, which change few pixels, have
    `Priority.UNSETTLED` during the first `REST_SECONDS`: other calls run first, but no thread stays idle. While the process is
    crowded, all calls after the first frame have this priority for `CROWDED_REST_SECONDS`.

    Parameters
    ----------
    is_crowded
        Returns whether the process is crowded: whether `FairScheduler.prefer_first_frames` is in force.
    clock
        The clock; by default the clock of this process.
    """

    def __init__(self, is_crowded: Callable[[], bool], clock: Clock = time) -> None:
        self._is_crowded, self._clock = is_crowded, clock
        self._request_time = clock.monotonic()
        self._first_horizon: float | None = None
        self._horizon = 0.0

    def add_frame(self, horizon: float) -> None:
        """Record that a frame was delivered, given its `EscapeMap.horizon`."""
        if self._first_horizon is None:
            self._first_horizon = horizon
        self._horizon = horizon

    def __call__(self) -> Priority:
        """Return the priority of the next call."""
        if self._first_horizon is None:
            return Priority.FIRST_FRAME
        return Priority.UNSETTLED if self._is_likely_replaced(self._first_horizon) else Priority.BACKGROUND

    def _is_likely_replaced(self, first_horizon: float) -> bool:
        """Return whether the map is likely to be replaced before the results of its calls are seen."""
        seconds = self._clock.monotonic() - self._request_time
        if self._is_crowded():
            return seconds < CROWDED_REST_SECONDS
        return seconds < REST_SECONDS and self._horizon > first_horizon
