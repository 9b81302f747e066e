"""Waiting for a condition of other threads or processes, which no event tells."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

_BETWEEN_LOOKS = 0.01


def wait_until(condition: Callable[[], bool], seconds: float = 20.0) -> float:
    """Wait until a condition holds, and return the seconds that it took; AssertionError if it does not hold in time."""
    begun, never = time.monotonic(), threading.Event()
    while not condition():
        assert time.monotonic() - begun < seconds, f"not within {seconds} s"
        never.wait(_BETWEEN_LOOKS)
    return time.monotonic() - begun
