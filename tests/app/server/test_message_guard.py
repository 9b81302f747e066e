"""Only messages of a page reach Bokeh. Floods and other protocols close the WebSocket."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import Any

import pytest
from bokeh.document import Document

from app.server.browser_rules import RefusedMessageError
from app.server.message_guard import (
    BYTES_PER_MESSAGE,
    LARGEST_BURST,
    LARGEST_FRAGMENT,
    MESSAGES_PER_SECOND,
    REFUSAL_WEIGHT,
    MessageGuard,
    UnacceptableConnectionError,
)
from tests.app.clock import Clock

READY = {"type": "event", "name": "document_ready", "values": {"type": "map", "entries": []}}
DOCUMENT = Document()
PATCH = {"events": [{"kind": "MessageSent", "msg_type": "bokeh_event", "msg_data": READY}]}


def send(guard: MessageGuard, kind: Any = "PATCH-DOC", content: Any = PATCH) -> list[str]:
    parts = [json.dumps(part) for part in ({"msgid": "1", "msgtype": kind}, {}, content)]
    assert [guard.take(part, DOCUMENT) for part in parts[:2]] == [[], []]
    taken = guard.take(parts[2], DOCUMENT)
    assert taken == parts
    return taken


def send_many(guard: MessageGuard, count: int, kind: str, content: Any) -> None:
    for _ in range(count):
        with suppress(RefusedMessageError):
            send(guard, kind, content)


@pytest.mark.parametrize("kind", ["PUSH-DOC", "ACK", "OK", "ERROR", "PULL-DOC-REPLY", "x"])
def test_other_kinds_are_refused(kind: str) -> None:
    with pytest.raises(RefusedMessageError):
        send(MessageGuard(), kind)


def test_a_second_request_for_the_document_is_refused_and_the_next_message_passes() -> None:
    guard = MessageGuard()
    send(guard, "PULL-DOC-REQ", {})
    with pytest.raises(RefusedMessageError):
        send(guard, "PULL-DOC-REQ", {})
    send(guard)


@pytest.mark.parametrize(
    "header",
    [
        "",
        "{",
        "[" * 100_000,
        "null",
        "{}",
        '{"msgid": 1, "msgtype": "PATCH-DOC"}',
        '{"msgid": "1", "msgtype": "PATCH-DOC", "num_buffers": 1000}',
    ],
    ids=["empty", "half", "deep", "null", "no kind", "number", "buffers"],
)
def test_a_message_without_a_header_closes_the_connection(header: str) -> None:
    with pytest.raises(UnacceptableConnectionError):
        MessageGuard().take(header, DOCUMENT)


def test_content_that_is_not_json_closes_the_connection() -> None:
    guard = MessageGuard()
    guard.take('{"msgid": "1", "msgtype": "PATCH-DOC"}', DOCUMENT)
    guard.take("{}", DOCUMENT)
    with pytest.raises(UnacceptableConnectionError, match="not JSON"):
        guard.take("{", DOCUMENT)


def test_binary_parts_follow_their_headers() -> None:
    guard = MessageGuard()
    parts = ['{"msgid": "1", "msgtype": "PATCH-DOC", "num_buffers": 1}', "{}", json.dumps(PATCH), '{"id": "b"}', b"1234"]
    assert [guard.take(part, DOCUMENT) for part in parts] == [[], [], [], [], parts]


@pytest.mark.parametrize("before", [0, 1, 2, 3])
def test_unexpected_binary_parts_close_the_connection(before: int) -> None:
    guard = MessageGuard()
    for part in ['{"msgid": "1", "msgtype": "PATCH-DOC", "num_buffers": 1}', "{}", json.dumps(PATCH)][:before]:
        guard.take(part, DOCUMENT)
    with pytest.raises(UnacceptableConnectionError, match="binary"):
        guard.take(b"1234", DOCUMENT)


@pytest.mark.parametrize(
    ("count", "kind", "content"),
    [
        (LARGEST_BURST + 1, "PATCH-DOC", PATCH),
        (LARGEST_BURST // REFUSAL_WEIGHT + 1, "PUSH-DOC", PATCH),
        (2 * LARGEST_BURST * BYTES_PER_MESSAGE // LARGEST_FRAGMENT, "PATCH-DOC", "x" * (LARGEST_FRAGMENT - 10)),
    ],
    ids=["messages", "refused messages", "large messages"],
)
def test_floods_close_the_connection_also_after_a_quiet_hour(count: int, kind: str, content: Any) -> None:
    clock = Clock()
    guard = MessageGuard(clock.monotonic)
    clock.now += 3600.0
    with pytest.raises(UnacceptableConnectionError, match="per second"):
        send_many(guard, count, kind, content)


def test_a_steady_rate_below_the_limit_is_no_flood() -> None:
    clock = Clock()
    guard = MessageGuard(clock.monotonic)
    for _ in range(2 * LARGEST_BURST):
        send(guard)
        clock.now += 1.1 / MESSAGES_PER_SECOND
