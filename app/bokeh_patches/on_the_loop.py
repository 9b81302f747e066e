"""What a visitor does is answered where it is heard: on the loop that hears all visitors.

Bokeh hands every message and every callback to a thread and waits for it: turns of its loop, and of Python's lock, that take
longer than a move of a slider itself. Our callbacks submit and return, so that threads gain nothing; with them the first frame
comes twice as late to a visitor alone, and ten times as late to one of fifty.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from bokeh.server import session

from app.bokeh_patches.own_ways import put_in_place


def answer_on_the_loop() -> None:
    """From now on, in this process."""
    put_in_place(session, "_run_in_executor", call_here)


async def call_here[Result](function: Callable[..., Result], *arguments: Any, **named: Any) -> Result:
    """The result of a call that nobody else makes."""
    return function(*arguments, **named)
