"""Messages of the page to the server, without a browser."""

from __future__ import annotations

from typing import Any

from bokeh.document import Document
from panel.custom import JSComponent
from panel.models.esm import DataEvent


def send(component: JSComponent, *messages: Any) -> None:
    """Deliver messages to a component, as those that its browser side has sent."""
    document = Document()
    model = component.get_root(document)
    document.add_root(model)
    for message in messages:
        document.callbacks.trigger_event(DataEvent(model, message))
    document.remove_root(model)
