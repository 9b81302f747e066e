"""What all parts of the server know of it: its limits, where it is in its life, and whom it serves."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from app.runtime.settings import Settings, current_settings
from engine import Jobs


@dataclass(eq=False)
class ProcessState:
    """One server process.

    Attributes
    ----------
    settings
        Its limits.
    prepared
        Set when all kernels are compiled or loaded.
    failed
        Set when they cannot be.
    stopping
        Set when the server has been told to stop.
    sessions
        The open Bokeh sessions; none before the server has started.
    jobs
        The background work of the process; None before the server has started.
    """

    settings: Settings
    prepared: threading.Event = field(default_factory=threading.Event)
    failed: threading.Event = field(default_factory=threading.Event)
    stopping: threading.Event = field(default_factory=threading.Event)
    sessions: Callable[[], Iterable[Any]] = tuple
    jobs: Jobs | None = None

    def count_sessions(self) -> int:
        """How many sessions are open."""
        return len(list(self.sessions()))


@cache
def process_state() -> ProcessState:
    """The one of this process."""
    return ProcessState(current_settings())
