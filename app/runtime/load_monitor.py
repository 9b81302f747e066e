"""How far the server is behind with its visitors' messages: while it is, finer pictures and quick looks wait."""

from __future__ import annotations

import time
from functools import cache

LOOKED_AT_EVERY = 0.1
"""Seconds between two looks at the clock."""

HIGH = 0.05
"""Seconds by which a look may be late before the server counts as pressed."""

# Of the last delay, what is left at the next look: half a second after a crowd has gone everything is as before.
_MEMORY = 0.7

LONGEST_SECONDS = 2.0
"""In a crowd that does not go, everything is computed for a moment each time this is over: nothing waits for ever."""


class LoadMonitor:
    """The delay of a clock that ticks between the messages of all visitors."""

    def __init__(self) -> None:
        self._due: float | None = None
        self._high_since: float | None = None
        self.delay = 0.0

    def tick(self) -> None:
        """To be called every `LOOKED_AT_EVERY` seconds, by the loop that handles messages."""
        now = time.monotonic()
        late = max(0.0, now - self._due) if self._due is not None else 0.0
        self.delay = max(late, _MEMORY * self.delay)
        self._due = now + LOOKED_AT_EVERY
        if not self.delay > HIGH or (self._high_since is not None and now - self._high_since > LONGEST_SECONDS):
            self._high_since = None
        elif self._high_since is None:
            self._high_since = now

    def is_high(self) -> bool:
        """Whether all that nobody waits for before an empty page is too much."""
        return self._high_since is not None


@cache
def process_load_monitor() -> LoadMonitor:
    """That of this process."""
    return LoadMonitor()
