"""The end: sessions are told, work is dropped, and the process is gone within seconds."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable
from typing import Any

import panel as pn
from panel.io.state import set_curdoc

from app.runtime.process_state import ProcessState

FAREWELL = "The server is restarting. Reload this page in a minute: its address holds the view."

# Messages to the pages need a moment to leave, and a proxy one to see that the server is not ready.
_GRACE_SECONDS = 0.5
# What computes looks every 50 ms or so whether it is still wanted; only a compiler does not.
_LAST_SECONDS = 4.0

log = logging.getLogger(f"bokeh.{__name__}")


def stop_gracefully_on_sigterm(site: ProcessState, stop_loop: Callable[[], None]) -> None:
    """Take the place of Bokeh's own handler of SIGTERM, which only stops the loop; to be called on the loop's thread."""
    loop = asyncio.get_running_loop()
    if os.name != "posix" or threading.current_thread() is not threading.main_thread():
        return

    def stop() -> None:
        begin_stop(site)
        loop.call_later(_GRACE_SECONDS, stop_loop)

    loop.add_signal_handler(signal.SIGTERM, stop)


def begin_stop(site: ProcessState) -> None:
    """Let nobody in, tell those who are there, drop all jobs, and see to it that the process ends."""
    if site.stopping.is_set():
        return
    site.stopping.set()
    log.info("stopping")
    _end_at_the_latest()
    for session in list(site.sessions()):
        _say_farewell(session.document)
    if site.jobs is not None:
        site.jobs.stop()


def end_stop(site: ProcessState) -> None:
    """End the process now that Bokeh has let go of everything: the interpreter would take seconds to take itself apart."""
    if site.stopping.is_set():
        logging.shutdown()
        sys.stdout.flush()
        os._exit(0)


def _say_farewell(document: Any) -> None:
    def say() -> None:
        with set_curdoc(document):
            if pn.state.notifications is not None:
                pn.state.notifications.warning(FAREWELL, duration=0)

    try:
        document.add_next_tick_callback(say)
    except Exception:
        # One page's fault keeps no other from hearing it.
        log.exception("a page could not be told")


def _end_at_the_latest() -> None:
    """End the process, should something not let go of it: nothing here writes a file that a sudden end could halve."""
    timer = threading.Timer(_LAST_SECONDS, os._exit, [0])
    timer.daemon = True
    timer.start()
