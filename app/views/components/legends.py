"""Legends: the meaning of each colour of a picture, beside a patch of it."""

from __future__ import annotations

from collections.abc import Iterable

from plots.palette import Entry, Palette


def patch(colour: str, label: str = "") -> str:
    """HTML of a patch of a colour, with a label (HTML) beside it."""
    return f"<span class='patch' style='--colour:{colour}'>{label}</span>"


def legend_items(entries: Iterable[Entry]) -> str:
    """HTML of the entries of a legend."""
    return "".join(patch(entry.colour, entry.label) for entry in entries)


def chips(entries: Iterable[Entry]) -> str:
    """HTML of the entries of a legend where there is little room: a number or a word, which the whole label explains."""
    parts = ((entry, entry.label.removeprefix("channel ").partition(":")[0]) for entry in entries)
    return "".join(f"<span title='{entry.label}'>{patch(entry.colour, short)}</span>" for entry, short in parts)


def legend(entries: Iterable[Entry]) -> str:
    """HTML of a legend that wraps."""
    return f"<div class='legend'>{legend_items(entries)}</div>"


def passage_legend(palette: Palette, channels: int) -> str:
    """HTML of the table of passage colours: a row for each channel of entry, a column for each channel of escape."""
    ends = (*range(1, channels + 1), 0)
    name = {0: "bounded", **{k: str(k) for k in ends if k}}
    head = "".join(f"<th scope=col>{name[fate]}</th>" for fate in ends)
    rows = "".join(
        f"<tr><th scope=row>{name[origin]}</th>"
        + "".join(f"<td>{patch(palette.passage_colour(origin, fate))}</td>" for fate in ends)
        + "</tr>"
        for origin in ends
    )
    caption = "<caption>Enters by (rows), leaves by (columns)</caption>"
    return f"<table class='passages'>{caption}<tr><td></td>{head}</tr>{rows}</table>"
