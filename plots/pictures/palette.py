"""Colours of the page and their meaning: the palette of the paper and a palette safe for colour-blind readers.

A colour has one meaning: outcomes, crossing classes, escape times, orbits and curves share no colour with each other or with a
layer. The colours of a layer are in its entries in `plots.layers`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cache, cached_property
from itertools import accumulate
from typing import Any

import numpy as np

from engine import Fate, Outcome
from engine.propagation.fates import UNRESOLVED, outcome_of
from engine.systems.outcomes import KINDS, Exit


class Mark(Enum):
    """How an entry of a legend shows its colour."""

    PATCH = "patch"
    LINE = "line"
    CHESSBOARD = "chessboard"


@dataclass(frozen=True)
class Entry:
    """An entry of a legend.

    Attributes
    ----------
    label, colour, mark
        Words, colour and shape.
    second_colour
        The other colour of a chessboard.
    group
        Word that neighbouring entries share where there is little room; empty for an entry by itself.
    """

    label: str
    colour: str
    mark: Mark = Mark.PATCH
    second_colour: str = ""
    group: str = ""

    @property
    def short_label(self) -> str:
        """The word where there is little room."""
        return self.group or short_label(self.label)


OUTCOMES: dict[Fate, str] = {
    Fate.NOT_COMPUTED: "not decided yet",
    Fate.FAILED: UNRESOLVED,
    Fate.OUTSIDE: "outside: starts beyond an exit",
    Fate.FORBIDDEN: "forbidden: no such orbit",
    Fate.BOUNDED: "bounded",
}
"""Fates that are not ends, in the order of the pixel codes of all images. Codes of ends or classes follow."""

CROSSING_CLASSES: tuple[tuple[int, str], ...] = ((0, "0 (direct)"), (1, "1"), (2, "2"), (3, "3–10"), (11, "> 10"))
"""(fewest crossings, label) of each class."""

DIFFERENCES = (
    Entry("same: equal outcomes", "#7f7f7f30"),
    Entry("different: other outcomes", "#6a00f4"),
    Entry("in one view only: no orbit in the other view", "#b0904aa0"),
)
"""Legend of the classes of pixels in the comparison of two views."""


def end_places(outcomes: Sequence[Outcome]) -> list[int]:
    """Return the place of each outcome in `Palette.ends`. It depends on kind and number only; surplus outcomes share a place."""
    counts = {key: len(PAPER.of_kinds[key]) for key in KINDS}
    # `accumulate` also returns the sum of all counts, which `zip` drops.
    first_places = dict(zip(counts, accumulate(counts.values(), initial=0), strict=False))
    return [first_places[each.kind.key] + min(each.number, counts[each.kind.key]) - 1 for each in outcomes]


MOST_ORBITS = 5
"""Largest number of orbits, each with its own colour."""

# Parts of labels that short labels omit.
_OMITTED = re.compile(r"^exit |^bounded(?: and|,) | pixels$|(?::| \().*$")

CLEAR = "#00000000"
"""Transparent."""

# Colours of fates without an end, in all palettes, translucent for light and dark pages.
_WITHOUT_END = {
    Fate.NOT_COMPUTED: "#7f9cc855",
    Fate.FAILED: "#000000",
    Fate.OUTSIDE: "#b0904a48",
    Fate.FORBIDDEN: "#ffffff00",
}


@dataclass(frozen=True)
class Palette:
    """A set of colours.

    Attributes
    ----------
    name
        Displayed name.
    of_kinds
        Colours of the outcomes of each of `engine.systems.outcomes.KINDS`, such as exit channels 1 to 8.
    of_fates
        Colours of the fates that are not ends; forbidden starts are clear on light and dark pages.
    classes
        Colours of `CROSSING_CLASSES`, from light to dark.
    times
        Colours of escape times, from fast to slow, evenly spaced on a scale; empty for the scale cividis.
    orbits
        Colours of the chosen orbits, in order.
    """

    name: str
    of_kinds: Mapping[str, tuple[str, ...]] = field(hash=False)
    of_fates: Mapping[Fate, str] = field(hash=False)
    classes: tuple[str, ...]
    times: tuple[str, ...]
    orbits: tuple[str, ...]

    @cached_property
    def escape_time(self) -> tuple[str, ...]:
        """256 colours, from fast to slow escapes."""
        # Matplotlib is slow to import, and only pictures need it.
        from matplotlib import colormaps
        from matplotlib.colors import LinearSegmentedColormap, to_hex

        scale = LinearSegmentedColormap.from_list("times", self.times) if self.times else colormaps["cividis_r"]
        return tuple(to_hex(scale(place)) for place in range(256))

    @property
    def bounded(self) -> str:
        """Colour of bounded orbits."""
        return self.of_fates[Fate.BOUNDED]

    @property
    def channels(self) -> tuple[str, ...]:
        """Colours of the exit channels."""
        return self.of_kinds[Exit.key]

    @property
    def ends(self) -> tuple[str, ...]:
        """Colours of all ends of orbits."""
        return tuple(colour for key in KINDS for colour in self.of_kinds[key])

    @cached_property
    def outcomes(self) -> dict[Fate, Entry]:
        """Legend of fates that are not ends, in the order of the pixel codes."""
        return {fate: Entry(label, self.of_fates[fate]) for fate, label in OUTCOMES.items()}

    @cached_property
    def crossing_entries(self) -> list[Entry]:
        """Legend of the crossing classes."""
        return [Entry(label, colour) for (_, label), colour in zip(CROSSING_CLASSES, self.classes, strict=True)]

    def entry(self, fate: int, outcomes: Sequence[Outcome]) -> Entry:
        """Return the label and colour of a fate. `outcomes` are those of the potential. Without them, all ends are channels."""
        if fate < 1:
            return self.outcomes[Fate(fate)]
        [entry] = self.end_entries([outcome_of(fate, outcomes)])
        return entry

    def end_entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        """Return the labels and colours of a potential's outcomes."""
        ends = self.ends
        return [Entry(outcome.label, ends[place]) for outcome, place in zip(outcomes, end_places(outcomes), strict=True)]

    def legend_entries(self, outcomes: Sequence[Outcome]) -> dict[int, Entry]:
        """Return the labels and colours of the outcomes that occur, by fate."""
        return {fate: entry for fate, entry in enumerate(self.end_entries(outcomes), 1) if outcomes[fate - 1].occurs}

    def path_colour(self, fate: int, outcomes: Sequence[Outcome], slot: int) -> str:
        """Return the colour of a path: that of its end or, without an end, that of the orbit in a slot of the list of orbits."""
        return self.entry(fate, outcomes).colour if fate >= 1 else self.orbits[slot % len(self.orbits)]

    @property
    def outcome_colours(self) -> list[str]:
        """Colours of the pixel codes of fates that are not ends. These codes come first in all pictures."""
        return [entry.colour for entry in self.outcomes.values()]

    @property
    def fate_colours(self) -> list[str]:
        """Colours of the pixel codes of fates, see `image_columns.fate_codes`."""
        return [*self.outcome_colours, *self.ends]


def short_label(label: str) -> str:
    """Return the short form of a label: the number of an exit, the kind of a bounded orbit, or what stands before a remark."""
    return _OMITTED.sub("", label)


@cache
def value_colours(count: int) -> tuple[str, ...]:
    """Return colours of a scale of continuous values, from low to high; they differ for colour-blind readers as well."""
    # Matplotlib is slow to import, and only pictures need it.
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    scale = colormaps["viridis"].resampled(count)
    return tuple(to_hex(scale(k)) for k in range(count))


def rgba(colours: Sequence[str]) -> np.ndarray:
    """Return colours ``#rrggbb`` or ``#rrggbbaa`` as uint8 RGBA, of shape (n, 4)."""
    return np.array([list(bytes.fromhex(colour[1:].ljust(8, "f"))) for colour in colours], np.uint8)


def mixed(colour: str, other: str, share: float) -> str:
    """Interpolate linearly between two colours ``#rrggbb``. `share` is that of the second colour, `other`."""
    pairs = zip(bytes.fromhex(colour[1:]), bytes.fromhex(other[1:]), strict=True)
    return "#" + "".join(f"{round(value + share * (other_value - value)):02x}" for value, other_value in pairs)


PAPER = Palette(
    name="as in the paper",
    of_kinds={
        "exit": ("#2ca02c", "#d62728", "#1f4fd8", "#ff9d1c", "#8e44ad", "#8c564b", "#e377c2", "#17becf"),
        "collision": ("#783060", "#a8a878", "#780000", "#483030"),
        "escape": ("#d8c0c0",),
    },
    of_fates={**_WITHOUT_END, Fate.BOUNDED: "#8f8f8f"},
    classes=("#e2e3fe", "#7db3f4", "#0787b6", "#005769", "#002a2d"),
    times=("#ffe0d6", "#fb9a80", "#dd4a6a", "#8b2b8c", "#3d1f7a", "#150a3c"),
    orbits=("#c30066", "#6987e7", "#43bea5", "#fa8f63", "#4b6d00"),
)
"""Channels 1 to 4 are green, red, blue and orange, crossings light to dark blue, escape times light red to dark violet."""

COLOUR_BLIND_SAFE = Palette(
    name="for everyone",
    of_kinds={
        "exit": ("#009e73", "#d55e00", "#0072b2", "#e69f00", "#cc79a7", "#56b4e9", "#f0e442", "#3b3b3b"),
        "collision": ("#3000d8", "#a83000", "#607878", "#606048"),
        "escape": ("#90d8a8",),
    },
    of_fates={**_WITHOUT_END, Fate.BOUNDED: "#a6a6a6"},
    classes=("#f8e1ff", "#dc9af4", "#93759c", "#703783", "#381543"),
    times=(),
    orbits=("#af2593", "#00c700", "#8e5700", "#99a7f0", "#2b6e60"),
)
"""Channels have colours of Okabe and Ito, crossings are light to dark violet, and times are from cividis."""

PALETTES = {"paper": PAPER, "safe": COLOUR_BLIND_SAFE}
"""Palettes by their names in links."""

DEFAULT_PALETTE = "safe"
"""Name of the palette of pages, figures and live figures for which none is chosen. Everyone can distinguish its exits."""

DEFAULT_COLOURS = PALETTES[DEFAULT_PALETTE]
"""The palette of this name."""


def find_palette(palette: str | Mapping[int, Any], outcomes: Sequence[Outcome] = ()) -> Palette:
    """Return the palette with a name, or the default palette with other colours.

    Parameters
    ----------
    palette
        One of `PALETTES`, or colours of Matplotlib by fate.
    outcomes
        The outcomes with fates 1, 2 and so on; without them, all are exits.

    Raises
    ------
    ValueError
        If there is no such palette, fate or colour.
    """
    if isinstance(palette, Mapping):
        return _recolour(DEFAULT_COLOURS, palette, outcomes)
    if palette not in tuple(PALETTES):
        raise ValueError(f"palette={palette!r}: must be one of {', '.join(PALETTES)}, or a mapping from fates to colours")
    return PALETTES[palette]


def _recolour(palette: Palette, colours: Mapping[int, Any], outcomes: Sequence[Outcome]) -> Palette:
    of_kinds = {key: list(of_kind) for key, of_kind in palette.of_kinds.items()}
    of_fates, count = dict(palette.of_fates), len(outcomes) or MOST_CHANNELS
    for fate, colour in colours.items():
        code = _hex_code(fate, colour)
        is_code = hasattr(fate, "__index__") and not isinstance(fate, bool)
        if is_code and fate in range(1, count + 1):
            of_kind = of_kinds[(outcome := outcome_of(fate, outcomes)).kind.key]
            of_kind[min(outcome.number, len(of_kind)) - 1] = code
        elif is_code and fate in of_fates:
            of_fates[Fate(fate)] = code
        else:
            raise ValueError(f"palette: fate={fate!r}: must be a Fate, or the number of an outcome, 1 to {count}")
    return replace(palette, of_kinds={key: tuple(of_kind) for key, of_kind in of_kinds.items()}, of_fates=of_fates)


def _hex_code(fate: int, colour: Any) -> str:
    # Matplotlib is slow to import, and only pictures need it.
    from matplotlib.colors import is_color_like, to_hex

    if not is_color_like(colour):
        raise ValueError(f"palette: colour of fate {fate}={colour!r}: must be a colour of Matplotlib")
    return to_hex(colour, keep_alpha=True)


MOST_CHANNELS = len(PAPER.channels)
"""Number of exit channels with individual colours."""


@dataclass(frozen=True)
class LineColours:
    """Colours of lines and text on a light or a dark page. A halo is behind a line."""

    limiting_curve: str
    equipotential: str
    critical_equipotential: str
    halo: str
    quiet: str
    text: str


LIGHT = LineColours(
    limiting_curve="#1b1b1b", equipotential="#b9c3cf", critical_equipotential="#7e001d", halo="#ffffff", quiet="#555555",
    text="#1b1b1b",
)  # fmt: skip
DARK = LineColours(
    limiting_curve="#e6e6e6", equipotential="#566170", critical_equipotential="#ffb3b0", halo="#ffffff", quiet="#b0b0b0",
    text="#f0f0f0",
)  # fmt: skip

MEASURED = "#4c8dc4"
"""Colour of measured points."""

SET_ASIDE = "#b9c3cf"
"""Colour of measured points that are excluded from a fit."""

LAW_COLOURS = {"exponential": "#d1495b", "power law": "#b58900"}
"""Colours of fitted decay laws."""

PATCH_EDGE = "#999999"
"""Colour of the edges of patches in legends."""

MARK_EDGE = "#111111"
"""Colour of the edges of marks."""

THRESHOLD = "#6f7f95"
"""Colour of lines at thresholds."""
