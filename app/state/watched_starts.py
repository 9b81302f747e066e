"""Starts of the orbits in the player of many orbits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from engine import Potential
from plots.links.link_formats import Format, listed, read_number

LARGEST_SEED = 2**31 - 1
"""Largest seed of the random generator in the browser."""


class StartsFrom(StrEnum):
    """Where the starts are placed. Links contain the values."""

    WELL = "well"
    VIEW = "view"
    BOX = "box"
    DISC = "disc"
    EXITS = "exits"
    TUBES = "tubes"


PLACES = {
    StartsFrom.WELL: "in the whole well",
    StartsFrom.VIEW: "in the view",
    StartsFrom.BOX: "in the box",
    StartsFrom.DISC: "around the chosen orbit",
    StartsFrom.EXITS: "on the exits, entering",
    StartsFrom.TUBES: "at the tubes that lead out",
}
"""Phrases for the places of starts."""

EXPLANATIONS = {
    StartsFrom.TUBES: (
        "Half of the orbits start just inside a tube that leads to an exit, and leave at their next pass. The others start just "
        "outside, and turn back."
    ),
    StartsFrom.EXITS: (
        "Orbits enter through the exits, as often as the flux says. The curve is the distribution of the times until they leave."
    ),
}
"""Explanations of the places that need more than their phrase."""


def places_for(potential: Potential) -> dict[StartsFrom, str]:
    """Return the places of a system, with their phrases. Exits need saddles; tubes also need a frame that does not rotate."""
    missing_places = set[StartsFrom]()
    if not potential.escapes_over_saddles:
        missing_places |= {StartsFrom.EXITS, StartsFrom.TUBES}
    if potential.rotation:
        missing_places.add(StartsFrom.TUBES)
    return {where: words for where, words in PLACES.items() if where not in missing_places}


WATCH_KEY = "w"
"""Key of the page that plays or pauses the orbits."""

COUNTS = (1000, 5000, 20000)
"""Possible numbers of orbits."""

SMALLEST_LOG_RADIUS = -9.0
"""Decimal logarithm of the smallest radius of a disc, as a share of half the window."""

LARGEST_LOG_RADIUS = -1.0
"""Decimal logarithm of the largest radius of a disc, as a share of half the window."""


@dataclass(frozen=True)
class WatchedStarts:
    """A choice of random starts. Equal choices give equal starts.

    Attributes
    ----------
    where
        Place of the starts: the energy surface; the slice in view, the box, or a disc around the chosen start; the exits, inward;
        or the edges of the tubes of the Lyapunov orbits.
    count
        Number of orbits, one of `COUNTS`.
    seed
        Seed of the generator, 0 to 2³¹ − 1.
    radius
        Decimal logarithm of the radius of the disc as a share of half the window.

    Raises
    ------
    ValueError
        If a value is not legal, with the legal values.
    """

    where: StartsFrom = StartsFrom.WELL
    count: int = 5000
    seed: int = 1
    radius: float = -2.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "where", StartsFrom(self.where))
        if self.count not in COUNTS:
            raise ValueError(f"count={self.count}: must be one of {', '.join(map(str, COUNTS))}")
        if not 0 <= self.seed <= LARGEST_SEED:
            raise ValueError(f"seed={self.seed}: must be from 0 to {LARGEST_SEED}")
        if not SMALLEST_LOG_RADIUS <= self.radius <= LARGEST_LOG_RADIUS:
            raise ValueError(f"radius={self.radius:g}: must be from {SMALLEST_LOG_RADIUS:g} to {LARGEST_LOG_RADIUS:g}")


def _read_watched(text: str) -> WatchedStarts:
    where, count, seed, radius = text.split(",")
    return WatchedStarts(StartsFrom(where), int(count), int(seed), read_number(radius))


WATCHED = Format(
    lambda watched: f"{watched.where},{watched.count},{watched.seed},{watched.radius:g}",
    _read_watched,
    lambda: f"{listed(StartsFrom)}, {listed(map(str, COUNTS))}, a seed, and log10 of a radius, such as well,5000,1,-2",
)
"""Text form of the starts in a link."""
