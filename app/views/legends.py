"""Legends: what every colour of a picture means, in words beside a patch of it."""

from __future__ import annotations

from collections.abc import Iterable

from app.palette import PATCH_EDGE, Entry

_ITEM = '<span style="display:inline-flex;align-items:center;margin:0 10px 2px 0;white-space:nowrap">{patch}{label}</span>'
_PATCH = "display:inline-block;width:12px;height:12px;margin-right:5px;border:1px solid {edge};background:{colour}"


def patch(colour: str) -> str:
    """HTML of a patch of a colour."""
    return f'<span style="{_PATCH.format(colour=colour, edge=PATCH_EDGE)}"></span>'


def legend(entries: Iterable[Entry]) -> str:
    """HTML of a legend that wraps."""
    items = (_ITEM.format(patch=patch(entry.colour), label=entry.label) for entry in entries)
    return f'<div style="font-size:12px;line-height:18px">{"".join(items)}</div>'
