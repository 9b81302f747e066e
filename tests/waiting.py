"""Wait for other threads and processes, and for conditions that no event reports."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

SECONDS = 240.0
"""Longest wait: enough for a slow and busy machine that has to compile kernels. Only tests that fail wait so long."""

_BETWEEN_LOOKS = 0.01


def wait_until(condition: Callable[[], bool], seconds: float = SECONDS) -> None:
    """Wait until a condition holds. AssertionError if it does not hold in time."""
    begun, never = time.monotonic(), threading.Event()
    while not condition():
        assert time.monotonic() - begun < seconds, f"not within {seconds} s"
        never.wait(_BETWEEN_LOOKS)
