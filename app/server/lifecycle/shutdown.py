"""Graceful shutdown: the pages are notified, all jobs are cancelled, and the process ends within seconds."""

from __future__ import annotations

import asyncio
import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable
from typing import Any

from app.runtime.process_state import ProcessState
from app.views.components.notice import show_lasting_notice

RESTART_NOTICE = "The server is restarting. This page returns with its view when the server answers."

# Time for messages to reach the pages, and for a proxy to notice that the server is not ready, in seconds.
_GRACE_SECONDS = 0.5
# Longest time until the process ends, in seconds. Computations check for cancellation every 50 ms or so.
_EXIT_DELAY_SECONDS = 4.0

_SIGNALS = (signal.SIGTERM, signal.SIGINT)

log = logging.getLogger(f"bokeh.{__name__}")


def stop_on_signals(state: ProcessState, stop_loop: Callable[[], None]) -> None:
    """Stop gracefully on SIGTERM and Ctrl-C, even while the event loop is busy. Call this on the thread of the loop.

    This replaces the handlers of Bokeh and asyncio, which wait for the event loop. Python writes a signal's number to a socket
    at once, and a thread reads it. Only a C function that keeps the interpreter lock delays this thread, like all others.
    """
    loop = asyncio.get_running_loop()
    # On Windows, asyncio has no signal handlers. Python sets signal handlers only on the main thread.
    if os.name != "posix" or threading.current_thread() is not threading.main_thread():
        return
    loop.remove_signal_handler(signal.SIGTERM)
    for number in _SIGNALS:
        # A shell starts background jobs with SIGINT ignored. They must continue to ignore it.
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _ignore_signal)
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    signal.set_wakeup_fd(sender.detach(), warn_on_full_buffer=False)

    def stop() -> None:
        begin_shutdown(state)
        loop.call_soon_threadsafe(_notify_pages, state)
        loop.call_soon_threadsafe(loop.call_later, _GRACE_SECONDS, stop_loop)

    threading.Thread(target=_wait_for_signal, args=(receiver, stop), name="signals", daemon=True).start()


def begin_shutdown(state: ProcessState) -> None:
    """Refuse new sessions, cancel all jobs, and limit the time until the process ends. Any thread may call this."""
    _exit_later()
    state.stopping.set()
    log.info("stopping")
    state.jobs.stop()
    state.limited.close()
    state.compiler.close()


def finish_shutdown(state: ProcessState) -> None:
    """Exit at once if the server is stopping. A regular exit of the interpreter would take seconds."""
    if state.stopping.is_set():
        logging.shutdown()
        sys.stdout.flush()
        os._exit(0)


def _ignore_signal(number: int, frame: Any) -> None:
    """Do nothing: the thread that runs `_wait_for_signal` handles the signal."""


def _wait_for_signal(receiver: socket.socket, stop: Callable[[], None]) -> None:
    """Call `stop` after the first signal of `_SIGNALS`. Other signals keep their handlers."""
    while receiver.recv(1)[0] not in _SIGNALS:
        pass
    stop()


def _notify_pages(state: ProcessState) -> None:
    for session in list(state.sessions()):
        try:
            session.document.add_next_tick_callback(
                lambda document=session.document: show_lasting_notice(document, RESTART_NOTICE)
            )
        except Exception:
            # Continue with the other pages.
            log.exception("a page could not be notified")


def _exit_later() -> None:
    """End the process after `_EXIT_DELAY_SECONDS`. No file can be truncated: files of the cache are written atomically."""
    timer = threading.Timer(_EXIT_DELAY_SECONDS, os._exit, [0])
    timer.daemon = True
    timer.start()
