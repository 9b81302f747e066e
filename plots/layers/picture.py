"""What a picture of a map is: its pixel codes, their colours, its legend and its help text."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from engine import EscapeMap, Fate, MapSpec, Outcome
from plots.pictures.palette import Entry, Palette
from plots.pictures.time_scale import TimeScale, fitted_scale


@dataclass(frozen=True)
class ColourScale:
    """A scale of numbers; the colours at its ends stand for all smaller and all larger ones.

    Attributes
    ----------
    low, high
        Ends of the scale.
    colours
        From low to high.
    is_logarithmic
        Whether the colours are at even distances of the logarithm.
    is_locked
        Whether the scale is kept for other maps.
    """

    low: float
    high: float
    colours: Sequence[str]
    is_logarithmic: bool = True
    is_locked: bool = False


@dataclass(frozen=True)
class ColourTable:
    """Colours of orbits by their end, which has a hue, and their origin, which has a tone.

    Attributes
    ----------
    names
        Of the ends, and of the origins.
    tones
        For each end the colours by origin.
    """

    names: Sequence[str]
    tones: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Legend:
    """The legend of a picture.

    Attributes
    ----------
    entries
        Of the classes of pixels.
    others
        Of pixels that have none of these classes; left out where there is little room, unless the labels are short.
    is_short
        Whether the labels have short forms.
    scale
        Of numbers that are drawn over the classes.
    table
        The entries by hue and tone, which take their place where there is little room.
    sentence
        What else there is to say.
    over
        Of what layers draw over the picture.
    """

    entries: Sequence[Entry] = ()
    others: Sequence[Entry] = ()
    is_short: bool = False
    scale: ColourScale | None = None
    table: ColourTable | None = None
    sentence: str = ""
    over: Sequence[Entry] = ()


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
class ShownMap:
    """What the legends of a map depend on.

    Attributes
    ----------
    spec
        The map.
    palette
        Its colours.
    times
        Scale of the escape times.
    fates
        Outcomes that the map has.
    is_locked
        Whether the escape times keep their scale.
    results
        Results of the layers by their names, which may be incomplete.
    other
        The view with which it is compared; None for none.
    """

    spec: MapSpec
    palette: Palette
    times: TimeScale
    fates: frozenset[int]
    is_locked: bool = False
    results: Mapping[str, Any] = field(default_factory=dict)
    other: OtherView | None = None

    @classmethod
    def of(cls, frame: EscapeMap, palette: Palette, results: Mapping[str, Any], times: TimeScale | None = None) -> ShownMap:
        """A map with the results of its layers; `times` is the scale of the escape times, None for `fitted_scale`."""
        fates = frozenset(np.unique(frame.fate).tolist())
        return cls(frame.spec, palette, times or fitted_scale(frame), fates, results=results)

    def outcome_entries(self) -> dict[Fate, Entry]:
        """Entries of the fates that the map has and that are no ends."""
        return {fate: entry for fate, entry in reversed(self.palette.outcomes.items()) if fate in self.fates}

    def time_scale(self) -> ColourScale:
        """The scale of the escape times."""
        return ColourScale(self.times.low, self.times.high, self.palette.escape_time, is_locked=self.is_locked)


@dataclass(frozen=True)
class Picture:
    """A picture of a map.

    Attributes
    ----------
    name
        In links and on the command line.
    title, short_title
        Shown above it, and where there is little room.
    help
        What it shows, and how to read it.
    column
        Of its pixel codes.
    colours
        Of the codes, in their order.
    legend
        Its legend.
    has_times
        Whether the escape times are drawn over the codes.
    compares
        Whether it compares the map with another view, and is on the page only.
    """

    name: str
    title: str
    short_title: str
    help: str
    column: str
    colours: Callable[[Palette], Sequence[str]]
    legend: Callable[[ShownMap], Legend]
    has_times: bool = False
    compares: bool = False
