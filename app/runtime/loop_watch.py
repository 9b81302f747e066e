"""The delay of the event loop. While the delay is high, work is postponed. Causes of long delays are logged.

A callback runs periodically on the loop. While a run is overdue, a thread reads the stack of the loop's thread.
"""

from __future__ import annotations

import logging
import sys
import threading
import time
import traceback
from collections import Counter
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from types import CodeType, FrameType

from prometheus_client import Histogram

TICK_SECONDS = 0.02
"""Interval between two calls of `LoadMonitor.tick`, in seconds."""

HIGH_SECONDS = 0.05
"""Delay of a tick above which the load is high, in seconds."""

# Factor by which the delay decays per tick: 0.7 in 0.1 s. The load is normal again half a second after a peak of 0.3 s.
_DECAY = 0.7 ** (TICK_SECONDS / 0.1)

LONGEST_HIGH_SECONDS = 2.0
"""Time after which a high load counts as normal for one tick, in seconds, so that postponed work is not blocked for ever."""


class LoadMonitor:
    """Measures the delay of a periodic callback on the event loop.

    Parameters
    ----------
    clock
        Monotonic clock, in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._due: float | None = None
        self._high_since: float | None = None
        # Largest delay of a tick so far, in seconds, with exponential decay.
        self._recent_delay = 0.0

    def tick(self) -> float:
        """Return the delay of this tick, in seconds. Call this every `TICK_SECONDS` on the event loop."""
        now = self._clock()
        delay = max(0.0, now - self._due) if self._due is not None else 0.0
        self._recent_delay = max(delay, _DECAY * self._recent_delay)
        self._due = now + TICK_SECONDS
        if self._recent_delay <= HIGH_SECONDS or (self._high_since is not None and now - self._high_since > LONGEST_HIGH_SECONDS):
            self._high_since = None
        elif self._high_since is None:
            self._high_since = now
        return delay

    def overdue_seconds(self) -> float:
        """Return the time since the next tick was due, in seconds; negative before. Any thread may call this."""
        return self._clock() - self._due if self._due is not None else 0.0

    def is_high(self) -> bool:
        """Whether work other than first frames should be postponed."""
        return self._high_since is not None


SLOW_SECONDS = 0.05
"""Duration above which an iteration of the event loop is logged and counted, in seconds."""

# Delay above which a tick is reported, in seconds. A slow iteration may begin up to one interval before the tick is due, and then
# delays the tick by less than its own duration.
_REPORTED_DELAY = SLOW_SECONDS - TICK_SECONDS
# Interval at which the stack is read, in seconds.
_SAMPLE_SECONDS = 0.5 * TICK_SECONDS
# Folder of the app.
_APP_FOLDER = Path(__file__).parents[1]
# Folders of the app whose functions only relay calls to other functions.
_RELAYING_FOLDERS = ("runtime", "server", "browser/bokeh_patches")
# Modules outside the app that run the loop. If the stack contains nothing else, the loop waits for events or for a processor.
_LOOP_MODULES = (
    "asyncio",
    "selectors",
    "tornado.platform",
    "tornado.ioloop",
    "threading",
    "panel.command",
    "bokeh.command",
    "bokeh.server.server",
)

WAITING = "none: the thread waited for the interpreter lock or a processor"
"""Cause of a delay during which no callback was seen on the loop."""

log = logging.getLogger(f"bokeh.{__name__}")


class LoopWatch:
    """Logs and counts iterations of the event loop that take longer than `SLOW_SECONDS`. Construct it on the loop's thread.

    The duration of an iteration is known only to within `TICK_SECONDS`, so iterations that are shorter than `SLOW_SECONDS` by up
    to `TICK_SECONDS` may be reported.

    Parameters
    ----------
    load
        Measures the delay of the ticks.
    delays
        Histogram of the delays by cause, in seconds.
    processor_time
        Returns the processor time of the calling thread, in seconds.
    """

    def __init__(self, load: LoadMonitor, delays: Histogram, processor_time: Callable[[], float] = time.thread_time) -> None:
        self._load, self._delays, self._processor_time = load, delays, processor_time
        self._thread = threading.get_ident()
        # Causes that were found since the last tick.
        self._samples: list[str] = []
        self._last_processor_time = self._processor_time()
        # Processor time of the loop's thread at the beginning of the present garbage collection.
        self._collection_begin = 0.0
        # Processor time of the garbage collections since the last tick.
        self._collection_seconds = 0.0

    def on_collection(self, phase: str, info: dict[str, int]) -> None:
        """Measure garbage collections on the loop's thread. Any allocation may start one. `gc.callbacks` contains this method."""
        if threading.get_ident() != self._thread:
            return
        if phase == "start":
            self._collection_begin = self._processor_time()
        else:
            self._collection_seconds += self._processor_time() - self._collection_begin

    def tick(self) -> None:
        """Measure the delay, and report a long delay. Call this every `TICK_SECONDS` on the event loop."""
        delay = self._load.tick()
        own_seconds = self._processor_time() - self._last_processor_time
        self._last_processor_time = self._processor_time()
        collection_seconds, self._collection_seconds = self._collection_seconds, 0.0
        samples, self._samples = self._samples, []
        if delay > _REPORTED_DELAY:
            cause = Counter(samples).most_common(1)[0][0] if samples else WAITING
            self._delays.labels(cause).observe(delay)
            # Other threads and processes also delay the loop, so the message contains the loop's own processor time.
            log.info(
                "event loop %.0f ms late, %.0f ms of its own, with %.0f ms of garbage collection; cause: %s",
                *(1000.0 * seconds for seconds in (delay, own_seconds, collection_seconds)), cause,
            )  # fmt: skip

    def sample_stacks(self, stopping: threading.Event) -> None:
        """Read the loop's stack repeatedly while a tick is overdue, until the server stops. Call this on a separate thread."""
        while not stopping.wait(_SAMPLE_SECONDS):
            frame = sys._current_frames().get(self._thread) if self._load.overdue_seconds() > _SAMPLE_SECONDS else None
            if frame is not None:
                self._samples.append(find_cause(frame))


def find_cause(innermost: FrameType) -> str:
    """Return the outermost function of the app that does more than relay calls, given the innermost frame of the loop's stack.

    Without such a function, return another function of the app, of a library, or both; without these, `WAITING`.
    """
    # The outermost frame comes first.
    frames = [frame for frame, _ in traceback.walk_stack(innermost)][::-1]
    app_places = [place for place in (_place_in_app(frame.f_code) for frame in frames) if place is not None]
    library_places = [place for place in map(_place_in_library, frames) if place is not None]
    own_places = [place for place in app_places if not place.startswith(_RELAYING_FOLDERS)]
    if own_places:
        return own_places[0]
    if not app_places:
        return library_places[0] if library_places else WAITING
    return f"{app_places[0]}, {library_places[-1]}" if library_places else app_places[0]


# Without the cache, one reading of a stack takes a millisecond, in which the loop waits for the interpreter lock.
@lru_cache(maxsize=4096)
def _place_in_app(code: CodeType) -> str | None:
    """Return file and function of code in the app; None for other code."""
    path = Path(code.co_filename)
    return f"{path.relative_to(_APP_FOLDER).with_suffix('')}: {code.co_qualname}" if path.is_relative_to(_APP_FOLDER) else None


def _place_in_library(frame: FrameType) -> str | None:
    """Return module and function of a frame in a library; None for the app, Python's own modules and `_LOOP_MODULES`."""
    module = frame.f_globals.get("__name__", "")
    top = module.partition(".")[0]
    if top in sys.stdlib_module_names or top in ("__main__", "app", "") or module.startswith(_LOOP_MODULES):
        return None
    return f"{module}: {frame.f_code.co_qualname}"
