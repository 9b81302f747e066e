"""Colours of the page and their meaning: the palette of the paper and a colour-blind safe one.

A colour has one meaning: outcomes, crossing classes, escape times, characters, orbits and curves have no colour in common.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import accumulate

import numpy as np

from engine import Evidence, Fate, Outcome, Regularity, StableManifolds
from engine.propagation.fates import UNRESOLVED, outcome_of
from engine.systems.outcomes import KINDS, Exit


@dataclass(frozen=True)
class Entry:
    """Entry of a legend."""

    label: str
    colour: str


OUTCOMES: dict[Fate, str] = {
    Fate.NOT_COMPUTED: "not decided yet",
    Fate.FAILED: UNRESOLVED,
    Fate.OUTSIDE: "outside: starts beyond an exit",
    Fate.FORBIDDEN: "forbidden: no such orbit",
    Fate.BOUNDED: "bounded",
}
"""Fates that are no ends, in the order of the pixel codes of all images; ends or classes follow."""

CROSSING_CLASSES: tuple[tuple[int, str], ...] = ((0, "0 (direct)"), (1, "1"), (2, "2"), (3, "3–10"), (11, "> 10"))
"""(fewest crossings, label) of each class."""

CHARACTERS: dict[Regularity, str] = {
    Regularity.NOT_APPLICABLE: "escapes",
    Regularity.REGULAR: "bounded and regular",
    Regularity.CHAOTIC: "bounded and chaotic",
    Regularity.NO_SIGN_OF_CHAOS: "bounded, no sign of chaos until t_max",
    Regularity.NOT_JUDGED: "bounded, not judged yet",
}
"""Classes of the picture of regular and chaotic orbits."""

DIFFERENCES: tuple[tuple[str, str], ...] = (
    ("same end", "#7f7f7f30"),
    ("other end", "#6a00f4"),
    ("start in one view only", "#b0904aa0"),
)
"""(label, colour) of each class of pixels of two views."""


def end_places(outcomes: Sequence[Outcome]) -> list[int]:
    """The place of each outcome in `Palette.ends`, the same in all systems; those beyond share the last of a kind."""
    counts = {key: len(PAPER.of_kinds[key]) for key in KINDS}
    firsts = dict(zip(counts, accumulate(counts.values(), initial=0), strict=False))
    return [firsts[each.kind.key] + min(each.number, counts[each.kind.key]) - 1 for each in outcomes]


MOST_ORBITS = 5
"""Orbits that have a colour."""

# Translucent, for light and dark pages.
_FORBIDDEN = "#ffffff00"
_OUTSIDE = "#b0904a48"
_NOT_COMPUTED = "#7f9cc855"
_INTERIOR = "#7aa7d618"
_FAILED = "#000000"

# For origins 1 to 13: share of white (positive) or black (negative) mixed into the colour of the end.
_ORIGIN_TONES = (0.6, 0.0, -0.4, -0.65, 0.35, -0.2, 0.78, -0.8, 0.48, -0.52, 0.2, -0.3, 0.7)
# For orbits that never entered: share of the colour of bounded orbits.
_BOUNDED_ORIGIN = 0.65


@dataclass(frozen=True)
class Palette:
    """Set of colours.

    Attributes
    ----------
    name
        Displayed name.
    of_kinds
        Of the outcomes of each of `engine.systems.outcomes.KINDS`, such as those of the exit channels 1 to 8.
    bounded
        Of bounded orbits.
    classes
        Of each of `CROSSING_CLASSES`, from light to dark.
    times
        Of escape times, from fast to slow: colours at even distances of a scale, or empty for the scale cividis.
    characters
        Of escaping, regular and chaotic orbits, and those without a sign of chaos; others have the colour of bounded ones.
    orbits
        Of the chosen orbits, in order.
    """

    name: str
    of_kinds: Mapping[str, tuple[str, ...]] = field(hash=False)
    bounded: str
    classes: tuple[str, ...]
    times: tuple[str, ...]
    characters: tuple[str, str, str, str]
    orbits: tuple[str, ...]

    @cached_property
    def escape_time(self) -> tuple[str, ...]:
        """256 colours, from fast to slow escapes."""
        # Slow to import, and needed for pictures only.
        from matplotlib import colormaps
        from matplotlib.colors import LinearSegmentedColormap, to_hex

        scale = LinearSegmentedColormap.from_list("times", self.times) if self.times else colormaps["cividis_r"]
        return tuple(to_hex(scale(place)) for place in range(256))

    @property
    def channels(self) -> tuple[str, ...]:
        """Colours of the exit channels."""
        return self.of_kinds[Exit.key]

    @property
    def ends(self) -> tuple[str, ...]:
        """Colours of all that orbits can end at."""
        return tuple(colour for key in KINDS for colour in self.of_kinds[key])

    @cached_property
    def outcomes(self) -> dict[Fate, Entry]:
        """Legend of fates that are no ends, in the order of the pixel codes."""
        colours = (_NOT_COMPUTED, _FAILED, _OUTSIDE, _FORBIDDEN, self.bounded)
        return {fate: Entry(label, colour) for (fate, label), colour in zip(OUTCOMES.items(), colours, strict=True)}

    @cached_property
    def difference_entries(self) -> list[Entry]:
        """Legend of the comparison of two views."""
        return [Entry(label, colour) for label, colour in DIFFERENCES]

    @cached_property
    def crossing_entries(self) -> list[Entry]:
        """Legend of the crossing classes."""
        return [Entry(label, colour) for (_, label), colour in zip(CROSSING_CLASSES, self.classes, strict=True)]

    @cached_property
    def character_entries(self) -> list[Entry]:
        """Legend of regular and chaotic orbits."""
        return [Entry(label, colour) for label, colour in zip(CHARACTERS.values(), (*self.characters, self.bounded), strict=True)]

    def passage_colour(self, origin: int, fate: int) -> str:
        """Colour of orbits from an end to an end, 1 for the first, 0 for none: the hue shows the fate, the tone the origin."""
        colour = self.ends[fate - 1] if fate else self.bounded
        if origin == 0:
            return _mixed(colour, self.bounded, _BOUNDED_ORIGIN)
        tone = _ORIGIN_TONES[(origin - 1) % len(_ORIGIN_TONES)]
        return _mixed(colour, "#ffffff" if tone > 0 else "#000000", abs(tone))

    def entry(self, fate: int, outcomes: Sequence[Outcome]) -> Entry:
        """Label and colour of a fate; `outcomes` are those of the potential, channels where they are not known."""
        if fate < 1:
            return self.outcomes[Fate(fate)]
        outcome = outcome_of(fate, outcomes)
        return Entry(outcome.label, self.ends[end_places([outcome])[0]])

    def end_entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        """Labels and colours of a potential's outcomes."""
        return [self.entry(fate, outcomes) for fate in range(1, len(outcomes) + 1)]

    def legend_entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        """Those of the outcomes that occur."""
        return [entry for entry, outcome in zip(self.end_entries(outcomes), outcomes, strict=True) if outcome.occurs]

    def manifold_entries(self, manifolds: StableManifolds) -> list[Entry]:
        """Legend of stable manifolds."""
        channels = sorted({arc.channel for arc in manifolds.arcs})
        return [Entry(f"stable manifold of Lyapunov orbit {channel}", self.channels[channel - 1]) for channel in channels]

    def passage_entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        """Legend of origin and fate, as a list."""
        ends = {0: "inside"} | {
            place + 1: short_label(end.label) for place, end in zip(end_places(outcomes), outcomes, strict=True) if end.occurs
        }
        pairs = ((origin, fate) for origin in ends for fate in ends if fate)
        return [Entry(f"{ends[origin]} to {ends[fate]}", self.passage_colour(origin, fate)) for origin, fate in pairs]

    @cached_property
    def fate_colours(self) -> list[str]:
        """Colours of the pixel codes of the basins."""
        return [*self._outcome_colours, *self.ends]

    @cached_property
    def crossing_colours(self) -> list[str]:
        """Colours of the pixel codes of the crossings; bounded pixels have one code per kind of evidence."""
        return [*self._outcome_colours, *self.classes, *(self.bounded for _ in Evidence)]

    @cached_property
    def character_colours(self) -> list[str]:
        """Colours of the pixel codes of regular and chaotic orbits."""
        return [*self._outcome_colours, *(entry.colour for entry in self.character_entries)]

    @cached_property
    def difference_colours(self) -> list[str]:
        """Colours of the pixel codes of the comparison of two views."""
        return [*self._outcome_colours, *(entry.colour for entry in self.difference_entries)]

    @cached_property
    def passage_colours(self) -> list[str]:
        """Colours of the pixel codes of origins and fates: by origin, none first, then by fate."""
        ends = range(len(self.ends) + 1)
        return [*self._outcome_colours, *(self.passage_colour(origin, fate) for origin in ends for fate in ends)]

    @cached_property
    def background_colours(self) -> list[str]:
        """Colours of the pixel codes under the escape times, which cover escaped pixels."""
        return [*self._outcome_colours, *([_FORBIDDEN] * len(self.ends))]

    @cached_property
    def region_colours(self) -> list[str]:
        """Colours of the pixel codes of the picture of the exits, in which the interior has one colour."""
        plain = [self.outcomes[fate].colour if fate in (Fate.OUTSIDE, Fate.FORBIDDEN) else _INTERIOR for fate in OUTCOMES]
        return [*plain, *([_INTERIOR] * len(self.ends))]

    @property
    def _outcome_colours(self) -> list[str]:
        return [entry.colour for entry in self.outcomes.values()]


def short_label(label: str) -> str:
    """A label where there is little room: of a channel its number, and what stands before a colon."""
    return label.removeprefix("channel ").partition(":")[0]


def rgba(colours: Sequence[str]) -> np.ndarray:
    """(n, 4) uint8 of colours ``#rrggbb`` or ``#rrggbbaa``."""
    return np.array([list(bytes.fromhex(colour[1:].ljust(8, "f"))) for colour in colours], np.uint8)


def _mixed(colour: str, other: str, share: float) -> str:
    """Linear interpolation between two colours ``#rrggbb``."""
    pairs = zip(bytes.fromhex(colour[1:]), bytes.fromhex(other[1:]), strict=True)
    return "#" + "".join(f"{round(one + share * (two - one)):02x}" for one, two in pairs)


PAPER = Palette(
    name="as in the paper",
    of_kinds={
        "exit": ("#2ca02c", "#d62728", "#1f4fd8", "#ff9d1c", "#8e44ad", "#8c564b", "#e377c2", "#17becf"),
        "collision": ("#783060", "#a8a878", "#780000", "#483030"),
        "escape": ("#d8c0c0",),
    },
    bounded="#8f8f8f",
    classes=("#e2e3fe", "#7db3f4", "#0787b6", "#005769", "#002a2d"),
    times=("#ffe0d6", "#fb9a80", "#dd4a6a", "#8b2b8c", "#3d1f7a", "#150a3c"),
    characters=("#f4ead2", "#40e8e6", "#d81fa4", "#a0c0b0"),
    orbits=("#c30066", "#6987e7", "#43bea5", "#fa8f63", "#4b6d00"),
)
"""Channels 1 to 4 green, red, blue, orange; crossings light to dark blue; fast escapes light red, slow ones dark."""

COLOUR_BLIND_SAFE = Palette(
    name="colour-blind safe",
    of_kinds={
        "exit": ("#009e73", "#d55e00", "#0072b2", "#f0e442", "#cc79a7", "#56b4e9", "#e69f00", "#3b3b3b"),
        "collision": ("#3000d8", "#a83000", "#607878", "#606048"),
        "escape": ("#90d8a8",),
    },
    bounded="#a6a6a6",
    classes=("#f8e1ff", "#dc9af4", "#93759c", "#703783", "#381543"),
    times=(),
    characters=("#f3efe2", "#87e9f1", "#ff234a", "#20c0d8"),
    orbits=("#af2593", "#00c700", "#8e5700", "#99a7f0", "#2b6e60"),
)
"""Channels after Okabe and Ito, crossings light to dark violet, times from cividis."""

PALETTES = {"paper": PAPER, "safe": COLOUR_BLIND_SAFE}
"""Palettes by their names in links."""

MOST_CHANNELS = len(PAPER.channels)
"""Exit channels that have a colour."""


@dataclass(frozen=True)
class LineColours:
    """Colours of lines and text on a light or a dark page."""

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

DOUBT = ("#000000", "#ffffff")
"""Colours of doubtful pixels, which alternate as on a chessboard: one of the two is visible on any colour."""

MEASURED, SET_ASIDE = "#4c8dc4", "#b9c3cf"
"""Colours of measured points, and of those that a fit leaves out."""

LAW_COLOURS = {"exponential": "#d1495b", "power law": "#b58900"}
"""Colours of fitted decay laws."""

PATCH_EDGE = "#999999"
MARK_EDGE = "#111111"
THRESHOLD = "#6f7f95"
