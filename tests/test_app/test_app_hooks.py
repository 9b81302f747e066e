"""What the server's log tells, and what not."""

from __future__ import annotations

import logging

import pytest
from tornado.websocket import WebSocketClosedError

from app.app_hooks import is_worth_a_word


def record_of(error: Exception | None) -> logging.LogRecord:
    info = (type(error), error, None) if error is not None else None
    return logging.LogRecord("asyncio", logging.ERROR, "", 0, "Task exception was never retrieved", None, info)


@pytest.mark.parametrize(("error", "expected"), [(WebSocketClosedError(), False), (ValueError("h"), True), (None, True)])
def test_only_a_visitor_who_left_goes_without_a_word(error: Exception | None, expected: bool) -> None:
    assert is_worth_a_word(record_of(error)) is expected
