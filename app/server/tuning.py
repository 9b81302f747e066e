"""Performance changes to Python's, Bokeh's and Panel's defaults; each can be switched off in the settings.

===================== ================================================================================================
name                  effect
===================== ================================================================================================
``batched_patches``   All changes of a callback are sent as one message (`app.bokeh_patches.batched_patches`).
``inline_callbacks``  Messages and callbacks run on the event loop, not in a thread (`app.bokeh_patches.inline_callbacks`).
``tcp_nodelay``       Nagle's algorithm is off on WebSockets (`app.server.url_patterns`).
``no_validation``     Bokeh does not validate the document of each new page; a test does (``BOKEH_VALIDATE_DOC``).
``eager_tasks``       Asyncio tasks start at once; most parts of a message then need no iteration of the event loop.
``switch_interval``   Threads release the interpreter lock after 1 ms, not 5 ms: 1.7 times shorter waits with 30 visitors.
``gc_policy``         Full garbage collections wait until the server is idle (`app.server.gc_policy`).
===================== ================================================================================================
"""

from __future__ import annotations

import asyncio
import sys

from bokeh.settings import settings as bokeh_settings
from tornado.ioloop import PeriodicCallback

from app.bokeh_patches.batched_patches import batch_patches
from app.bokeh_patches.inline_callbacks import run_callbacks_inline
from app.runtime.process_state import ProcessState
from app.runtime.settings import Tuning
from app.server.gc_policy import CHECK_SECONDS, GarbagePolicy

SWITCH_SECONDS = 0.001
"""Interval after which a thread releases the interpreter lock when others wait for it."""


def apply_tuning(state: ProcessState, loop: asyncio.AbstractEventLoop) -> None:
    """Apply the enabled changes; call on the event loop when the server starts."""
    enabled = state.settings.tuning
    if Tuning.BATCHED_PATCHES in enabled:
        batch_patches()
    if Tuning.INLINE_CALLBACKS in enabled:
        run_callbacks_inline()
    if Tuning.NO_VALIDATION in enabled:
        bokeh_settings.perform_document_validation = False
    if Tuning.EAGER_TASKS in enabled:
        loop.set_task_factory(asyncio.eager_task_factory)
    if Tuning.SWITCH_INTERVAL in enabled:
        sys.setswitchinterval(SWITCH_SECONDS)
    if Tuning.GC_POLICY in enabled:
        PeriodicCallback(GarbagePolicy(state.is_busy).check, 1000.0 * CHECK_SECONDS).start()
