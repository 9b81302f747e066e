"""What a legend says; the page writes it as HTML and figures draw it, from one description."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from plots.pictures.palette import Entry


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
