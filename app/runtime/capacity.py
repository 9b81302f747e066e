"""The number of pages for which the processors suffice. It decides when work is postponed and new pages are refused.

Each open page reserves the processor time that an active visitor uses: otherwise, a server would admit too many visitors while
they are still reading. Two values are measured: the processor time that other programs leave, and the use of the event loop.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from statistics import fmean
from typing import Any, NamedTuple

import psutil

from app.runtime.fair_share import FairShare
from engine.foundations.execution import count_cores

FULL = 0.85
"""Largest share of the processors, and of the event loop's time, for all pages together. Above it, new pages are refused."""

CROWDED = 0.5
"""Share above which work that can wait is postponed, so that open pages stay fast."""

OF_ONE_VISITOR = 0.5
"""Largest share of the capacity for the pages of one visitor, as far as other visitors are concerned."""

MOST_CORES = 1.0
"""Most processors that a process uses, because its threads share the interpreter lock."""

LEAST_CORES = 0.2
"""Fewest processors of a process: what the operating system gives to it when other programs keep all processors busy."""

LEAST_SPARE = 0.1
"""If fewer processors are spare, other programs may get less than they need, because this program uses the rest."""

WINDOW_SECONDS = 20
"""Time over which the use of the processors is averaged."""

ACTING_SECONDS = 300.0
"""Time for which a page counts in full after the visitor's last action."""

IDLE_WEIGHT = 0.1
"""Fraction of a page as which an idle page counts."""

CONNECTION_SECONDS = 15.0
"""Time for which a page without a connection counts after its last action, because it may be opening or reconnecting."""


class ProcessorTimes(NamedTuple):
    """Processor times since a fixed moment, in seconds.

    Programs of low priority, such as the computations of this program, are left out because they give way.
    """

    now: float
    all_programs: float
    """Time of all programs on the processors that this process may use."""
    own: float
    """Time of this process, and of the processes that compute for it."""
    loop: float
    """Time of the event loop of this process."""


class _Use(NamedTuple):
    """Average numbers of processors that other programs and the event loop used, over a time of `seconds`."""

    seconds: float
    others: float
    loop: float


class Capacity:
    """Measures the free processor time, and decides whether there is capacity for another page.

    Parameters
    ----------
    cores_per_page
        Processors that an active visitor uses.
    processes
        Number of server processes that share the processors. All processes are assumed to be equally busy.
    measure
        Returns the present processor times; called on the thread of the event loop.
    clock
        Monotonic clock, in seconds.
    cores
        Number of processors.

    Attributes
    ----------
    cores
        Number of processors available to this process, without the part that other programs use.
    loop
        Share of the time for which the event loop is busy.
    """

    def __init__(
        self,
        cores_per_page: float,
        processes: int,
        measure: Callable[[], ProcessorTimes],
        clock: Callable[[], float] = time.monotonic,
        cores: int | None = None,
    ) -> None:
        self._cores_per_page, self._processes, self._measure, self._clock = cores_per_page, processes, measure, clock
        self._all_cores = count_cores() if cores is None else cores
        self._times = measure()
        self._uses = deque[_Use](maxlen=WINDOW_SECONDS)
        self.cores = self._share_of(0.0)
        self.loop = 0.0

    def update(self) -> bool:
        """Measure unless the last measurement is less than a second old; return whether a measurement was made."""
        if self._clock() < self._times.now + 1.0:
            return False
        previous_times, self._times = self._times, self._measure()
        seconds, programs, own, loop = (new - old for new, old in zip(self._times, previous_times, strict=True))
        others = (programs - self._processes * own) / seconds
        if self._all_cores - programs / seconds < LEAST_SPARE:
            others = max(others, self._mean_others())
        self._uses.append(_Use(seconds, others, loop / seconds))
        self.cores = self._share_of(max(self._mean_others(), 0.0))
        self.loop = self._mean(use.loop for use in self._uses)
        return True

    def is_crowded(self, pages: Mapping[str, float]) -> bool:
        """Whether work that can wait should be postponed, given the number of pages by visitor."""
        return self.taken(pages) > CROWDED

    def has_room(self, pages: Mapping[str, float], visitor: str = "") -> bool:
        """Whether another page of a visitor is admitted, given the number of pages by visitor."""
        most_pages = OF_ONE_VISITOR * FULL * self.cores / self._cores_per_page
        counted = {other: count if other == visitor else min(count, most_pages) for other, count in pages.items()}
        return self.taken(counted | {visitor: counted.get(visitor, 0.0) + 1.0}) <= FULL

    def taken(self, pages: Mapping[str, float]) -> float:
        """Return the share of the processors that the pages may use, or the busy share of the event loop, whichever is larger."""
        return max(self._cores_per_page * sum(pages.values()) / self.cores, self.loop)

    def _mean_others(self) -> float:
        return self._mean(use.others for use in self._uses)

    def _mean(self, values: Iterable[float]) -> float:
        return fmean(values, [use.seconds for use in self._uses]) if self._uses else 0.0

    def _share_of(self, others: float) -> float:
        """Return the processors of this process when other programs use `others` processors."""
        return min(max((self._all_cores - others) / self._processes, LEAST_CORES), MOST_CORES)


def count_page(share: FairShare, *, connected: bool) -> float:
    """Return the fraction of a page that counts: less than 1 for an idle page, and 0 for a page that the visitor has left."""
    idle = share.idle_seconds()
    if not connected:
        return float(idle < CONNECTION_SECONDS)
    return 1.0 if idle < ACTING_SECONDS else IDLE_WEIGHT


def processor_times(low: float, elsewhere: float) -> ProcessorTimes:
    """Return the present processor times.

    Parameters
    ----------
    low
        Processor time that this process has used with low priority, in seconds.
    elsewhere
        Processor time that helper processes have used for this process, in seconds.
    """
    usable_numbers = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
    processors = [
        each for number, each in enumerate(psutil.cpu_times(percpu=True)) if usable_numbers is None or number in usable_numbers
    ]
    return ProcessorTimes(
        now=time.monotonic(),
        all_programs=sum(_urgent(each) for each in processors),
        own=time.process_time() - low + elsewhere,
        loop=time.thread_time(),
    )


def _urgent(times: Any) -> float:
    """Return the processor time of programs of normal priority, and of other virtual machines on the same processor."""
    return sum(getattr(times, name, 0.0) for name in ("user", "system", "irq", "softirq", "steal"))
