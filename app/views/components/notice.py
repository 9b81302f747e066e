"""Short messages in the corner of the page: passing messages, pictures, warnings, and lasting messages about the server."""

from __future__ import annotations

import time
from html import escape
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.document import Document
from bokeh.models import CustomJS

from app.views.components.texts import TextPane
from plots.browser.javascript import callback_code

CONNECTION_LOST = "The connection to the server is lost. This page returns with its view when the server answers."
"""Message that the browser shows when the connection is lost."""

RELOAD = "Reload"
"""Label of the button below this message."""

CLOSE = "Close"
"""Label of the button below a picture."""

MODEL_NAME = "notice"
"""Name by which the server finds the Bokeh model of the pane in a document."""

PASSING_SECONDS = 5.0
"""Duration of a passing message, in seconds."""

_ON_CONNECTION_LOST = callback_code(Path(__file__).with_name("lost_connection.js"), "showLostConnection(sentence, label)")


class _NamedPane(TextPane):
    """A pane whose Bokeh model is named `MODEL_NAME`."""

    def _get_properties(self, doc: Document) -> dict[str, Any]:
        return {**super()._get_properties(doc), "name": MODEL_NAME}


class Notice:
    """Shows the messages of a session, one at a time."""

    def __init__(self) -> None:
        self._pane = _NamedPane("", width=0, height=0, margin=0, styles={"position": "absolute"}, css_classes=["notices"])

    def layout(self) -> pn.viewable.Viewable:
        """Return the pane, which may be anywhere on the page."""
        return self._pane

    def show(self, sentence: str) -> None:
        """Show a message for `PASSING_SECONDS`."""
        self._pane.object = _passing(sentence)

    def show_picture(self, sentence: str, picture: str) -> None:
        """Show a picture (HTML) above a message until the visitor closes it, or until `clear`."""
        close = f"<form method='dialog'><button>{CLOSE}</button></form>"
        self._pane.object = (
            f"<dialog open class='notice' {_moment()}>{picture}<p role='status'>{escape(sentence)}</p>{close}</dialog>"
        )

    def warn(self, sentence: str) -> None:
        """Show a warning until `clear`."""
        self._pane.object = _html(sentence, "class='notice alert'", role="alert")

    def clear(self) -> None:
        """Remove the message."""
        if self._pane.object:
            self._pane.object = ""


def show_lasting_notice(document: Document, sentence: str) -> None:
    """Show a message on the page of a document until the next message or a reload; needs the document's lock."""
    _set_text(document, _html(sentence))


def show_passing_notice(document: Document, sentence: str) -> None:
    """Show a message on the page of a document for `PASSING_SECONDS`; needs the document's lock."""
    _set_text(document, _passing(sentence))


def watch_connection(document: Document) -> None:
    """Make the browser show `CONNECTION_LOST` when the connection is lost, and load the page again when the server answers."""
    args = {"sentence": CONNECTION_LOST, "label": RELOAD}
    document.js_on_event("connection_lost", CustomJS(args=args, code=_ON_CONNECTION_LOST))


def _set_text(document: Document, html: str) -> None:
    model = document.get_model_by_name(MODEL_NAME)
    if model is not None:
        model.text = escape(html)


def _passing(sentence: str) -> str:
    duration = f"style='animation-duration: {PASSING_SECONDS}s'"
    return _html(sentence, f"class='notice passing' {duration} {_moment()}")


def _moment() -> str:
    """Return an attribute that makes a repeated message different, so that the browser shows the message again."""
    return f"data-time='{time.monotonic_ns()}'"


def _html(sentence: str, attributes: str = "class='notice'", role: str = "status") -> str:
    return f"<div role='{role}' {attributes}>{escape(sentence)}</div>"
