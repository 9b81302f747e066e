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
from bokeh.settings import settings as bokeh_settings
from tornado.ioloop import PeriodicCallback

from app import pressure
from app.pressure import this_pressure
from app.server.admission import admit
from app.server.bokeh_application import find_web_application
from app.server.figures import FaultCounter, these_figures
from app.server.garbage import Garbage
from app.server.held_changes import hold_changes
from app.server.left_pages import LOOKED_AT_EVERY, LeftPages
from app.server.logs import set_up_logs
from app.server.on_the_loop import answer_on_the_loop
from app.server.one_message import send_changes_together
from app.server.pages import add_routes
from app.server.preparation import prepare_in_background
from app.server.prompt_sockets import use_prompt_sockets
from app.server.quick_defaults import look_defaults_up_once
from app.server.security_headers import SecurityTransform
from app.server.shutdown import end_stop, stop_gracefully_on_sigterm
from app.server.site import this_site
from app.server.told_by_threads import schedule_on_the_loop
from app.shared_jobs import is_waited, shared_jobs

SWITCH_SECONDS = 0.001
"""How long a thread keeps Python to itself while others wait: with Python's own 5 ms thirty visitors wait 1.7 times as long."""

# Before the first visitor comes, who would wait for it; where a setting is of no use, the server ends here.
import_module("app.explorer")

# Before Bokeh builds its web application from the lists, as Panel puts its own pages there.
add_routes(urls.toplevel_patterns)
use_prompt_sockets(urls.per_app_patterns)


def on_server_loaded(server_context: Any) -> None:
    """Begin to compile, or to load what is compiled; the server answers meanwhile."""
    site, context = this_site(), server_context.application_context
    set_up_logs(site.settings.log, FaultCounter(these_figures()), [logging.getLogger(), logging.getLogger("panel")])
    find_web_application(server_context).add_transform(SecurityTransform)
    site.sessions, site.jobs = lambda: context.sessions, shared_jobs()
    PeriodicCallback(LeftPages(site.sessions).look, 1000.0 * LOOKED_AT_EVERY).start()
    PeriodicCallback(_give_way, 1000.0 * pressure.LOOKED_AT_EVERY).start()
    PeriodicCallback(Garbage(is_waited).look, 1000.0).start()
    sys.setswitchinterval(SWITCH_SECONDS)
    # A part of a message that the socket takes at once needs no turn of the loop; there are a dozen of them to a frame.
    loop = context.io_loop.asyncio_loop
    loop.set_task_factory(asyncio.eager_task_factory)
    schedule_on_the_loop(loop)
    # That a page is sound is for tests to show, not to be looked at anew for each visitor while all others wait.
    bokeh_settings.perform_document_validation = False
    look_defaults_up_once()
    hold_changes()
    send_changes_together()
    answer_on_the_loop()
    stop_gracefully_on_sigterm(site, context.io_loop.stop)
    prepare_in_background(site)


def _give_way() -> None:
    this_pressure().tick()
    shared_jobs().put_off_tiles(this_pressure().is_high())


def on_server_unloaded(server_context: Any) -> None:
    """The last that Bokeh calls."""
    end_stop(this_site())


def on_session_created(session_context: Any) -> None:
    """Count it."""
    these_figures().created.inc()


def on_session_destroyed(session_context: Any) -> None:
    """Count it."""
    these_figures().destroyed.inc()


def process_request(request: Any) -> dict[str, Any]:
    """Let a visitor in, or send them away with a sentence; nothing is noted of them."""
    admit(request)
    return {}
