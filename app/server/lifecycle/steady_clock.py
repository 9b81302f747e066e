"""The clock of the event loop, which goes on when the time of the machine is set.

Tornado schedules periodic callbacks by the time of day: when that is set back by an hour, for example after the machine was
suspended, they stop for an hour. Then Bokeh neither removes old sessions nor pings browsers, and this server neither measures its
load nor notices visitors who have left.
"""

from __future__ import annotations

import time

from tornado.ioloop import IOLoop


def use_steady_clock() -> None:
    """Let event loops measure time with a monotonic clock; call before anything is scheduled."""
    IOLoop.time = _monotonic  # type: ignore[method-assign, assignment]


def _monotonic(_loop: IOLoop) -> float:
    return time.monotonic()
