"""Messages and callbacks of Bokeh on the event loop, without a thread.

This replaces ``_run_in_executor`` in ``bokeh.server.session``, which runs each callback in a thread and waits for the thread.
The additional iterations of the event loop and switches of the interpreter lock take longer than most callbacks. They make the
first frame twice as late for a single session, and ten times as late with 50 sessions. The callbacks of this page only submit
jobs and return, so they need no thread.

The change for upstream is ``inline_callbacks.patch``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from bokeh.server import session


def run_callbacks_inline() -> None:
    """Replace Bokeh's function in this process."""
    session._run_in_executor = call_inline


async def call_inline[Result](function: Callable[..., Result], *args: Any, **kwargs: Any) -> Result:
    """Call a function in this thread and return its result."""
    return function(*args, **kwargs)
