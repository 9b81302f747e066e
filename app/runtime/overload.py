"""Tell from measured delays when the server is full, whatever the machine: while it is, no further pages are admitted."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

WINDOW_SECONDS = 20
"""Delays of this time count."""

LATE_SECONDS = 10
"""The server is overloaded when so many of the last `WINDOW_SECONDS` have a long delay."""

CALM_SECONDS = 2
"""The overload ends when only so many of them have one."""


class OverloadMonitor:
    """Whether delays have been long for seconds.

    A single long callback is no overload. That an overload begins and ends at different loads keeps the server from admitting and
    refusing pages in turn.

    Parameters
    ----------
    longest_delay
        Delay in seconds above which a second counts.
    clock
        Time in seconds.
    """

    def __init__(self, longest_delay: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._longest_delay, self._clock = longest_delay, clock
        # The largest delay of each of the last seconds.
        self._delays: dict[int, float] = {}
        self._is_overloaded = False

    def add(self, delay: float) -> None:
        """Count a delay that ends now, in seconds; it belongs to all seconds since it began."""
        now = self._clock()
        earliest = now - WINDOW_SECONDS
        for second in range(math.floor(max(now - delay, earliest)), math.floor(now) + 1):
            self._delays[second] = max(delay, self._delays.get(second, 0.0))
        self._delays = {second: longest for second, longest in self._delays.items() if second > earliest}
        late = sum(longest > self._longest_delay for longest in self._delays.values())
        self._is_overloaded = late >= LATE_SECONDS or (self._is_overloaded and late > CALM_SECONDS)

    @property
    def delay(self) -> float:
        """Largest delay of the last `WINDOW_SECONDS`, in seconds."""
        return max(self._delays.values(), default=0.0)

    def is_overloaded(self) -> bool:
        """Whether pages should be refused."""
        return self._is_overloaded
