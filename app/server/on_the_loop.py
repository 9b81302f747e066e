"""What a visitor does is answered where it is heard: on the loop that hears all visitors.

Bokeh hands every message and every callback to a thread and waits for it: turns of its loop, and of Python's lock, that take
longer than a move of a slider itself. Our callbacks submit and return, so that threads gain nothing; with them the first frame
comes twice as late to a visitor alone, and ten times as late to one of fifty.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Any

from bokeh.server import session

log = logging.getLogger(f"bokeh.{__name__}")

# Bokeh has no public place for it; in a version without this one everything works as Bokeh has it.
_HANDS_OVER = "_run_in_executor"


def answer_on_the_loop() -> None:
    """From now on, in this process."""
    if hasattr(session, _HANDS_OVER):
        setattr(session, _HANDS_OVER, call_here)
    else:
        log.warning("this version of Bokeh hands callbacks to threads in a way of its own")


async def call_here[Result](function: Callable[..., Result], *arguments: Any, **named: Any) -> Result:
    """The result of a call that nobody else makes."""
    return function(*arguments, **named)
