"""Panes of text."""

from __future__ import annotations

from typing import Any

import panel as pn
from bokeh.document import Document


class TextPane(pn.pane.HTML):
    """HTML text; it may change while it is not on the page.

    With each text, Panel sets the stylesheets again, from the document of the model. A model that is off the page has no
    document: it would get a stylesheet of Panel's content delivery network, which the page must not load.
    """

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
