"""Legends: what every colour of a picture means, in words beside a patch of it."""

from __future__ import annotations

from collections.abc import Iterable

from app.rendering.palette import PATCH_EDGE, Entry, Palette

_ITEM = '<span style="display:inline-flex;align-items:center;margin:0 10px 2px 0;white-space:nowrap">{patch}{label}</span>'
_PATCH = "display:inline-block;width:12px;height:12px;margin-right:5px;border:1px solid {edge};background:{colour}"


def patch(colour: str) -> str:
    """HTML of a patch of a colour."""
    return f'<span style="{_PATCH.format(colour=colour, edge=PATCH_EDGE)}"></span>'


def legend(entries: Iterable[Entry]) -> str:
    """HTML of a legend that wraps."""
    items = (_ITEM.format(patch=patch(entry.colour), label=entry.label) for entry in entries)
    return f'<div style="font-size:12px;line-height:18px">{"".join(items)}</div>'


def passage_legend(palette: Palette, channels: int) -> str:
    """HTML of the key that is read both ways: where orbits come from down the side, where they go along the top."""
    ends = (*range(1, channels + 1), 0)
    name = {0: "bounded", **{k: str(k) for k in ends if k}}
    head = "".join(f"<th scope=col style='font-weight:normal'>{name[fate]}</th>" for fate in ends)
    rows = "".join(
        f"<tr><th scope=row style='font-weight:normal;text-align:right'>{name[origin]}</th>"
        + "".join(f"<td style='text-align:center'>{patch(palette.passage_colour(origin, fate))}</td>" for fate in ends)
        + "</tr>"
        for origin in ends
    )
    caption = "<caption style='text-align:left'>came in by (down), leaves by (across)</caption>"
    return f"<table style='font-size:12px;border-spacing:4px 1px'>{caption}<tr><th></th>{head}</tr>{rows}</table>"
