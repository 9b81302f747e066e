"""What threads have to tell a page, scheduled where nothing else changes the page meanwhile: on the loop.

While a callback holds a page's changes back, to send them together, Bokeh and Panel collect in a list whatever the page is told,
and then put another list in its place. What a thread puts into the first one between the two is lost, and with it, if that was
the word that a picture is there, every later picture of the page.
"""

from __future__ import annotations

import asyncio
from contextlib import suppress

from bokeh.document.locking import LockedCallback

from app.bokeh_patches.own_ways import put_in_place

_their_schedule = getattr(LockedCallback, "_schedule", None)


def schedule_on_the_loop(loop: asyncio.AbstractEventLoop) -> None:
    """From now on, in this process.

    Parameters
    ----------
    loop
        That on which all pages are changed.
    """

    def schedule(callback: LockedCallback[...]) -> None:
        assert _their_schedule is not None
        if _running_loop() is loop:
            _their_schedule(callback)
            return
        # A loop that is closed has no pages any more.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(_their_schedule, callback)

    put_in_place(LockedCallback, "_schedule", schedule)


def _running_loop() -> asyncio.AbstractEventLoop | None:
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None
