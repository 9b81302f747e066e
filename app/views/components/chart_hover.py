"""Hover texts of charts, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from bokeh.models import CustomJSHover, GlyphRenderer, HoverTool

FORMATS = {
    "number": (
        "const size = Math.abs(value)\n"
        "return size > 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)))"
    ),
    "count": "return String(value).replace(/\\B(?=(\\d{3})+$)/g, ' ')",
    "percent": "return `${Number((100 * value).toPrecision(3))} %`",
}
"""JavaScript that writes a `value`: four digits, a whole number in groups of digits, a share."""


def chart_hover(text: str, formats: Mapping[str, str], renderers: Sequence[GlyphRenderer], **options: Any) -> HoverTool:
    """A tool that describes the points of a chart under the mouse.

    Parameters
    ----------
    text
        HTML with the values as ``@column{custom}`` or ``$variable{custom}``.
    formats
        Name in `FORMATS` for each of these values, with its @ or $.
    renderers
        What is described.
    **options
        Of `bokeh.models.HoverTool`.
    """
    formatters = {value: CustomJSHover(code=FORMATS[kind]) for value, kind in formats.items()}
    tooltips = f'<div style="font-size:11px;line-height:14px;color:#1b1b1b">{text}</div>'
    return HoverTool(tooltips=tooltips, formatters=formatters, renderers=list(renderers), visible=False, **options)
