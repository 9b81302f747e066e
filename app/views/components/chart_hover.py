"""Hover texts of charts, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from bokeh.models import CustomJSHover, GlyphRenderer, HoverTool

from app.browser.callbacks import callback_code

FORMATS = {name: callback_code("hover_texts.js", f"{name}(value)") for name in ("number", "count", "percent")}
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
    tooltips = f'<div style="font-size:11px;line-height:14px;color:var(--ui-ink)">{text}</div>'
    return HoverTool(tooltips=tooltips, formatters=formatters, renderers=list(renderers), visible=False, **options)
