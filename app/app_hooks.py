"""Hooks that Bokeh calls when the server starts and stops, and for every session and request.

Bokeh runs this file, more than once, before it builds its web application. Each run checks the command line, extends the URL
patterns, and chooses the class of the HTTP server.
"""

from __future__ import annotations

import gc
import logging
import sys
import threading
import time
from functools import partial
from importlib import import_module
from typing import Any

from bokeh.server import urls
from bokeh.settings import settings as bokeh_settings
from tornado.httpserver import HTTPServer
from tornado.ioloop import PeriodicCallback

from app.browser.bokeh_patches.batched_patches import batch_patches
from app.browser.bokeh_patches.inline_callbacks import run_callbacks_inline
from app.runtime import disconnects, loop_watch
from app.runtime.health import StateCollector
from app.runtime.loop_watch import LoopWatch
from app.runtime.memory_allocation import RETURN_SECONDS, reduce_fragmentation, return_free_memory
from app.runtime.metrics import LogRecordCounter
from app.runtime.process_state import ProcessState, process_state
from app.server.admission import admit
from app.server.lifecycle.log_format import set_up_logs
from app.server.lifecycle.shutdown import finish_shutdown, stop_on_signals
from app.server.lifecycle.start_checks import SEVERAL_PROCESSES, asks_for_several_processes, refuse_to_start
from app.server.lifecycle.warmup import start_warmup
from app.server.limited_http_server import LimitedHTTPServer
from app.server.routes import install_handlers
from app.state.system_review import review_catalogue_entry
from engine import CASES
from engine.integrator.jit.compiling_process import compile_in

# Longest time for which a thread keeps the interpreter lock while others wait, in seconds; the default is 5 ms. A map needs the
# lock for a moment after each kernel, and each time would wait so long for a thread that makes a page.
_SWITCH_SECONDS = 0.001

# No process is forked yet. While Bokeh runs this file, only `sys.orig_argv` contains the whole command line.
if asks_for_several_processes(sys.orig_argv):
    refuse_to_start(SEVERAL_PROCESSES)
install_handlers(urls.per_app_patterns, urls.toplevel_patterns)
HTTPServer.configure(LimitedHTTPServer)


def on_server_loaded(server_context: Any) -> None:
    """Start the process state and everything that runs in the background."""
    reduce_fragmentation()
    sys.setswitchinterval(_SWITCH_SECONDS)
    state, context = _start_state(), server_context.application_context
    state.sessions = lambda: context.sessions
    state.metrics.registry.register(StateCollector(state))
    set_up_logs(state.settings.log, LogRecordCounter(state.metrics), [logging.getLogger(), logging.getLogger("panel")])
    # Tests validate the page. At run time Bokeh would warn about every closed section.
    bokeh_settings.perform_document_validation = False
    if state.settings.bokeh_patches:
        batch_patches()
        run_callbacks_inline()
    stop_on_signals(state, context.io_loop.stop)
    PeriodicCallback(disconnects.DisconnectMonitor(state.sessions).check, 1000.0 * disconnects.CHECK_SECONDS).start()
    PeriodicCallback(partial(context.io_loop.run_in_executor, None, return_free_memory), 1000.0 * RETURN_SECONDS).start()
    _watch_event_loop(state)
    compile_in(state.compiler)
    start_warmup(state)
    # Otherwise, the first request would wait for this import and for the reviews of the cases.
    import_module("app.session.page")
    for case in CASES:
        review_catalogue_entry(case)


def on_server_unloaded(server_context: Any) -> None:
    """Exit if the server was told to stop."""
    finish_shutdown(process_state())


def on_session_created(session_context: Any) -> None:
    """Count a new session, build its page, charge the time to the visitor, and record it for the capacity.

    Bokeh calls this hook on another thread, so the event loop serves other pages meanwhile. `main.py` would run on the loop.
    """
    state = process_state()
    state.metrics.sessions_created.inc()
    loop, document = session_context.server_context.application_context.io_loop.asyncio_loop, session_context.document
    page_time, begin = state.page_time(document), time.thread_time()
    import_module("app.session.page").build_page(document, loop)
    seconds = time.thread_time() - begin
    loop.call_soon_threadsafe(page_time.charge, seconds)
    loop.call_soon_threadsafe(state.capacity.record_page, seconds)


def on_session_destroyed(session_context: Any) -> None:
    """Count the end of a session."""
    process_state().metrics.sessions_destroyed.inc()


def process_request(request: Any) -> dict[str, Any]:
    """Refuse a request that may not create a session; add no entries to the token of the session."""
    admit(request)
    return {}


def _start_state() -> ProcessState:
    """Return the state of the process; an invalid setting ends the process with one sentence and exit code 2."""
    try:
        return process_state()
    except ValueError as error:
        refuse_to_start(str(error))


def _watch_event_loop(state: ProcessState) -> None:
    """Measure the delay of the running event loop at each tick, and find the causes of long delays on another thread."""
    watch = LoopWatch(state.load, state.metrics.loop_delays)
    gc.callbacks.append(watch.on_collection)
    PeriodicCallback(lambda: _measure_load(state, watch), 1000.0 * loop_watch.TICK_SECONDS).start()
    threading.Thread(target=watch.sample_stacks, args=[state.stopping], name="loop watch", daemon=True).start()


def _measure_load(state: ProcessState, watch: LoopWatch) -> None:
    """Measure the delay of the event loop, and postpone work while the load is high."""
    # A stopping server logs no delays, so that its last line says that it stops.
    if not state.stopping.is_set():
        watch.tick()
    state.adapt_to_load()
