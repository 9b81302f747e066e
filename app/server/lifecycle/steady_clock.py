"""A clock for the event loop that does not change when the time of the machine is set.

Tornado schedules periodic callbacks by the time of day. When this time is set back by an hour, for example after the machine was
suspended, the callbacks stop for an hour. Then Bokeh neither removes old sessions nor pings browsers, and this server neither
measures its load nor notices visitors who have left.
"""

from __future__ import annotations

import time

from tornado.ioloop import IOLoop


def use_steady_clock() -> None:
    """Make event loops measure time with a monotonic clock. Call this before anything is scheduled."""
    IOLoop.time = _monotonic  # type: ignore[method-assign, assignment]


def _monotonic(_loop: IOLoop) -> float:
    return time.monotonic()
