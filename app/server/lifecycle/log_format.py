"""Log records as lines of text or JSON. Text from users in a message cannot forge another record."""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterable
from typing import Any

import panel as pn
from pythonjsonlogger.json import JsonFormatter
from tornado.websocket import WebSocketClosedError

from app.runtime.settings import LogFormat

LONGEST_MESSAGE = 400
"""Largest length of a message, in characters. A visitor can make a message long, for example by the address of a request."""

# Number of first characters of a session's id in the log.
_SESSION_CHARACTERS = 8
# Number of last characters of a shortened message. In a message about a request, they contain the visitor's address.
_LAST_CHARACTERS = 60
_ELLIPSIS = " … "
_TRACEBACK_INDENT = "    "


def short_session_id() -> str | None:
    """Return the first characters of the current session's id; None outside a session.

    With the whole id, a reader of the log could join the session.
    """
    document = pn.state.curdoc
    context = document.session_context if document is not None else None
    return str(context.id)[:_SESSION_CHARACTERS] if context is not None else None


def add_session_id(record: logging.LogRecord) -> bool:
    """Filter that adds the short id of the current session to each record, and passes all records."""
    if session := short_session_id():
        record.session = session
    return True


def shorten_message(record: logging.LogRecord) -> bool:
    """Filter that shortens long messages by omitting their middle, and passes all records."""
    message = record.getMessage()
    if len(message) > LONGEST_MESSAGE:
        beginning = message[: LONGEST_MESSAGE - _LAST_CHARACTERS - len(_ELLIPSIS)]
        record.msg, record.args = beginning + _ELLIPSIS + message[-_LAST_CHARACTERS:], None
    return True


def is_not_closed_socket(record: logging.LogRecord) -> bool:
    """Filter that drops records about messages to clients that have disconnected."""
    return record.exc_info is None or not isinstance(record.exc_info[1], WebSocketClosedError)


def is_not_probe(record: logging.LogRecord) -> bool:
    """Filter that drops records about requests of the readiness probe."""
    return " /readiness " not in record.getMessage()


def escape_control_characters(text: str) -> str:
    """Return a text with escapes for all characters that are not printable, including line ends."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in text)


class TextFormatter(logging.Formatter):
    """Writes time, level, logger, session and message on one line. Lines of a traceback follow, indented."""

    def format(self, record: logging.LogRecord) -> str:
        """Format a record."""
        session = getattr(record, "session", None)
        logger = f"{record.name} [{session}]" if session else record.name
        line = f"{self.formatTime(record)} {record.levelname} {logger}: {escape_control_characters(record.getMessage())}"
        if record.exc_info:
            traceback_lines = self.formatException(record.exc_info).splitlines()
            line = "\n".join([line, *(_TRACEBACK_INDENT + escape_control_characters(text) for text in traceback_lines)])
        return line


class JsonLineFormatter(JsonFormatter):
    """Writes a JSON object on one line: time (UTC), level, logger, message, session, exception and traceback."""

    def __init__(self) -> None:
        names = {"levelname": "level", "name": "logger", "exc_info": "traceback"}
        super().__init__(["levelname", "name", "message"], rename_fields=names, timestamp="time")

    def add_fields(self, log_data: dict[str, Any], record: logging.LogRecord, message_dict: dict[str, Any]) -> None:
        """Add the class of the exception to the record's fields."""
        super().add_fields(log_data, record, message_dict)
        if record.exc_info and record.exc_info[0] is not None:
            log_data["exception"] = record.exc_info[0].__qualname__


def set_up_logs(log_format: LogFormat, counter: logging.Handler, loggers: Iterable[logging.Logger]) -> None:
    """Write all records of the process in one format, to stderr, and count them.

    Parameters
    ----------
    log_format
        Format of the records.
    counter
        Additional handler that counts the records.
    loggers
        All loggers with handlers: the root logger and Panel's.
    """
    for logger in loggers:
        for handler in logger.handlers:
            handler.setFormatter(JsonLineFormatter() if log_format is LogFormat.JSON else TextFormatter())
            handler.addFilter(add_session_id)
            handler.addFilter(shorten_message)
            # Panel's handler writes to stdout.
            if isinstance(handler, logging.StreamHandler) and handler.stream is sys.stdout:
                handler.setStream(sys.stderr)
        logger.addHandler(counter)
    logging.getLogger("asyncio").addFilter(is_not_closed_socket)
    logging.getLogger("tornado.access").addFilter(is_not_probe)
