"""Before the first visitor: compile the kernels, or load them from the cache."""

from __future__ import annotations

import logging
from typing import Any

from tornado.websocket import WebSocketClosedError

from app.views import orbit_panes
from engine import CASES, prepare_kernels

# Below Bokeh's logger, so that `panel serve` shows it: the first start takes long enough to want a word.
log = logging.getLogger(f"bokeh.{__name__}")


def is_worth_a_word(record: logging.LogRecord) -> bool:
    """False for the report that a visitor left while a message was on its way to them: that is no fault."""
    return record.exc_info is None or not isinstance(record.exc_info[1], WebSocketClosedError)


def on_server_loaded(_context: Any) -> None:
    """Run every kernel of every case once; the first time on a machine that takes some seconds a case."""
    logging.getLogger("asyncio").addFilter(is_worth_a_word)
    for name, potential in CASES.items():
        log.info("preparing the kernels of case %s", name)
        prepare_kernels(potential)
    orbit_panes.prepare()
    log.info("ready")
