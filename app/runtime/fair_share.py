"""The share of the event loop's time that the pages of a visitor may use. Visitors who use more must wait.

One thread serves all pages of a process, so pages that keep the thread busy delay all other pages.
"""

from __future__ import annotations

import time
import types
from collections.abc import Callable, Coroutine, Generator
from functools import partial
from typing import Any

SHARE = 0.5
"""Largest share of the thread's time for one visitor in the long run. A drag with 30 messages per second uses 0.2."""

BURST_SECONDS = 3.0
"""Longest time that a visitor may use at once after a pause, in seconds. It is also the longest time that a visitor can owe."""


class FairShare:
    """Limits the processor time that a visitor uses on the event loop, and on the thread on which pages are built.

    Parameters
    ----------
    clock
        Monotonic clock, in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        # Time that the visitor may use now, in seconds; negative if the visitor owes time.
        self._balance = BURST_SECONDS
        self._last_refill = clock()

    def charge(self, seconds: float) -> None:
        """Charge processor time that the visitor used."""
        self._refill()
        self._balance = max(self._balance - seconds, -BURST_SECONDS)

    def _refill(self) -> None:
        """Add the share of the time since the last call to the balance."""
        now = self._clock()
        self._balance = min(self._balance + SHARE * (now - self._last_refill), BURST_SECONDS)
        self._last_refill = now

    def wait_seconds(self) -> float:
        """Return the time until the visitor may use more time, in seconds: 0 unless the visitor owes time."""
        self._refill()
        return max(0.0, -self._balance / SHARE)


class PageTime:
    """Charges the processor time of a page's messages and callbacks to the share of its visitor.

    Parameters
    ----------
    share
        The share of the visitor.
    clock
        Monotonic clock, in seconds.
    busy_clock
        Processor time of the event loop's thread, in seconds. Unlike elapsed time, it leaves out waiting for the interpreter
        lock, for example during a compilation.
    """

    def __init__(
        self,
        share: FairShare,
        clock: Callable[[], float] = time.monotonic,
        busy_clock: Callable[[], float] = time.thread_time,
    ) -> None:
        self.share = share
        self._clock, self._busy_clock = clock, busy_clock
        self._last_use = clock()

    def charge(self, seconds: float) -> None:
        """Charge processor time that the page used."""
        self.share.charge(seconds)
        if seconds:
            self._last_use = self._clock()

    def idle_seconds(self) -> float:
        """Return the time since the page last used the event loop, or else since it was opened, in seconds."""
        return self._clock() - self._last_use

    @types.coroutine
    def charge_for[Result](self, coroutine: Coroutine[Any, Any, Result]) -> Generator[Any, Any, Result]:
        """Await a coroutine, and charge the processor time of its steps. Code that runs while the coroutine waits is free.

        A generator-based coroutine can resume the given coroutine step by step, which ``await`` cannot.
        """
        step: Callable[[], Any] = partial(coroutine.send, None)
        while True:
            begin = self._busy_clock()
            try:
                awaited = step()
            except StopIteration as end:
                return end.value
            finally:
                self.charge(self._busy_clock() - begin)
            try:
                yield awaited
            except BaseException as error:
                step = partial(coroutine.throw, error)
            else:
                step = partial(coroutine.send, None)
