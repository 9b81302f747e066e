"""Measure the delay of the event loop; while it is high, refined frames are left out."""

from __future__ import annotations

import time
from collections.abc import Callable

TICK_SECONDS = 0.02
"""Interval between two calls of `LoadMonitor.tick`."""

HIGH_SECONDS = 0.05
"""Delay of a tick above which the load is high."""

# Factor by which a delay decays per tick, 0.7 in 0.1 s: the load is normal again half a second after a peak.
_DECAY = 0.7 ** (TICK_SECONDS / 0.1)

LONGEST_SECONDS = 2.0
"""A high load is reported as normal for one tick after this time, so that postponed work is delayed but never starved."""


class LoadMonitor:
    """Delay of a periodic callback on the event loop.

    Parameters
    ----------
    clock
        Time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._due: float | None = None
        self._high_since: float | None = None
        self.delay = 0.0

    def tick(self) -> float:
        """Measure and return the delay in seconds; call every `TICK_SECONDS` on the event loop."""
        now = self._clock()
        late = max(0.0, now - self._due) if self._due is not None else 0.0
        self.delay = max(late, _DECAY * self.delay)
        self._due = now + TICK_SECONDS
        if not self.delay > HIGH_SECONDS or (self._high_since is not None and now - self._high_since > LONGEST_SECONDS):
            self._high_since = None
        elif self._high_since is None:
            self._high_since = now
        return late

    def overdue_seconds(self) -> float:
        """Time since the next tick was due, negative before; for other threads."""
        return self._clock() - self._due if self._due is not None else 0.0

    def is_high(self) -> bool:
        """Whether work other than first frames should be postponed."""
        return self._high_since is not None
