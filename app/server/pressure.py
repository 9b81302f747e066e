"""How far the server is behind with its visitors' messages: where it is, what is pleasant gives way to what is asked for."""

from __future__ import annotations

import time
from functools import cache

LOOKED_AT_EVERY = 0.1
"""Seconds between two looks at the clock."""

HIGH = 0.25
"""Seconds by which a look may be late before the server counts as pressed."""

# Of the last delay, what is left at the next look: a second or so after the crowd has gone there are quick looks again.
_MEMORY = 0.8


class Pressure:
    """The delay of a clock that ticks between the messages of all visitors."""

    def __init__(self) -> None:
        self._due: float | None = None
        self.delay = 0.0

    def tick(self) -> None:
        """To be called every `LOOKED_AT_EVERY` seconds, by the loop that handles messages."""
        now = time.monotonic()
        late = max(0.0, now - self._due) if self._due is not None else 0.0
        self.delay = max(late, _MEMORY * self.delay)
        self._due = now + LOOKED_AT_EVERY

    def is_high(self) -> bool:
        """Whether quick looks and frames between the first and the last are too much."""
        return self.delay > HIGH


@cache
def this_pressure() -> Pressure:
    """That of this process."""
    return Pressure()
