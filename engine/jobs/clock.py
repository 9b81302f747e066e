"""The clock of the jobs."""

from __future__ import annotations

from typing import Protocol


class Clock(Protocol):
    """The functions of the module `time` that jobs use; tests replace them by a clock that is set by hand."""

    def monotonic(self) -> float:
        """Return seconds since a fixed moment."""

    def thread_time(self) -> float:
        """Return the processor time of the calling thread, in seconds."""
