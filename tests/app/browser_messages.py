"""Send messages of the page to the server, without a browser."""

from __future__ import annotations

from typing import Any

from bokeh.document import Document
from bokeh.document.events import MessageSentEvent
from panel.custom import JSComponent
from panel.models.esm import DataEvent


def send(component: JSComponent, *messages: Any) -> list[Any]:
    """Deliver messages to a component as if its browser side had sent them, and return what the component sends back."""
    document, answers = Document(), []
    model = component.get_root(document)
    document.add_root(model)

    def receive(event: Any) -> None:
        if isinstance(event, MessageSentEvent):
            answers.append(event.msg_data.data)

    document.on_change(receive)
    for message in messages:
        document.callbacks.trigger_event(DataEvent(model, message))
    document.remove_root(model)
    return answers
