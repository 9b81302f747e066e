"""Every colour of the page and what it stands for, once. Maps use the paper's colours."""

from __future__ import annotations

from dataclasses import dataclass

from bokeh.palettes import interp_palette

from engine import Certificate, Fate, Regularity

CHANNELS = ("#2ca02c", "#d62728", "#1f4fd8", "#ff9d1c", "#8e44ad", "#8c564b", "#e377c2", "#17becf")
"""Channels 1, 2, 3, 4 as in the paper: green, red, blue, orange; four more for potentials with more exits."""

BOUNDED = "#8f8f8f"
FORBIDDEN = "#ffffff"
OUTSIDE = "#ece4d2"
NOT_COMPUTED = "#d4deed"
FAILED = "#000000"
INTERIOR = "#f7fafc"

ESCAPE_TIME = interp_palette(["#ffe0d6", "#fb9a80", "#dd4a6a", "#8b2b8c", "#3d1f7a", "#150a3c"], 256)
"""Light red for fast, dark blue and purple for slow escapes."""

LIMITING_CURVE = "#1b1b1b"
EQUIPOTENTIAL = "#b9c3cf"
CRITICAL_EQUIPOTENTIAL = "#d62728"
START = "#111111"
HALO = "#ffffff"
"""Under the crosses and the exits, so that they stand out from any basin."""

PATCH_EDGE = "#999999"
QUIET_TEXT = "#555555"
ORBIT = "#1d4e89"
ORBIT_DENSITY = ["#a9c6e8", "#1d4e89", "#081c3a"]
"""Seldom to often visited, for orbits drawn by datashader."""

THRESHOLD = "#d62728"


@dataclass(frozen=True)
class Entry:
    """A line of a legend."""

    label: str
    colour: str


# The pixel codes of all images: these outcomes first, in this order, then channels or crossing classes.
OUTCOMES: dict[Fate, Entry] = {
    Fate.NOT_COMPUTED: Entry("not decided yet", NOT_COMPUTED),
    Fate.FAILED: Entry("failed", FAILED),
    Fate.OUTSIDE: Entry("outside: starts beyond an exit", OUTSIDE),
    Fate.FORBIDDEN: Entry("forbidden: no such orbit", FORBIDDEN),
    Fate.BOUNDED: Entry("bounded", BOUNDED),
}

CROSSING_CLASSES: tuple[tuple[int, Entry], ...] = (
    (0, Entry("0 (direct)", "#e3342f")),
    (1, Entry("1", "#1f4fd8")),
    (2, Entry("2", "#e83ec9")),
    (3, Entry("3–10", "#ff9d1c")),
    (11, Entry("> 10", "#2ca02c")),
)
"""(fewest crossings, entry) of each class, in the paper's colours."""

CHARACTERS: dict[Regularity, Entry] = {
    Regularity.NO_QUESTION: Entry("escapes", "#f4ead2"),
    Regularity.REGULAR: Entry("bounded and regular", "#2b6cb0"),
    Regularity.CHAOTIC: Entry("bounded and chaotic", "#d9480f"),
    Regularity.NOT_JUDGED: Entry("bounded, not judged yet", BOUNDED),
}
"""What the pixels of the picture of regular and chaotic orbits stand for, after the outcomes."""

CHARACTER_COLOURS = [*(entry.colour for entry in OUTCOMES.values()), *(entry.colour for entry in CHARACTERS.values())]
FATE_COLOURS = [*(entry.colour for entry in OUTCOMES.values()), *CHANNELS]
CROSSING_COLOURS = [
    *(entry.colour for entry in OUTCOMES.values()),
    *(entry.colour for _, entry in CROSSING_CLASSES),
    # Bounded pixels, by their certificates.
    *(BOUNDED for _ in Certificate),
]
# Under the escape times, which cover the escaped pixels.
BACKGROUND_COLOURS = [*(entry.colour for entry in OUTCOMES.values()), *["#ffffff"] * len(CHANNELS)]
# The plain interior of the first map.
REGION_COLOURS = [OUTCOMES[fate].colour if fate in (Fate.OUTSIDE, Fate.FORBIDDEN) else INTERIOR for fate in OUTCOMES] + [
    INTERIOR
] * len(CHANNELS)


def channel_entries(channels: int) -> list[Entry]:
    """Legend of a potential's channels."""
    return [Entry(f"channel {k + 1}", CHANNELS[k]) for k in range(channels)]
