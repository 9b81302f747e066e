"""All changes of a callback in one message."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

from bokeh.document import Document
from bokeh.document.events import DocumentPatchedEvent
from bokeh.models import Range1d
from bokeh.protocol import Protocol
from bokeh.server.session import ServerSession

from app.bokeh_patches.one_message import send_changes_together, serialize_together


class Patch(NamedTuple):
    event: DocumentPatchedEvent
    protocol: Protocol
    connections: tuple[str, ...]


def patches(document: Document, connections: tuple[str, ...], *changes: tuple[str, float]) -> list[Any]:
    noted: list[Any] = []
    document.on_change_dispatch_to(Receiver(noted))  # type: ignore[arg-type]
    [edges] = document.roots
    for name, value in changes:
        setattr(edges, name, value)
    return [Patch(event, Protocol(), connections) for event in noted]


class Receiver:
    def __init__(self, noted: list[Any]) -> None:
        self._noted = noted

    def _document_patched(self, event: DocumentPatchedEvent) -> None:
        self._noted.append(event)


def page() -> Document:
    document = Document()
    document.add_root(Range1d(start=0.0, end=1.0))
    return document


def changes(message: Any) -> list[tuple[str, float]]:
    return [(event["attr"], event["new"]) for event in json.loads(message.content_json)["events"]]


def test_changes_of_a_page_travel_together_in_their_order() -> None:
    [(message, connections)] = serialize_together(patches(page(), ("here",), ("start", 0.5), ("end", 2.0), ("start", 0.7)))
    assert connections == ("here",)
    assert changes(message) == [("start", 0.5), ("end", 2.0), ("start", 0.7)]


def test_what_goes_elsewhere_is_another_message() -> None:
    pending = [*patches(page(), ("here",), ("start", 0.5)), *patches(page(), ("there",), ("end", 2.0), ("start", 0.6))]
    sent = serialize_together(pending)
    assert [connections for _, connections in sent] == [("here",), ("there",)]
    assert [changes(message) for message, _ in sent] == [[("start", 0.5)], [("end", 2.0), ("start", 0.6)]]


def test_bokeh_has_the_place_for_it() -> None:
    before = ServerSession._send_pending_patches
    try:
        send_changes_together()
        assert ServerSession._send_pending_patches is not before
    finally:
        ServerSession._send_pending_patches = before  # type: ignore[method-assign]
