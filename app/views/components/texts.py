"""Panes of text."""

from __future__ import annotations

import re
from typing import Any

import panel as pn
from bokeh.document import Document

# A number stays with its equals sign and its power of ten, and closer with its groups of digits and its per cent sign.
_AROUND_SIGN = re.compile(r"(?<=\w) (?=(?:=|≈) [−-]?\d)|(?<=[=≤×]) (?=[−-]?\d)|(?<=\d) (?=×)")
_SUBSCRIPT = re.compile(r"\b(?:([A-Za-z])_|(p)(?=[xy]\b)|(ω)(?=[12]\b))([a-z]{1,3}|\d)\b")
_DIGITS = str.maketrans("12", "₁₂")
_IN_NUMBER = re.compile(r"(?<=\d) (?=%|\d{3}\b)")


def typeset(html: str) -> str:
    """HTML whose lines do not break inside a number, and with the subscripts of symbols, such as px, ω1 and S_b."""
    # Every other part is a tag.
    parts = re.split(r"(<[^>]*>)", html)
    for space, places in (("\N{NO-BREAK SPACE}", _AROUND_SIGN), ("\N{NARROW NO-BREAK SPACE}", _IN_NUMBER)):
        parts[::2] = [places.sub(space, part) for part in parts[::2]]
    parts[::2] = [_SUBSCRIPT.sub(r"\1\2\3<sub>\4</sub>", part) for part in parts[::2]]
    return "".join(parts)


def plain_symbol(symbol: str) -> str:
    """The symbol of a parameter with subscripts, for labels that are not HTML."""
    return symbol.translate(_DIGITS)


class TextPane(pn.pane.HTML):
    """Typeset HTML text; it may change while it is not on the page.

    With each text, Panel sets the stylesheets again, from the document of the model. A model that is off the page has no
    document: it would get a stylesheet of Panel's content delivery network, which the page must not load.
    """

    def _transform_object(self, obj: Any) -> dict[str, Any]:
        return dict(super()._transform_object(typeset(obj or "")))

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
