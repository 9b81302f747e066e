"""All changes of a callback are sent as one message."""

from __future__ import annotations

import inspect
import json
from typing import Any, NamedTuple

import pytest
from bokeh.document import Document
from bokeh.document.events import DocumentPatchedEvent
from bokeh.models import Range1d
from bokeh.protocol import Protocol
from bokeh.server import session
from bokeh.server.session import ServerSession

from app.browser.bokeh_patches.batched_patches import batch_patches, serialize_batches
from tests.app.browser.bokeh_patches.installed_source import missing_hunks


class Patch(NamedTuple):
    event: DocumentPatchedEvent
    protocol: Protocol
    connections: tuple[str, ...]


class Receiver:
    def __init__(self, events: list[Any]) -> None:
        self._events = events

    def _document_patched(self, event: DocumentPatchedEvent) -> None:
        self._events.append(event)


def new_document() -> Document:
    document = Document()
    document.add_root(Range1d(start=0.0, end=1.0))
    return document


def patches(document: Document, connections: tuple[str, ...], *changes: tuple[str, float]) -> list[Any]:
    events: list[Any] = []
    document.on_change_dispatch_to(Receiver(events))  # type: ignore[arg-type]
    for name, value in changes:
        setattr(document.roots[0], name, value)
    return [Patch(event, Protocol(), connections) for event in events]


def changes(message: Any) -> list[tuple[str, float]]:
    return [(event["attr"], event["new"]) for event in json.loads(message.content_json)["events"]]


def test_changes_of_a_document_for_the_same_connections_are_one_message_in_their_order() -> None:
    document = new_document()
    pending = [
        *patches(new_document(), ("first",), ("start", 0.5), ("end", 2.0), ("start", 0.7)),
        *patches(document, ("second",), ("end", 2.0), ("start", 0.6)),
        *patches(document, ("second", "third"), ("end", 3.0)),
    ]
    batches = serialize_batches(pending)
    assert [connections for _, connections in batches] == [("first",), ("second",), ("second", "third")]
    assert [changes(message) for message, _ in batches] == [
        [("start", 0.5), ("end", 2.0), ("start", 0.7)],
        [("end", 2.0), ("start", 0.6)],
        [("end", 3.0)],
    ]


def test_replaced_function_and_patch_fields_are_unchanged_upstream(monkeypatch: pytest.MonkeyPatch) -> None:
    original = ServerSession._send_pending_patches
    monkeypatch.setattr(ServerSession, "_send_pending_patches", original)
    batch_patches()
    assert ServerSession._send_pending_patches is not original
    if original.__module__ == "bokeh.server.session":
        assert list(inspect.signature(original).parameters) == ["self", "pending"]
        assert inspect.iscoroutinefunction(original)
    assert list(session._PendingPatch.__dataclass_fields__) == ["event", "protocol", "connections"]


def test_patch_for_upstream_fits_the_installed_bokeh() -> None:
    assert missing_hunks("batched_patches.patch") == []
