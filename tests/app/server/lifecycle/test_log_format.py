"""Log records are one printable line, as text or JSON."""

from __future__ import annotations

import json
import logging
import sys

import pytest
from tornado.websocket import WebSocketClosedError

from app.runtime.settings import LogFormat
from app.server.lifecycle.log_format import (
    LONGEST_MESSAGE,
    JsonLineFormatter,
    TextFormatter,
    is_not_closed_socket,
    is_not_probe,
    set_up_logs,
    shorten_message,
)

FORGED = "h=1\n2026-01-01 ERROR root: forged\x1b[2K\u2028"


def new_record(message: str, error: Exception | None = None) -> logging.LogRecord:
    info = None
    if error is not None:
        try:
            raise error
        except Exception:
            info = sys.exc_info()
    return logging.LogRecord("app", logging.ERROR, "", 0, message, None, info)


@pytest.mark.parametrize("formatter", [TextFormatter(), JsonLineFormatter()])
def test_message_is_one_printable_line(formatter: logging.Formatter) -> None:
    assert formatter.format(new_record(FORGED)).isprintable()


def test_traceback_lines_cannot_be_taken_for_records() -> None:
    first, *traced = TextFormatter().format(new_record("failed", ValueError(FORGED))).split("\n")
    assert first.endswith("ERROR app: failed")
    assert traced
    assert all(line.startswith("    ") and line.isprintable() for line in traced)


def test_json_fields() -> None:
    record = new_record(FORGED, ValueError("h"))
    record.session = "12345678"
    line = JsonLineFormatter().format(record)
    assert line.isprintable()
    fields = json.loads(line)
    assert fields.pop("time").endswith("+00:00")
    assert fields.pop("traceback").startswith("Traceback")
    assert fields == {"level": "ERROR", "logger": "app", "message": FORGED, "session": "12345678", "exception": "ValueError"}
    plain = json.loads(JsonLineFormatter().format(new_record("stopping")))
    assert set(plain) == {"time", "level", "logger", "message"}


def test_all_handlers_write_the_same_format_to_stderr() -> None:
    logger, counter = logging.Logger("one"), logging.NullHandler()
    handler = logging.StreamHandler(sys.stdout)
    logger.addHandler(handler)
    set_up_logs(LogFormat.JSON, counter, [logger])
    assert isinstance(handler.formatter, JsonLineFormatter)
    assert handler.stream is sys.stderr
    assert counter in logger.handlers


@pytest.mark.parametrize(("length", "shortened"), [(LONGEST_MESSAGE, False), (LONGEST_MESSAGE + 1, True), (10_000, True)])
def test_long_messages_keep_their_beginning_and_their_end(length: int, shortened: bool) -> None:
    message = "400 GET /app?V=".ljust(length - 12, "x") + " (::1) 0.1ms"
    record = new_record("%s")
    record.args = (message,)
    assert shorten_message(record)
    text = record.getMessage()
    assert (len(text), " … " in text) == (min(length, LONGEST_MESSAGE), shortened)
    assert text.startswith("400 GET /app?V=")
    assert text.endswith(" (::1) 0.1ms")


def test_closed_sockets_and_probes_are_not_logged() -> None:
    retrieved = "Task exception was never retrieved"
    assert not is_not_closed_socket(new_record(retrieved, WebSocketClosedError()))
    assert all(is_not_closed_socket(new_record(retrieved, error)) for error in (ValueError("h"), None))
    assert not is_not_probe(new_record("503 GET /readiness (::1) 1ms"))
    assert is_not_probe(new_record("503 GET /app (::1) 1ms"))
