"""The share of the event loop's time that one page may use. Above it, the page's messages wait.

One thread serves all pages of a process, so a page that keeps the thread busy delays all others.
"""

from __future__ import annotations

import time
import types
from collections.abc import Callable, Coroutine, Generator
from functools import partial
from typing import Any

SHARE = 0.5
"""Largest share of the thread's time that a page uses in the long run; drags with 30 messages per second use 0.2."""

BURST_SECONDS = 3.0
"""Time that a page may use at once after a pause, and limit of the time that it can be in arrears."""


class FairShare:
    """Counts the processor time that the messages and callbacks of a page use on the event loop.

    Parameters
    ----------
    clock
        Seconds of a monotonic clock.
    busy_clock
        Processor time of the event loop's thread. Time in which the thread waits for the interpreter lock, for example during a
        compilation, does not count.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic, busy_clock: Callable[[], float] = time.thread_time) -> None:
        self._clock, self._busy_clock = clock, busy_clock
        self._left, self._last = BURST_SECONDS, clock()
        self._acted = self._last

    def take(self, seconds: float) -> None:
        """Count processor time of the event loop."""
        now = self._clock()
        left = min(self._left + SHARE * (now - self._last), BURST_SECONDS) - seconds
        self._left, self._last = max(left, -BURST_SECONDS), now
        if seconds:
            self._acted = now

    def idle_seconds(self) -> float:
        """Time since the page last used the event loop, or since it was opened."""
        return self._clock() - self._acted

    def wait_seconds(self) -> float:
        """Time until the next message may be handled; 0 within the share."""
        self.take(0.0)
        return max(0.0, -self._left / SHARE)

    @types.coroutine
    def count[Result](self, coroutine: Coroutine[Any, Any, Result]) -> Generator[Any, Any, Result]:
        """Await a coroutine and count the processor time of its steps, without that of other code that runs while it waits."""
        step: Callable[[], Any] = partial(coroutine.send, None)
        while True:
            begin = self._busy_clock()
            try:
                awaited = step()
            except StopIteration as end:
                result: Result = end.value
                return result
            finally:
                self.take(self._busy_clock() - begin)
            try:
                yield awaited
            except BaseException as error:
                step = partial(coroutine.throw, error)
            else:
                step = partial(coroutine.send, None)
