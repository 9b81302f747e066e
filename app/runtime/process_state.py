"""State that all sessions of a server process share: settings, background jobs, load, metrics and flags."""

from __future__ import annotations

import asyncio
import os
import threading
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any
from weakref import WeakKeyDictionary, WeakValueDictionary

from bokeh.document import Document

from app.runtime.capacity import Capacity, ProcessorTimes, page_weight, processor_times
from app.runtime.fair_share import FairShare, PageTime
from app.runtime.limited_process import COMPILATION_SECONDS, PROCESSES, LimitedProcess, LimitedProcesses
from app.runtime.loop_watch import LoadMonitor
from app.runtime.metrics import ServerMetrics
from app.runtime.settings import Settings, read_settings
from app.runtime.visitor_turns import VisitorTurns
from app.runtime.visitors import visitor_of
from engine.integrator.jit.compiled_operations import compiled_operations
from engine.jobs.manager import Jobs

ITERATIONS_BEFORE_TURN = 4
"""Number of iterations of the event loop before the turn of a page.

What becomes ready during a turn, such as a message of another page or a periodic callback of Tornado, is noticed after the next
iteration, and takes two more iterations until it runs or waits for its own turn.
"""

_COMPILATION = "compiling the integrator of this potential"


@dataclass(eq=False)
class ProcessState:
    """The settings, jobs, load, metrics and flags of a server process.

    Attributes
    ----------
    settings
        Settings of the process.
    sessions
        Returns the open Bokeh sessions; set by the server.
    sockets
        Number of open WebSockets by network, see `app.runtime.visitors.network_of`.
    making_page
        The turns in which pages are built.
    jobs
        Background jobs of all sessions.
    limited
        Processes that review the formulas of visitors.
    compiler
        Process that compiles kernels.
    load
        Monitor of the delay of the event loop.
    capacity
        Decides for how many pages the processors suffice.
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
    making_page: VisitorTurns = field(default_factory=VisitorTurns, init=False)
    jobs: Jobs = field(init=False)
    limited: LimitedProcesses = field(default_factory=LimitedProcesses, init=False)
    compiler: LimitedProcess = field(default_factory=lambda: LimitedProcess(COMPILATION_SECONDS, task=_COMPILATION), init=False)
    load: LoadMonitor = field(default_factory=LoadMonitor, init=False)
    capacity: Capacity = field(init=False)
    metrics: ServerMetrics = field(default_factory=ServerMetrics, init=False)
    kernels_ready: threading.Event = field(default_factory=threading.Event, init=False)
    kernels_failed: threading.Event = field(default_factory=threading.Event, init=False)
    stopping: threading.Event = field(default_factory=threading.Event, init=False)
    _is_crowded: bool = field(default=False, init=False)
    # A visitor's share is kept while the visitor has a page.
    _shares: WeakValueDictionary[str, FairShare] = field(default_factory=WeakValueDictionary, init=False)
    _page_times: WeakKeyDictionary[Document, PageTime] = field(default_factory=WeakKeyDictionary, init=False)
    # The turns of each event loop. A test process has several loops, one after another.
    _turns: WeakKeyDictionary[asyncio.AbstractEventLoop, VisitorTurns] = field(default_factory=WeakKeyDictionary, init=False)

    def __post_init__(self) -> None:
        compiled_operations.limit = self.settings.compiled_operations
        self.jobs = Jobs(
            cache_bytes=self.settings.cache_bytes,
            most_orbits=self.settings.most_orbits,
            threads=self.settings.threads,
            run_limited=self.limited,
            most_limited_calls=PROCESSES,
        )
        self.capacity = Capacity(self.settings.cores_per_page, self.settings.processes, self._processor_times)

    async def next_turn(self, visitor: str) -> None:
        """Wait for an iteration of the event loop in which no other page has the turn.

        asyncio runs all ready callbacks in one iteration, so the pending work of many pages would delay everything else.

        Parameters
        ----------
        visitor
            The network of the visitor, see `app.runtime.visitors.network_of`. Visitors take turns.
        """
        async with self._turns.setdefault(asyncio.get_running_loop(), VisitorTurns()).turn(visitor):
            for _ in range(ITERATIONS_BEFORE_TURN):
                await asyncio.sleep(0)

    def page_time(self, document: Document) -> PageTime:
        """Return what charges the time of a page, given its document. All pages of a visitor have one share."""
        share = self._shares.setdefault(visitor_of(document), FairShare())
        return self._page_times.setdefault(document, PageTime(share))

    def delay(self, visitor: str) -> float:
        """Return how long the next message or page of a visitor must wait, in seconds.

        The result is 0 if no other visitor has a page or waits for a page.
        """
        share = self._shares.get(visitor)
        seconds = share.wait_seconds() if share is not None else 0.0
        return seconds if seconds and self._has_other_visitors(visitor) else 0.0

    def _has_other_visitors(self, visitor: str) -> bool:
        connected = (visitor_of(session.document) for session in self.sessions() if session.connection_count)
        return any(other != visitor for other in connected) or self.making_page.are_wanted_by_others(visitor)

    def _processor_times(self) -> ProcessorTimes:
        helper_seconds = self.limited.totals.seconds + self.compiler.totals.seconds
        return processor_times(self.jobs.stats().processor_time, helper_seconds)

    def pages(self) -> Mapping[str, float]:
        """Return the sum of the weights of each visitor's pages, see `app.runtime.capacity.page_weight`."""
        pages: dict[str, float] = defaultdict(float)
        for session in self.sessions():
            idle_seconds = self.page_time(session.document).idle_seconds()
            pages[visitor_of(session.document)] += page_weight(idle_seconds, connected=session.connection_count > 0)
        return pages

    def adapt_to_load(self) -> None:
        """Postpone work that can wait while the load is high. Call this after each tick of `load` on the event loop."""
        if self.capacity.update():
            self._is_crowded = self.capacity.is_crowded(self.pages())
        self.jobs.pause_background(self.load.is_high())
        self.jobs.prefer_first_frames(self._is_crowded)

    def is_crowded(self) -> bool:
        """Whether a map should show only its first and last frame."""
        return self._is_crowded or self.load.is_high()


_lock = threading.Lock()
_current_state: ProcessState | None = None


def process_state() -> ProcessState:
    """Return the state of this process. The first call starts the state with the settings of the environment.

    Raises
    ------
    ValueError
        If an environment variable is invalid. The message has its name, its value and the legal values.
    """
    with _lock:
        return _current_state or _start(read_settings(os.environ))


def start_process_state(settings: Settings) -> ProcessState:
    """Start a new state of this process. Open sessions keep the earlier state."""
    with _lock:
        return _start(settings)


def _start(settings: Settings) -> ProcessState:
    global _current_state
    _current_state = ProcessState(settings)
    return _current_state
