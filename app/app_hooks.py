"""What Bokeh's server calls at turning points of its life and of its sessions' lives, however it was started.

The server runs this file more than once, so nothing is kept here.
"""

from __future__ import annotations

import asyncio
import logging
import sys
from importlib import import_module
from typing import Any

from bokeh.server import urls
from bokeh.settings import settings
from tornado.ioloop import PeriodicCallback

from app.bokeh_patches.held_changes import hold_changes
from app.bokeh_patches.on_the_loop import answer_on_the_loop
from app.bokeh_patches.one_message import send_changes_together
from app.bokeh_patches.prompt_sockets import use_prompt_sockets
from app.bokeh_patches.quick_defaults import look_defaults_up_once
from app.bokeh_patches.told_by_threads import schedule_on_the_loop
from app.runtime import load_monitor
from app.runtime.disconnects import LOOKED_AT_EVERY, DisconnectMonitor
from app.runtime.job_pool import is_waited, shared_jobs
from app.runtime.load_monitor import process_load_monitor
from app.runtime.metrics import FaultCounter, process_metrics
from app.runtime.process_state import process_state
from app.server.admission import admit
from app.server.bokeh_application import find_web_application
from app.server.endpoints import add_routes
from app.server.gc_policy import GarbagePolicy
from app.server.log_format import set_up_logs
from app.server.security_headers import SecurityTransform
from app.server.shutdown import end_stop, stop_gracefully_on_sigterm
from app.server.warmup import prepare_in_background

SWITCH_SECONDS = 0.001
"""How long a thread keeps Python to itself while others wait: with Python's own 5 ms thirty visitors wait 1.7 times as long."""

# Before the first visitor comes, who would wait for it; where a setting is of no use, the server ends here.
import_module("app.session.explorer")

# Before Bokeh builds its web application from the lists, as Panel puts its own pages there.
add_routes(urls.toplevel_patterns)
use_prompt_sockets(urls.per_app_patterns)


def on_server_loaded(server_context: Any) -> None:
    """Begin to compile, or to load what is compiled; the server answers meanwhile."""
    site, context = process_state(), server_context.application_context
    set_up_logs(site.settings.log, FaultCounter(process_metrics()), [logging.getLogger(), logging.getLogger("panel")])
    find_web_application(server_context).add_transform(SecurityTransform)
    site.sessions, site.jobs = lambda: context.sessions, shared_jobs()
    PeriodicCallback(DisconnectMonitor(site.sessions).look, 1000.0 * LOOKED_AT_EVERY).start()
    PeriodicCallback(_give_way, 1000.0 * load_monitor.LOOKED_AT_EVERY).start()
    PeriodicCallback(GarbagePolicy(is_waited).look, 1000.0).start()
    sys.setswitchinterval(SWITCH_SECONDS)
    # A part of a message that the socket takes at once needs no turn of the loop; there are a dozen of them to a frame.
    loop = context.io_loop.asyncio_loop
    loop.set_task_factory(asyncio.eager_task_factory)
    schedule_on_the_loop(loop)
    # That a page is sound is for tests to show, not to be looked at anew for each visitor while all others wait.
    settings.perform_document_validation = False
    look_defaults_up_once()
    hold_changes()
    send_changes_together()
    answer_on_the_loop()
    stop_gracefully_on_sigterm(site, context.io_loop.stop)
    prepare_in_background(site)


def _give_way() -> None:
    process_load_monitor().tick()
    shared_jobs().put_off_tiles(process_load_monitor().is_high())


def on_server_unloaded(server_context: Any) -> None:
    """The last that Bokeh calls."""
    end_stop(process_state())


def on_session_created(session_context: Any) -> None:
    """Count it."""
    process_metrics().created.inc()


def on_session_destroyed(session_context: Any) -> None:
    """Count it."""
    process_metrics().destroyed.inc()


def process_request(request: Any) -> dict[str, Any]:
    """Let a visitor in, or send them away with a sentence; nothing is noted of them."""
    admit(request)
    return {}
