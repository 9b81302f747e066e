"""The legend of each map, which stands in its frame."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

from app.views.components.legends import chips, legend_items, passage_legend
from app.views.components.numbers import grouped
from engine import MapSpec, Outcome
from plots.pictures.palette import Entry, Palette
from plots.pictures.time_scale import TimeScale

_STEPS = 12


@dataclass(frozen=True)
class OtherView:
    """The view with which a map is compared.

    Attributes
    ----------
    title
        The view in words.
    outcomes
        What its orbits can end at.
    axes
        Symbols of its axes.
    """

    title: str
    outcomes: tuple[Outcome, ...]
    axes: tuple[str, str]


@dataclass(frozen=True)
class LegendContents:
    """What the legends of a map depend on.

    Attributes
    ----------
    spec
        The map.
    palette
        Its colours.
    times
        Scale of the escape times.
    locked
        Whether the escape times keep their scale.
    regularity
        Result of the analysis of bounded orbits, in words.
    fates
        Outcomes that the map has.
    other
        The view with which it is compared; None for none.
    """

    spec: MapSpec
    palette: Palette
    times: TimeScale
    locked: bool
    regularity: str
    fates: frozenset[int]
    other: OtherView | None = None


def map_legend(name: str, contents: LegendContents, overlays: Iterable[Entry]) -> str:
    """HTML of the legend of a map, by the name of its picture, with the entries of what is drawn over it."""
    palette, ends = contents.palette, contents.spec.outcomes
    outcomes = [entry for fate, entry in reversed(palette.outcomes.items()) if fate in contents.fates]
    items = {
        "basins": lambda: chips([*palette.legend_entries(ends), *outcomes]),
        "times": lambda: _colour_scale(palette, contents.times, locked=contents.locked),
        "crossings": lambda: legend_items(palette.crossing_entries),
        "characters": lambda: f"{legend_items(palette.character_entries[1:])} <span>{contents.regularity}</span>",
        "origins": lambda: passage_legend(palette, ends),
        "compared": lambda: _other_legend(palette, contents.other),
        "differences": lambda: _difference_legend(contents),
    }[name]()
    return f"<div class='legend'>{items}{legend_items(overlays)}</div>"


def _other_legend(palette: Palette, other: OtherView | None) -> str:
    """The outcomes of the other view, and its title."""
    return f"{chips(palette.legend_entries(other.outcomes))} <span>{escape(other.title)}</span>" if other is not None else "…"


def _difference_legend(contents: LegendContents) -> str:
    """The classes of pixels, or why they are not compared."""
    if contents.other is not None and contents.other.axes != contents.spec.plane.axis_symbols:
        return "<span>Other axes: pixels cannot be compared.</span>"
    return legend_items(contents.palette.difference_entries)


def _colour_scale(palette: Palette, times: TimeScale, *, locked: bool) -> str:
    """The logarithmic scale of escape times; the colours at its ends stand for all shorter and all longer times."""
    colours = palette.escape_time
    stops = ",".join(colours[round(step * (len(colours) - 1) / _STEPS)] for step in range(_STEPS + 1))
    bar = f"<i class='scale' style='background:linear-gradient(90deg,{stops})'></i>"
    return f"<span>≤ {_shown(times.low)} {bar} ≥ {_shown(times.high)}{' (locked)' if locked else ''}</span>"


def _shown(time: float) -> str:
    return grouped(time) if time == round(time) else f"{time:g}"
