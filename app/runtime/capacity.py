"""The share of the processors that the open pages need. It decides when work is postponed and when new pages are refused.

Each open page reserves the processor time that an active visitor uses: otherwise, a server would admit too many visitors while
they are still reading. Three values are measured: the processors that other programs leave, the use of the event loop, and the
processor time for making a page, from which the need of a visitor is estimated.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from statistics import fmean, median
from typing import Any, NamedTuple

import psutil

from engine.foundations.execution import count_cores

FULL = 0.85
"""Largest share of the processors, and of the event loop's time, for all pages together. Above it, new pages are refused."""

CROWDED = 0.5
"""Share (see `FULL`) above which work that can wait is postponed, so that open pages stay fast."""

PAGES_PER_SECOND = 0.17
"""Number of pages whose making takes as much processor time as an active visitor uses in a second.

It was found with `benchmarks.load`: with a smaller number, more visitors are admitted and wait for the maps of others. It must be
found again when the making of a page, or a map, becomes faster or slower.
"""

FIRST_CORES_PER_PAGE = 0.04
"""Processors that an active visitor is assumed to use before the first page is made."""

MEASURED_PAGES = 15
"""Number of the last pages from whose making the use of the processors by a visitor is estimated."""

VISITOR_SHARE = 0.5
"""When a visitor opens a page, the pages of each other visitor count for at most this share of the capacity."""

MOST_CORES = 1.0
"""Most processors that a process uses: its threads share the interpreter lock."""

LEAST_CORES = 0.2
"""Fewest processors that a process gets from the operating system, even while other programs keep all processors busy."""

LEAST_IDLE_CORES = 0.1
"""Number of idle processors below which the measured use of other programs may be too low, because they wait for a processor."""

WINDOW_SECONDS = 20
"""Time over which the use of the processors is averaged, in seconds."""

ACTING_SECONDS = 300.0
"""Time after a visitor's last action during which the page counts in full, in seconds."""

IDLE_WEIGHT = 0.1
"""Weight of an idle page, compared with 1 for a page in use."""

CONNECTION_SECONDS = 15.0
"""Time after the last action during which a page without a connection counts, in seconds: its browser may be about to connect."""


class ProcessorTimes(NamedTuple):
    """Processor times since a fixed moment, in seconds.

    Programs of low priority, such as the computations of this program, are left out because they give way.
    """

    now: float
    all_programs: float
    """Time of all programs on the processors that this process may use."""
    own: float
    """Time of this process, and of the helper processes that compute for it."""
    loop: float
    """Time of the event loop of this process."""


class _Use(NamedTuple):
    """Use of the processors during an interval between two measurements."""

    seconds: float
    other_cores: float
    """Average number of processors that other programs used."""
    loop_share: float
    """Share of the interval during which the event loop was busy."""


class Capacity:
    """Measures the use of the processors, and decides whether there is capacity for another page.

    Parameters
    ----------
    cores_per_page
        Processors that an active visitor uses; 0 to estimate them, see `PAGES_PER_SECOND`.
    processes
        Number of server processes that share the processors. All processes are assumed to be equally busy.
    measure
        Returns the present processor times; called on the thread of the event loop.
    clock
        Monotonic clock, in seconds.
    usable_cores
        Number of processors that the server may use; None to count them.

    Attributes
    ----------
    cores
        Number of processors available to this process, without the part that other programs use.
    loop_share
        Share of the time during which the event loop is busy.
    """

    def __init__(
        self,
        cores_per_page: float,
        processes: int,
        measure: Callable[[], ProcessorTimes],
        clock: Callable[[], float] = time.monotonic,
        usable_cores: int | None = None,
    ) -> None:
        self._given_cores_per_page, self._processes, self._measure, self._clock = cores_per_page, processes, measure, clock
        self._page_seconds = deque[float](maxlen=MEASURED_PAGES)
        self._usable_cores = count_cores() if usable_cores is None else usable_cores
        self._times = measure()
        # Measurements are a second or more apart, so this many of them cover the window.
        self._uses = deque[_Use](maxlen=WINDOW_SECONDS)
        self.cores = self._available_cores(0.0)
        self.loop_share = 0.0

    def update(self) -> bool:
        """Measure unless the last measurement is less than a second old; return whether a measurement was made."""
        if self._clock() < self._times.now + 1.0:
            return False
        previous_times, self._times = self._times, self._measure()
        seconds, programs, own, loop = (new - old for new, old in zip(self._times, previous_times, strict=True))
        other_cores = (programs - self._processes * own) / seconds
        if self._usable_cores - programs / seconds < LEAST_IDLE_CORES:
            other_cores = max(other_cores, self._mean_other_cores())
        self._uses.append(_Use(seconds, other_cores, loop / seconds))
        self.cores = self._available_cores(max(self._mean_other_cores(), 0.0))
        self.loop_share = self._mean(use.loop_share for use in self._uses)
        return True

    def record_page(self, seconds: float) -> None:
        """Record the processor time for making a page, in seconds; called on the thread of the event loop."""
        self._page_seconds.append(seconds)

    @property
    def cores_per_page(self) -> float:
        """Processors that an active visitor uses."""
        if self._given_cores_per_page:
            return self._given_cores_per_page
        return PAGES_PER_SECOND * median(self._page_seconds) if self._page_seconds else FIRST_CORES_PER_PAGE

    def is_crowded(self, pages: Mapping[str, float]) -> bool:
        """Whether work that can wait should be postponed, given the number of pages by visitor."""
        return self.occupied_share(pages) > CROWDED

    def has_room(self, pages: Mapping[str, float], visitor: str = "") -> bool:
        """Whether another page of a visitor is admitted, given the number of pages by visitor."""
        most_pages = VISITOR_SHARE * FULL * self.cores / self.cores_per_page
        counted_pages = {name: min(count, most_pages) for name, count in pages.items() if name != visitor}
        return self.occupied_share(counted_pages | {visitor: pages.get(visitor, 0.0) + 1.0}) <= FULL

    def occupied_share(self, pages: Mapping[str, float]) -> float:
        """Return the share of the processors that the pages reserve, or the busy share of the event loop if that is larger."""
        return max(self.cores_per_page * sum(pages.values()) / self.cores, self.loop_share)

    def _mean_other_cores(self) -> float:
        return self._mean(use.other_cores for use in self._uses)

    def _mean(self, values: Iterable[float]) -> float:
        """Return the mean of a value for each measurement, weighted by the lengths of the intervals; 0 without a measurement."""
        return fmean(values, [use.seconds for use in self._uses]) if self._uses else 0.0

    def _available_cores(self, other_cores: float) -> float:
        """Return the number of processors available to this process while other programs use `other_cores`."""
        return min(max((self._usable_cores - other_cores) / self._processes, LEAST_CORES), MOST_CORES)


def page_weight(idle_seconds: float, *, connected: bool) -> float:
    """Return the weight of a page: 1 in use, `IDLE_WEIGHT` when idle, and 0 if the visitor has left.

    Parameters
    ----------
    idle_seconds
        Time since the page last used the event loop, in seconds.
    connected
        Whether the page is connected.
    """
    if not connected:
        return float(idle_seconds < CONNECTION_SECONDS)
    return 1.0 if idle_seconds < ACTING_SECONDS else IDLE_WEIGHT


def processor_times(low_priority_seconds: float, helper_seconds: float) -> ProcessorTimes:
    """Return the present processor times.

    Parameters
    ----------
    low_priority_seconds
        Processor time that this process has used with low priority, in seconds.
    helper_seconds
        Processor time that helper processes have used for this process, in seconds.
    """
    usable_indices = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
    processors = [
        times for index, times in enumerate(psutil.cpu_times(percpu=True)) if usable_indices is None or index in usable_indices
    ]
    return ProcessorTimes(
        now=time.monotonic(),
        all_programs=sum(_normal_priority_time(times) for times in processors),
        own=time.process_time() - low_priority_seconds + helper_seconds,
        loop=time.thread_time(),
    )


def _normal_priority_time(times: Any) -> float:
    """Return the processor time of programs of normal priority, and of other virtual machines on the same processor."""
    return sum(getattr(times, name, 0.0) for name in ("user", "system", "irq", "softirq", "steal"))
