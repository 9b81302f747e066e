"""What a session does is done where it is asked for, between the messages of all visitors.

Bokeh hands every message, callback and answer to a thread and waits for it: several turns of its loop and as many handings over
of Python's lock for a move of a slider that is a millisecond of work. As no callback of ours waits or computes, threads gain
nothing.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from bokeh.server import session

log = logging.getLogger(f"bokeh.{__name__}")

# Bokeh has no public place for it; in a version without these everything works as Bokeh has it.
_HANDS_OVER = "_run_in_executor"


def stay_on_the_loop() -> None:
    """From now on, in this process."""
    for place in (session, session.ServerSession):
        if hasattr(place, _HANDS_OVER):
            setattr(place, _HANDS_OVER, _call if place is session else _call_of_session)
        else:
            log.warning("this version of Bokeh hands callbacks to threads in a way of its own")


async def _call[Result](function: Callable[..., Result], *arguments: Any, **named: Any) -> Result:
    return function(*arguments, **named)


async def _call_of_session[Result](_: session.ServerSession, function: Callable[..., Result], *arguments: Any) -> Result:
    return function(*arguments)
