"""Panes of text."""

from __future__ import annotations

import re
from typing import Any

import panel as pn
from bokeh.document import Document

# A number stays with its equals sign, its groups of digits and its per cent sign.
_IN_NUMBER = re.compile(r"(?<=\w) (?== [−-]?\d)|(?<=[=≤]) (?=[−-]?\d)|(?<=\d) (?=%|\d{3}\b)")


def keep_numbers_whole(html: str) -> str:
    """HTML whose lines do not break inside a number."""
    # Every other part is a tag.
    parts = re.split(r"(<[^>]*>)", html)
    parts[::2] = [_IN_NUMBER.sub("\N{NO-BREAK SPACE}", part) for part in parts[::2]]
    return "".join(parts)


class TextPane(pn.pane.HTML):
    """HTML text, in which numbers stay whole; it may change while it is not on the page.

    With each text, Panel sets the stylesheets again, from the document of the model. A model that is off the page has no
    document: it would get a stylesheet of Panel's content delivery network, which the page must not load.
    """

    def _transform_object(self, obj: Any) -> dict[str, Any]:
        return dict(super()._transform_object(keep_numbers_whole(obj or "")))

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        properties: dict[str, Any] = super()._get_properties(doc)
        if doc is None:
            # The model keeps the stylesheets that it has.
            properties.pop("stylesheets", None)
        return properties


class StatusPane(TextPane):
    """Text whose changes screen readers read out when they have finished what they are reading."""

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        return {**super()._get_properties(doc), "html_attributes": {"role": "status"}}
