"""The log: lines of text, or of JSON, that no visitor can forge."""

from __future__ import annotations

import json
import logging
import sys
from collections.abc import Iterable
from datetime import UTC, datetime
from typing import Any

import panel as pn
from tornado.websocket import WebSocketClosedError

from app.runtime.settings import LogFormat

_SHOWN_OF_SESSION = 8
_TRACEBACK_INDENT = "    "


def session_mark() -> str | None:
    """The beginning of the current session's id; None outside of sessions.

    Whoever knows the whole id can join the session, so the log does not hold it.
    """
    document = pn.state.curdoc
    context = document.session_context if document is not None else None
    return str(context.id)[:_SHOWN_OF_SESSION] if context is not None else None


def add_session_mark(record: logging.LogRecord) -> bool:
    """Note whose session a record is of; a filter that lets all pass."""
    record.session = session_mark()
    return True


def is_worth_a_word(record: logging.LogRecord) -> bool:
    """False for the report that a visitor left while a message was on its way to them: that is no fault."""
    return record.exc_info is None or not isinstance(record.exc_info[1], WebSocketClosedError)


def is_no_probe(record: logging.LogRecord) -> bool:
    """False for a request whose answer, that the server is not ready, is no fault."""
    return " /readiness " not in record.getMessage()


def one_line(text: str) -> str:
    """A text in which control characters, line ends among them, are written out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)


class TextFormatter(logging.Formatter):
    """Time, level, logger and message on a line; lines of a traceback are indented, so that none looks like a record."""

    def format(self, record: logging.LogRecord) -> str:
        """The record as text."""
        session = getattr(record, "session", None)
        where = f"{record.name} [{session}]" if session else record.name
        line = f"{self.formatTime(record)} {record.levelname} {where}: {one_line(record.getMessage())}"
        if record.exc_info:
            trace = self.formatException(record.exc_info).splitlines()
            line = "\n".join([line, *(_TRACEBACK_INDENT + one_line(traced) for traced in trace)])
        return line


class JsonFormatter(logging.Formatter):
    """One JSON object on a line."""

    def format(self, record: logging.LogRecord) -> str:
        """The record as JSON: time in UTC, level, logger, message, and where there are any session, exception and traceback."""
        told: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage(),
        }
        if session := getattr(record, "session", None):
            told["session"] = session
        if record.exc_info and record.exc_info[0] is not None:
            told["exception"] = record.exc_info[0].__qualname__
            told["traceback"] = self.formatException(record.exc_info)
        # Escapes line ends, and all that is not ASCII.
        return json.dumps(told)


def set_up_logs(form: LogFormat, counter: logging.Handler, loggers: Iterable[logging.Logger]) -> None:
    """Have all that is logged in this process written in one form, and counted.

    Parameters
    ----------
    form
        Of a line.
    counter
        A handler that sees every record, too.
    loggers
        Those with handlers of their own: the root, and Panel's. What writes to stdout is turned to stderr.
    """
    for logger in loggers:
        for handler in logger.handlers:
            handler.setFormatter(JsonFormatter() if form is LogFormat.JSON else TextFormatter())
            handler.addFilter(add_session_mark)
            if isinstance(handler, logging.StreamHandler) and handler.stream is sys.stdout:
                handler.setStream(sys.stderr)
        logger.addHandler(counter)
    logging.getLogger("asyncio").addFilter(is_worth_a_word)
    logging.getLogger("tornado.access").addFilter(is_no_probe)
