"""Legends: what each colour of a picture means."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from itertools import groupby

from engine.foundations.wording import format_number, format_whole
from plots.layers.picture import ColourScale, ColourTable, Legend
from plots.pictures.palette import Entry, Mark
from plots.texts.typeset import typeset

# Number of intervals of a drawn colour scale. The browser interpolates the colours within each interval.
_SCALE_STEPS = 12


def patch(colour: str, label: str = "", title: str = "") -> str:
    """Return HTML of a coloured patch with a label and a tooltip, both HTML."""
    hint = f" title='{title}'" if title else ""
    return f"<span class='patch'{hint} style='--colour:{colour}'>{label}</span>"


def legend_items(entries: Iterable[Entry]) -> str:
    """Return HTML of the entries of a legend."""
    return "".join(patch(_background(entry), escape(entry.label)) for entry in entries)


def chips(entries: Iterable[Entry]) -> str:
    """Return HTML of the entries of a narrow legend. Each entry is a number or a word, with the whole label as tooltip.

    The patches of neighbouring entries with the same word stand side by side before the word.
    """
    groups = groupby(entries, lambda entry: entry.short_label)
    return "".join(_chip(escape(word), list(group)) for word, group in groups)


def _chip(word: str, entries: Sequence[Entry]) -> str:
    if len(entries) == 1:
        return patch(_background(entries[0]), word, escape(entries[0].label))
    patches = "".join(patch(_background(entry), title=escape(entry.label)) for entry in entries)
    return f"<span class='tones'>{patches}&nbsp;{word}</span>"


def legend(entries: Iterable[Entry]) -> str:
    """Return HTML of a legend that wraps."""
    return f"<div class='legend'>{legend_items(entries)}</div>"


def picture_legend(content: Legend) -> str:
    """Return HTML of the legend below a picture."""
    table = _table(content.table) if content.table is not None else ""
    entries = chips([] if table else content.entries)
    scale = _scale(content.scale) if content.scale is not None else ""
    sentence = f" <span>{typeset(escape(content.sentence))}</span>" if content.sentence else ""
    return f"{table}{entries}{scale}{chips(content.over)}{chips(content.others if content.is_short else [])}{sentence}"


def figure_legend(content: Legend) -> str:
    """Return HTML of the legend of a picture with room for all labels."""
    scale = _scale(content.scale) if content.scale is not None else ""
    return f"{legend_items([*content.entries, *content.over, *content.others])}{scale}"


def _background(entry: Entry) -> str:
    """Return the colour of an entry, or its chessboard, as a CSS background."""
    if entry.mark is not Mark.CHESSBOARD:
        return entry.colour
    return f"repeating-conic-gradient({entry.colour} 0 25%, {entry.second_colour} 0 50%) 0 0/6px 6px"


def _scale(scale: ColourScale) -> str:
    colours = scale.colours
    stops = ",".join(colours[round(step * (len(colours) - 1) / _SCALE_STEPS)] for step in range(_SCALE_STEPS + 1))
    bar = f"<i class='scale' style='background:linear-gradient(90deg,{stops})'></i>"
    return f"<span>≤ {_number(scale.low)} {bar} ≥ {_number(scale.high)}{' (locked)' if scale.is_locked else ''}</span>"


def _number(value: float) -> str:
    return format_whole(value) if value == round(value) else format_number(value)


def _table(table: ColourTable) -> str:
    """Return a line of patches: a hue for each end of orbits, its tones for their origins, and the order of the tones."""
    names = [escape(name) for name in table.names]
    hues = "".join(_hue(end, names, tones) for end, tones in zip(names, table.tones, strict=True))
    return f"{hues}<span>tones: from {', '.join(names)}</span>"


def _hue(end: str, origins: Sequence[str], tones: Sequence[str]) -> str:
    patches = (patch(colour, title=f"from {origin} to {end}") for origin, colour in zip(origins, tones, strict=True))
    return f"<span class='tones'>{end}&nbsp;{''.join(patches)}</span>"
