"""Panes of text, and percentages as the page writes them."""

from __future__ import annotations

import re
from typing import Any

import panel as pn
from bokeh.document import Document

# Lines do not break between a number and its equals sign or power of ten; groups of digits and the per cent sign are close to it.
_AROUND_SIGN = re.compile(r"(?<=\w) (?=(?:=|≈) [−-]?\d)|(?<=[=≤×]) (?=[−-]?\d)|(?<=\d) (?=×)")
_SUBSCRIPT = re.compile(r"\b(?:([A-Za-z])_|(p)(?=[xy]\b)|(ω)(?=[12]\b))([a-z]{1,3}|\d)\b")
_POWER = re.compile(r"\b([et])\^(\d+(?:\.\d+)?)")
_DIGITS = str.maketrans("12", "₁₂")
_IN_NUMBER = re.compile(r"(?<=\d) (?=%|\d{3}\b)")


def typeset(html: str) -> str:
    """Return HTML whose lines do not break inside a number, with subscripts and powers, such as px, ω1, S_b and e^6.5."""
    # Every second part is a tag.
    parts = re.split(r"(<[^>]*>)", html)
    for space, places in (("\N{NO-BREAK SPACE}", _AROUND_SIGN), ("\N{NARROW NO-BREAK SPACE}", _IN_NUMBER)):
        parts[::2] = [places.sub(space, part) for part in parts[::2]]
    for replaced, places in ((r"\1\2\3<sub>\4</sub>", _SUBSCRIPT), (r"\1<sup>\2</sup>", _POWER)):
        parts[::2] = [places.sub(replaced, part) for part in parts[::2]]
    return "".join(parts)


def plain_symbol(symbol: str) -> str:
    """The symbol of a parameter with subscripts, for labels that are not HTML."""
    return symbol.translate(_DIGITS)


class TextPane(pn.pane.HTML):
    """HTML text with typographic spaces; it may change while it is not on the page.

    Panel sets the stylesheets again with each text, using the document of the model. A model that is not on the page has no
    document and would load a stylesheet from Panel's content delivery network, which the page must not do.
    """

    def _transform_object(self, obj: Any) -> dict[str, Any]:
        return dict(super()._transform_object(typeset(obj or "")))

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        properties: dict[str, Any] = super()._get_properties(doc)
        if doc is None:
            # The model keeps its stylesheets.
            properties.pop("stylesheets", None)
        return properties


class StatusPane(TextPane):
    """Text whose changes screen readers read out after what they are reading."""

    def _get_properties(self, doc: Document | None) -> dict[str, Any]:
        return {**super()._get_properties(doc), "html_attributes": {"role": "status"}}


def percent(share: float, decimals: int = 1) -> str:
    """A share between 0 and 1 as a percentage: 3.3 %."""
    return f"{100.0 * share:.{decimals}f} %"


def percent_range(low: float, high: float, decimals: int = 2) -> str:
    """Two shares between 0 and 1 as a range of percentages: 3.21 to 3.40 %."""
    return f"{100.0 * low:.{decimals}f} to {percent(high, decimals)}"
