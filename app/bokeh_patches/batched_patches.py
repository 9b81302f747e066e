"""All that one callback changes on a page, sent as one message.

Bokeh sends a message for each change, and goes through all models of the page for each message: the first frame of a map is 17
changes, 16 ms of work as many messages and 3 ms as one; and the browser paints once. The protocol has room for any number of
changes in a message.

Bokeh also hands the writing of them to a thread and waits for it, which gains nothing where Python's lock is what everybody waits
for.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

from bokeh.document import Document
from bokeh.io.doc import patch_curdoc
from bokeh.server.session import ServerSession

from app.bokeh_patches.own_ways import put_in_place


def send_changes_together() -> None:
    """From now on, in this process."""
    put_in_place(ServerSession, "_send_pending_patches", _send)


async def _send(session: ServerSession, pending: Sequence[Any]) -> None:
    for message, connections in serialize_together(pending):
        for connection in connections:
            await connection.send_message(message)


def serialize_together(pending: Sequence[Any]) -> list[tuple[Any, Any]]:
    """One message for each run of changes to the same page that go to the same connections, in their order.

    Parameters
    ----------
    pending
        Bokeh's pending patches: each an event, a protocol and connections.

    Returns
    -------
    Pairs of a message, ready to be sent, and the connections it goes to.
    """
    runs = itertools.groupby(pending, key=lambda patch: (id(patch.event.document), patch.connections))
    return [_serialize([*patches]) for _, patches in runs]


def _serialize(patches: list[Any]) -> tuple[Any, Any]:
    first = patches[0]
    document: Document = first.event.document
    with patch_curdoc(document):
        message = first.protocol.create("PATCH-DOC", [patch.event for patch in patches])
        message.prepare()
    return message, first.connections
