"""Define a picture of a map: pixel codes, colours, legend and help text."""

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
    """A scale of numbers. The colours at its ends stand for all smaller and all larger numbers.

    Attributes
    ----------
    low, high
        Ends of the scale.
    colours
        Colours from low to high.
    is_logarithmic
        Whether equal steps of colour are equal ratios of the numbers.
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
    """Colours of orbits. The end of an orbit sets the hue, and the origin sets the tone.

    Attributes
    ----------
    names
        Names of the ends, which are also those of the origins.
    tones
        For each end, the colours by origin.
    """

    names: Sequence[str]
    tones: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Legend:
    """The legend of a picture.

    Attributes
    ----------
    entries
        Entries of the classes of pixels.
    others
        Entries of pixels without a class. They are omitted where there is little room, unless `is_short`.
    is_short
        Whether the labels have short forms.
    scale
        Scale of the numbers that the picture shows; None if it shows none.
    table
        Table by hue and tone, which replaces the entries where there is little room.
    sentence
        Further text.
    over
        Entries of what layers draw over the picture.
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
        Description of the view.
    outcomes
        Outcomes of the view's potential.
    axes
        Symbols of its axes.
    fates
        Fates that occur on its map.
    """

    title: str
    outcomes: tuple[Outcome, ...]
    axes: tuple[str, str]
    fates: frozenset[int] = frozenset()


def occurring_fates(frame: EscapeMap) -> frozenset[int]:
    """Return the fates that occur on a map."""
    return frozenset(np.unique(frame.fate).tolist())


@dataclass(frozen=True)
class ShownMap:
    """What the legends of a map depend on.

    Attributes
    ----------
    spec
        Request of the map.
    palette
        Colours of the map.
    times
        Scale of the escape times.
    fates
        Fates that occur on the map.
    is_locked
        Whether the scale of the escape times is kept from map to map.
    results
        Results of the layers, by name. A result may be incomplete.
    other
        The view with which the map is compared; None if there is none.
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
        """Return a map with the results of its layers. `times` is the scale of the escape times; None means `fitted_scale`."""
        return cls(frame.spec, palette, times or fitted_scale(frame), occurring_fates(frame), results=results)

    def outcome_entries(self, other: OtherView | None = None) -> dict[Fate, Entry]:
        """Return the entries of the fates that are not ends, of the map or of another view, bounded orbits first."""
        fates = self.fates if other is None else other.fates
        return {fate: entry for fate, entry in reversed(self.palette.outcomes.items()) if fate in fates}

    def time_scale(self) -> ColourScale:
        """Return the scale of the escape times."""
        return ColourScale(self.times.low, self.times.high, self.palette.escape_time, is_locked=self.is_locked)


@dataclass(frozen=True)
class Picture:
    """A picture of a map.

    Attributes
    ----------
    name
        Name in links and on the command line.
    title, short_title
        Title above the picture, and a shorter one where there is little room.
    help
        What the picture shows, and how to read it.
    column
        Name of the column of its pixel codes.
    colours
        Colours of the codes, in order.
    legend
        Legend of the picture.
    has_times
        Whether the escape times are drawn over the codes.
    title_of
        Returns the title for a map, if it depends on the map.
    compares
        Whether the picture compares the map with another view. Only the page has such pictures.
    """

    name: str
    title: str
    short_title: str
    help: str
    column: str
    colours: Callable[[Palette], Sequence[str]]
    legend: Callable[[ShownMap], Legend]
    has_times: bool = False
    title_of: Callable[[MapSpec], str] | None = None
    compares: bool = False

    def title_for(self, spec: MapSpec) -> str:
        """Return the title above the picture of a map."""
        return self.title if self.title_of is None else self.title_of(spec)
