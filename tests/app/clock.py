"""A manual clock in place of the module `time`."""

from __future__ import annotations

import threading
from collections import Counter


class Clock:
    def __init__(self) -> None:
        self.now = 100.0
        self._computed: Counter[int] = Counter()

    def monotonic(self) -> float:
        return self.now

    def thread_time(self) -> float:
        return self._computed[threading.get_ident()]

    def compute(self, seconds: int) -> None:
        """Let this thread have a processor for some seconds."""
        self.now += seconds
        self._computed[threading.get_ident()] += seconds
