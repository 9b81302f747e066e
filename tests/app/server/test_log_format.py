"""Lines of the log."""

from __future__ import annotations

import json
import logging
import sys

import pytest
from tornado.websocket import WebSocketClosedError

from app.runtime.settings import LogFormat
from app.server.log_format import JsonFormatter, TextFormatter, is_no_probe, is_worth_a_word, set_up_logs

FORGED = "h=1\n2026-01-01 ERROR root: forged\x1b[2K\u2028"


def record_of(message: str, error: Exception | None = None) -> logging.LogRecord:
    info = None
    if error is not None:
        try:
            raise error
        except Exception:
            info = sys.exc_info()
    return logging.LogRecord("app", logging.ERROR, "", 0, message, None, info)


@pytest.mark.parametrize("formatter", [TextFormatter(), JsonFormatter()])
def test_a_message_is_one_line_of_plain_characters(formatter: logging.Formatter) -> None:
    line = formatter.format(record_of(FORGED))
    assert line.isprintable()


def test_no_line_of_a_traceback_looks_like_a_record() -> None:
    first, *traced = TextFormatter().format(record_of("failed", ValueError(FORGED))).split("\n")
    assert first.endswith("ERROR app: failed")
    assert traced
    assert all(line.startswith("    ") and line.isprintable() for line in traced)


def test_json_tells_time_level_logger_message_session_and_exception() -> None:
    record = record_of(FORGED, ValueError("h"))
    record.session = "12345678"
    told = json.loads(JsonFormatter().format(record))
    assert told["time"].endswith("+00:00")
    assert {name: told[name] for name in ("level", "logger", "message", "session", "exception")} == {
        "level": "ERROR", "logger": "app", "message": FORGED, "session": "12345678", "exception": "ValueError",
    }  # fmt: skip


def test_every_handler_writes_in_the_form_asked_for_and_on_stderr() -> None:
    logger, counter = logging.Logger("one"), logging.NullHandler()
    handler = logging.StreamHandler(sys.stdout)
    logger.addHandler(handler)
    set_up_logs(LogFormat.JSON, counter, [logger])
    assert isinstance(handler.formatter, JsonFormatter)
    assert handler.stream is sys.stderr
    assert counter in logger.handlers


@pytest.mark.parametrize(("error", "expected"), [(WebSocketClosedError(), False), (ValueError("h"), True), (None, True)])
def test_only_a_visitor_who_left_goes_without_a_word(error: Exception | None, expected: bool) -> None:
    assert is_worth_a_word(record_of("Task exception was never retrieved", error)) is expected


@pytest.mark.parametrize(("message", "expected"), [("503 GET /readiness (::1) 1ms", False), ("503 GET /app (::1) 1ms", True)])
def test_answers_to_probes_go_without_a_word(message: str, expected: bool) -> None:
    assert is_no_probe(record_of(message)) is expected
