"""Measure the delay of the event loop; while it is high, refined frames are left out."""

from __future__ import annotations

import time

TICK_SECONDS = 0.1
"""Interval between two calls of `LoadMonitor.tick`."""

HIGH_SECONDS = 0.05
"""Delay of a tick above which the load is high."""

# Factor by which a delay decays per tick: the load is normal again half a second after a peak.
_DECAY = 0.7

LONGEST_SECONDS = 2.0
"""A high load is reported as normal for one tick after this time, so that postponed work is delayed but never starved."""


class LoadMonitor:
    """Delay of a periodic callback on the event loop."""

    def __init__(self) -> None:
        self._due: float | None = None
        self._high_since: float | None = None
        self.delay = 0.0

    def tick(self) -> None:
        """Measure the delay; call every `TICK_SECONDS` on the event loop."""
        now = time.monotonic()
        late = max(0.0, now - self._due) if self._due is not None else 0.0
        self.delay = max(late, _DECAY * self.delay)
        self._due = now + TICK_SECONDS
        if not self.delay > HIGH_SECONDS or (self._high_since is not None and now - self._high_since > LONGEST_SECONDS):
            self._high_since = None
        elif self._high_since is None:
            self._high_since = now

    def is_high(self) -> bool:
        """Whether work other than first frames should be postponed."""
        return self._high_since is not None
