"""State that all sessions of a server process share: settings, background jobs, load, metrics and flags."""

from __future__ import annotations

import os
import threading
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any
from weakref import WeakKeyDictionary

from bokeh.document import Document

from app.runtime.fair_share import FairShare
from app.runtime.limited_process import PROCESSES, LimitedProcesses
from app.runtime.load_monitor import LoadMonitor
from app.runtime.metrics import ServerMetrics
from app.runtime.overload import OverloadMonitor
from app.runtime.settings import Settings, read_settings
from engine.integrator.jit.compiled_operations import compiled_operations
from engine.jobs.manager import Jobs

# Waiting calls per thread above which the process is overloaded; the map of one session queues two.
_MOST_WAITING = 4


@dataclass(eq=False)
class ProcessState:
    """State of one server process.

    Attributes
    ----------
    settings
        Settings of the process.
    sessions
        Returns the open Bokeh sessions; none until the server sets it.
    sockets
        Number of open WebSockets by address.
    jobs
        Background jobs of all sessions.
    limited
        The processes for what visitors type.
    load
        Delay of the event loop.
    overload
        Whether the delays of first frames have been long for seconds.
    metrics
        Prometheus metrics.
    kernels_ready
        Set when all kernels are compiled or loaded from the disk cache.
    kernels_failed
        Set when a kernel could not be compiled.
    stopping
        Set when the server shuts down.
    """

    settings: Settings = field(default_factory=Settings)
    sessions: Callable[[], Iterable[Any]] = tuple
    sockets: Counter[str] = field(default_factory=Counter, init=False)
    jobs: Jobs = field(init=False)
    limited: LimitedProcesses = field(default_factory=LimitedProcesses, init=False)
    load: LoadMonitor = field(default_factory=LoadMonitor, init=False)
    overload: OverloadMonitor = field(init=False)
    metrics: ServerMetrics = field(default_factory=ServerMetrics, init=False)
    kernels_ready: threading.Event = field(default_factory=threading.Event, init=False)
    kernels_failed: threading.Event = field(default_factory=threading.Event, init=False)
    stopping: threading.Event = field(default_factory=threading.Event, init=False)
    _shares: WeakKeyDictionary[Document, FairShare] = field(default_factory=WeakKeyDictionary, init=False)

    def __post_init__(self) -> None:
        self.overload = OverloadMonitor(self.settings.longest_delay)
        compiled_operations.most = self.settings.compiled_operations
        self.jobs = Jobs(
            cache_bytes=self.settings.cache_bytes,
            most_orbits=self.settings.most_orbits,
            threads=self.settings.threads,
            limited=self.limited,
            limited_calls=PROCESSES,
        )

    def fair_share(self, document: Document) -> FairShare:
        """The share of a document's page, whatever the number of its connections."""
        return self._shares.setdefault(document, FairShare())

    def adapt_to_load(self) -> None:
        """Adapt to the measured delays; call after each tick of `load` on the event loop."""
        self.overload.add(self.load.delay + self.jobs.take_first_frame_wait())
        self.jobs.pause_background(self.load.is_high())
        # Before pages are refused.
        self.jobs.spare_first_frames(self.overload.delay > self.settings.longest_delay)

    def is_overloaded(self) -> bool:
        """Whether the event loop is delayed or many calls wait for a thread."""
        stats = self.jobs.stats()
        return self.load.is_high() or stats.calls_waiting > _MOST_WAITING * stats.threads


_lock = threading.Lock()
_started: ProcessState | None = None


def process_state() -> ProcessState:
    """Return the state of this process; the first call starts it with the settings of the environment.

    Raises
    ------
    ValueError
        An environment variable is invalid; one sentence with its name, value and legal values.
    """
    with _lock:
        return _started or _start(read_settings(os.environ))


def start_process_state(settings: Settings) -> ProcessState:
    """Start a new state of this process, in place of an earlier one; sessions that are open keep theirs."""
    with _lock:
        return _start(settings)


def _start(settings: Settings) -> ProcessState:
    global _started
    _started = ProcessState(settings)
    return _started
