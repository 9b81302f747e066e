"""Legends: the meaning of each colour of a picture, beside a patch of it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

from engine import Outcome
from plots.pictures.palette import Entry, Palette, end_places, short_label


def patch(colour: str, label: str = "") -> str:
    """HTML of a patch of a colour, with a label (HTML) beside it."""
    return f"<span class='patch' style='--colour:{colour}'>{label}</span>"


def legend_items(entries: Iterable[Entry]) -> str:
    """HTML of the entries of a legend."""
    return "".join(patch(entry.colour, escape(entry.label)) for entry in entries)


def chips(entries: Iterable[Entry]) -> str:
    """HTML of the entries of a legend where there is little room: a number or a word, which the whole label explains."""
    parts = ((entry.colour, escape(entry.label), escape(short_label(entry.label))) for entry in entries)
    return "".join(f"<span title='{label}'>{patch(colour, short)}</span>" for colour, label, short in parts)


def legend(entries: Iterable[Entry]) -> str:
    """HTML of a legend that wraps."""
    return f"<div class='legend'>{legend_items(entries)}</div>"


def passage_legend(palette: Palette, outcomes: Sequence[Outcome]) -> str:
    """HTML of the table of passage colours: a row for each outcome backward in time, a column for each forward."""
    name = {place + 1: escape(short_label(end.label)) for place, end in zip(end_places(outcomes), outcomes, strict=True)}
    name |= {0: "bounded"}
    ends = tuple(name)
    head = "".join(f"<th scope=col>{name[fate]}</th>" for fate in ends)
    rows = "".join(
        f"<tr><th scope=row>{name[origin]}</th>"
        + "".join(f"<td>{patch(palette.passage_colour(origin, fate))}</td>" for fate in ends)
        + "</tr>"
        for origin in ends
    )
    caption = "<caption>Enters by (rows), leaves by (columns)</caption>"
    return f"<table class='passages'>{caption}<tr><td></td>{head}</tr>{rows}</table>"
