"""Graceful shutdown: notify the pages, cancel all jobs and end the process within seconds."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import sys
import threading
from collections.abc import Callable
from typing import Any

from app.runtime.process_state import ProcessState
from app.views.components.notice import show_lasting_notice

RESTART_NOTICE = "The server is restarting. Reload this page in a minute: its address holds the view."

# Time for messages to reach the pages, and for a proxy to notice that the server is not ready.
_GRACE_SECONDS = 0.5
# Computations check for cancellation about every 50 ms; a compilation cannot be cancelled.
_LAST_SECONDS = 4.0

log = logging.getLogger(f"bokeh.{__name__}")


def stop_gracefully_on_sigterm(state: ProcessState, stop_loop: Callable[[], None]) -> None:
    """Replace Bokeh's handler of SIGTERM, which only stops the event loop; call on the thread of the loop."""
    loop = asyncio.get_running_loop()
    if os.name != "posix" or threading.current_thread() is not threading.main_thread():
        return

    def stop() -> None:
        begin_shutdown(state)
        loop.call_later(_GRACE_SECONDS, stop_loop)

    loop.add_signal_handler(signal.SIGTERM, stop)


def begin_shutdown(state: ProcessState) -> None:
    """Refuse new sessions, notify the pages, cancel all jobs and limit the time until the process ends."""
    if state.stopping.is_set():
        return
    state.stopping.set()
    log.info("stopping")
    _exit_later()
    for session in list(state.sessions()):
        _notify(session.document)
    state.jobs.stop()


def finish_shutdown(state: ProcessState) -> None:
    """Exit after Bokeh has released its resources; a regular exit of the interpreter would take seconds."""
    if state.stopping.is_set():
        logging.shutdown()
        sys.stdout.flush()
        os._exit(0)


def _notify(document: Any) -> None:
    try:
        document.add_next_tick_callback(lambda: show_lasting_notice(document, RESTART_NOTICE))
    except Exception:
        # Continue with the other pages.
        log.exception("a page could not be notified")


def _exit_later() -> None:
    """End the process after `_LAST_SECONDS`; no file is written here that an exit could truncate."""
    timer = threading.Timer(_LAST_SECONDS, os._exit, [0])
    timer.daemon = True
    timer.start()
