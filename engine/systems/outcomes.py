"""What an orbit can end at besides an exit over a saddle: centres with a radius of collision, and an escape circle."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from engine.foundations.validation import check_type, checked_number, replace_unchecked

SMALLEST_RADIUS, LARGEST_RADIUS = 1e-6, 1e6
"""Legal radii of centres and of escape, dimensionless: steps near the singularity of a smaller disc would not change t."""


@dataclass(frozen=True)
class Centre:
    """A body: an orbit that enters the disc around it has collided with it.

    Parameters
    ----------
    x, y
        Its place, finite, dimensionless.
    radius
        Radius of the disc, 1e-6 to 1e6, dimensionless.
    name
        Its name in texts, such as "the Moon"; empty for its number.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    x: float
    y: float
    radius: float
    name: str = ""

    def __post_init__(self) -> None:
        check_type("name", self.name, str)
        for axis in ("x", "y"):
            object.__setattr__(self, axis, checked_number(f"centre {axis}", getattr(self, axis)))
        object.__setattr__(self, "radius", checked_radius("centre radius", self.radius))

    def scaled(self, factor: float) -> Centre:
        """The same centre in other units of length; a power of 2 as factor is exact."""
        # Legal radii are in the units of the system.
        return replace_unchecked(self, x=self.x * factor, y=self.y * factor, radius=self.radius * factor)

    def contains(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Whether points of any shape lie in its disc."""
        inside: np.ndarray = np.hypot(x - self.x, y - self.y) < self.radius
        return inside


def checked_radius(name: str, value: object) -> float:
    """A legal radius as a float."""
    radius = checked_number(name, value, f"a number from {SMALLEST_RADIUS:g} to {LARGEST_RADIUS:g}")
    if not SMALLEST_RADIUS <= radius <= LARGEST_RADIUS:
        raise ValueError(f"{name}={radius!r}: must be from {SMALLEST_RADIUS:g} to {LARGEST_RADIUS:g}")
    return radius


class OutcomeKind(Enum):
    """How an orbit ends."""

    EXIT = "exit"
    COLLISION = "collision"
    ESCAPE = "escape"


@dataclass(frozen=True)
class Outcome:
    """How orbits of a fate of 1 or more end.

    Attributes
    ----------
    kind
        Through an exit over a saddle, by a collision with a centre, or beyond the escape radius.
    label
        In legends and tables: "channel 1", "collision with the Moon", "escape".
    action
        What orbits do: "escape through channel 1", "collide with the Moon", "escape beyond the escape radius".
    occurs
        Whether orbits can have it: not a channel that is part of an exit of a lower number.
    """

    kind: OutcomeKind
    label: str
    action: str
    occurs: bool = True

    @property
    def present(self) -> str:
        """What an orbit does: "escapes through channel 1"."""
        verb, rest = self.action.split(" ", 1)
        return f"{verb}s {rest}"

    @property
    def past(self) -> str:
        """What an orbit has done, as the beginning of a sentence: "Escaped through channel 1"."""
        verb, rest = self.action.split(" ", 1)
        return f"{verb.capitalize()}d {rest}"

    @property
    def event(self) -> str:
        """What ends an orbit: "escape" or "collision"."""
        return "collision" if self.kind is OutcomeKind.COLLISION else "escape"

    @property
    def sentence(self) -> str:
        """What an orbit has done, as a sentence: "Escaped through channel 1."."""
        return f"{self.past}."


def exit_outcome(channel: int | str, *, occurs: bool = True) -> Outcome:
    """The outcome of orbits that leave through a channel, given by its number or its name."""
    return Outcome(OutcomeKind.EXIT, f"channel {channel}", f"escape through channel {channel}", occurs)


def outcomes_of(channels: int, centres: tuple[Centre, ...], has_escape_radius: bool) -> tuple[Outcome, ...]:
    """The outcomes of a system; the fate of an orbit is 1 for the first one."""
    exits = [exit_outcome(channel) for channel in range(1, channels + 1)]
    names = [centre.name or f"centre {number}" for number, centre in enumerate(centres, 1)]
    collisions = [Outcome(OutcomeKind.COLLISION, f"collision with {name}", f"collide with {name}") for name in names]
    escape = [Outcome(OutcomeKind.ESCAPE, "escape", "escape beyond the escape radius")] if has_escape_radius else []
    return (*exits, *collisions, *escape)


def write_outcomes(outcomes: Sequence[Outcome]) -> str:
    """Outcomes as an attribute of files."""
    return json.dumps([[each.kind.value, each.label, each.action, each.occurs] for each in outcomes])


def read_outcomes(text: str) -> tuple[Outcome, ...]:
    """The outcomes of an attribute."""
    return tuple(Outcome(OutcomeKind(kind), *rest) for kind, *rest in json.loads(text))
