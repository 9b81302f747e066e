"""The ends of orbits: exits over saddles, centres with a radius of collision, and an escape circle.

Each kind of outcome is a class in `KINDS` with texts. A kind other than `Exit` also has a place, a row for the kernels, a clause
after a formula, and an attribute in files. The colours of each kind are in `plots.pictures.palette`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import groupby
from typing import Any, ClassVar, Self

import numpy as np

from engine.foundations.validation import check_type, checked_between, checked_number, replace_unchecked
from engine.foundations.wording import format_number
from engine.integrator.kernels.exit_geometry import (
    CIRCLE,
    COEFFICIENTS,
    CURVE_COLUMNS,
    DISC,
    HALF_WIDTH,
    ORIGIN_X,
    ORIGIN_Y,
    SHAPE,
)

SMALLEST_RADIUS = 1e-6
"""Smallest radius of a centre or of escape, dimensionless. In a smaller disc, steps near a singularity would not change t."""

LARGEST_RADIUS = 1e6
"""Largest radius of a centre or of escape, dimensionless."""


def _checked_radius(name: str, radius: float) -> float:
    return checked_between(name, radius, SMALLEST_RADIUS, LARGEST_RADIUS)


class Kind:
    """A way in which orbits end.

    Attributes
    ----------
    key
        Name of the kind in files and in palettes.
    word
        The word for the place where orbits end: "exit", "centre".
    label, action
        Label and action of an outcome, with {} for its name. The action begins with a verb.
    verbs
        The verb of the action in the present and in the past tense.
    event
        One word for the event that ends an orbit: "escape", "collision".
    origin
        Text on the beginning of an orbit that ends in this way backward in time, with {label} and {present} of the outcome.
    """

    key: ClassVar[str]
    word: ClassVar[str]
    label: ClassVar[str]
    action: ClassVar[str]
    verbs: ClassVar[tuple[str, str]] = "escapes", "escaped"
    event: ClassVar[str] = "escape"
    origin: ClassVar[str] = "backward in time it {present}"

    @classmethod
    def outcome(cls, number: int, name: str = "", *, occurs: bool = True) -> Outcome:
        """Return the outcome with a number among the outcomes of this kind. By default, its name is "exit 1", "centre 1", …"""
        full_name = name or f"{cls.word} {number}"
        return Outcome(cls, cls.label.format(full_name), cls.action.format(full_name), occurs, number)


class Exit(Kind):
    """An exit over a saddle: a curve or line across a channel, see `engine.exits`."""

    key = word = "exit"
    label, action = "{}", "escape through {}"
    origin = "entered through {label}"


@dataclass(frozen=True)
class End(Kind):
    """An end other than an exit over a saddle: the edge of a disc, or another circle in a subclass.

    Attributes
    ----------
    side
        The side of the circle on which orbits have ended: −1 inside, 1 outside.
    clause, syntax, spellings
        For the clause after a formula: pattern of the parameters, in which a name has at most 40 characters; description of the
        clause in errors; other spellings of `word`.
    most_clauses
        Largest number of clauses of this kind after a formula.
    attribute
        Name of the attribute in files.
    x, y, radius, name
        See `Centre`.
    """

    side: ClassVar[int] = -1
    clause: ClassVar[str] = r"\s*(?P<name>[\w ]{0,40}?)\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)(?P<radius>[^();]*)$"
    syntax: ClassVar[str] = "{} (x, y) radius"
    spellings: ClassVar[tuple[str, ...]] = ()
    most_clauses: ClassVar[int] = 8
    attribute: ClassVar[str]

    x: float
    y: float
    radius: float
    name: str = ""

    def __post_init__(self) -> None:
        check_type("name", self.name, str)
        for axis in ("x", "y"):
            object.__setattr__(self, axis, checked_number(f"{self.word} {axis}", getattr(self, axis)))
        object.__setattr__(self, "radius", _checked_radius(f"{self.word} radius", self.radius))

    @classmethod
    def match(cls, clause: str) -> re.Match[str] | None:
        """Match a clause of this kind, and return the match with its parameters; None for other clauses."""
        return re.match(rf"\s*(?:{'|'.join((cls.word, *cls.spellings))}){cls.clause}", clause)

    @classmethod
    def make(cls, **parameters: Any) -> list[Self]:
        """Return the ends that a clause with these parameters describes."""
        return [cls(**parameters)]

    @property
    def place(self) -> tuple[float, float]:
        """A point that belongs to the end: its centre."""
        return self.x, self.y

    def image(self, signs: tuple[float, float]) -> Hashable:
        """Return a key of the mirror image of the end in its kind, given the factors of x and y."""
        return self.key, signs[0] * self.x, signs[1] * self.y, self.radius

    @property
    def text(self) -> str:
        """The clause of the end, with all digits of the numbers."""
        return f"{self.word} {self.name + ' ' if self.name else ''}({self.x!r}, {self.y!r}) {self.radius!r}"

    @property
    def geometry(self) -> str:
        """A description of the circle, such as "disc of radius 0.1 around (1, 0)"."""
        return f"disc of radius {format_number(self.radius)} around ({format_number(self.x)}, {format_number(self.y)})"

    @classmethod
    def write(cls, ends: Sequence[End]) -> Any:
        """Return all ends of the kind as their attribute in files."""
        return json.dumps([asdict(end) for end in ends])

    @classmethod
    def read(cls, attribute: Any) -> list[Self]:
        """Return the ends described by an attribute."""
        return [cls(**values) for values in json.loads(attribute)]

    @property
    def row(self) -> np.ndarray:
        """The circle as a row of the table of exits in `engine.integrator.kernels.exit_geometry`."""
        row = np.zeros(CURVE_COLUMNS)
        shape = DISC if self.side < 0 else CIRCLE
        row[[ORIGIN_X, ORIGIN_Y, HALF_WIDTH, SHAPE, COEFFICIENTS]] = self.x, self.y, self.radius, shape, np.pi
        return row

    def scaled(self, factor: float) -> Self:
        """Return the end with lengths multiplied by a factor, exactly for powers of 2."""
        # The legal range of radii applies only in the units of the potential.
        return replace_unchecked(self, x=self.x * factor, y=self.y * factor, radius=self.radius * factor)

    def moved(self, x: float, y: float) -> Self:
        """Return the end with the origin of the axes moved to (x, y)."""
        return replace(self, x=self.x - x, y=self.y - y)

    def contains(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return whether points, given by arrays of the same shape, lie where orbits have ended."""
        distance = np.hypot(x - self.x, y - self.y)
        return distance < self.radius if self.side < 0 else distance > self.radius


class Centre(End):
    """A body. An orbit that enters the disc around the body has collided with it.

    Parameters
    ----------
    x, y
        Place of the body, finite, dimensionless.
    radius
        Radius of the disc, 1e-6 to 1e6, dimensionless.
    name
        Name of the body in texts, such as "the Moon"; empty to use its number.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    key, word, event, attribute = "collision", "centre", "collision", "centres"
    label, action, verbs = "collision with {}", "collide with {}", ("collides", "collided")
    spellings = ("center",)


@dataclass(frozen=True)
class EscapeCircle(End):
    """The circle around the origin beyond which orbits have escaped. With such a circle, saddles are not exits."""

    key, word, attribute = "escape", "escape", "escape_radius"
    label, action = "escape", "escape beyond the escape radius"
    side, clause, syntax, most_clauses = 1, "(?P<radius>[^;]*)$", "one {} radius", 1

    x: float = field(default=0.0, init=False, repr=False)
    y: float = field(default=0.0, init=False, repr=False)
    name: str = field(default="", init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", _checked_radius("escape_radius", self.radius))

    @property
    def text(self) -> str:
        """See `End.text`."""
        return f"{self.word} {self.radius!r}"

    @property
    def geometry(self) -> str:
        """See `End.geometry`."""
        return f"escape radius {format_number(self.radius)}"

    def moved(self, x: float, y: float) -> Self:
        """Return the circle itself, which is around any origin."""
        return self

    @classmethod
    def write(cls, ends: Sequence[End]) -> Any:
        """Return the radius; 0 if there is no circle."""
        return ends[0].radius if ends else 0.0

    @classmethod
    def read(cls, attribute: Any) -> list[Self]:
        """Return the circle of a radius; nothing for 0."""
        return [cls(float(attribute))] if float(attribute) else []


KINDS: dict[str, type[Kind]] = {kind.key: kind for kind in (Exit, Centre, EscapeCircle)}
"""The kinds by their keys, in the order of fates."""


@dataclass(frozen=True)
class Outcome:
    """The end of orbits with a fate of 1 or more.

    Attributes
    ----------
    kind
        The class of the outcome: an exit over a saddle, a collision with a centre, or the escape circle.
    label
        Name in legends and tables: "exit 1", "collision with the Moon", "escape".
    action
        The action of orbits: "escape through exit 1", "collide with the Moon", "escape beyond the escape radius".
    occurs
        Whether orbits can have this outcome; False for a channel that belongs to an exit of a lower number.
    number
        Number, from 1, among the outcomes of the kind. It determines the colour.
    """

    kind: type[Kind]
    label: str
    action: str
    occurs: bool = True
    number: int = 1

    @property
    def present(self) -> str:
        """The action of an orbit in the present tense: "escapes through exit 1"."""
        return f"{self.kind.verbs[0]} {self._manner}"

    @property
    def past(self) -> str:
        """The action of an orbit in the past tense, as the beginning of a sentence: "Escaped through exit 1"."""
        return f"{self.kind.verbs[1].capitalize()} {self._manner}"

    @property
    def _manner(self) -> str:
        """The action without its verb: "through exit 1"."""
        return self.action.partition(" ")[2]

    @property
    def event(self) -> str:
        """The event that ends an orbit: "escape" or "collision"."""
        return self.kind.event

    @property
    def origin(self) -> str:
        """The beginning of an orbit that ends in this way backward in time: "entered through exit 1"."""
        return self.kind.origin.format(label=self.label, present=self.present)

    @property
    def sentence(self) -> str:
        """The action of an orbit as a sentence: "Escaped through exit 1."."""
        return f"{self.past}."


def outcomes_of(channels: int, ends: Iterable[End]) -> tuple[Outcome, ...]:
    """Return the outcomes of a system in the order of fates. The first outcome has the fate 1."""
    # Each kind is counted from 1. The ends are sorted by kind.
    groups = [list(group) for _, group in groupby(ends, type)]
    return (
        *(Exit.outcome(channel) for channel in range(1, channels + 1)),
        *(end.outcome(number, end.name) for group in groups for number, end in enumerate(group, 1)),
    )


def write_outcomes(outcomes: Sequence[Outcome]) -> str:
    """Write outcomes as an attribute of files."""
    return json.dumps([[each.kind.key, each.label, each.action, each.occurs] for each in outcomes])


def read_outcomes(text: str) -> tuple[Outcome, ...]:
    """Read outcomes from an attribute of a file, see `write_outcomes`."""
    rows = json.loads(text)
    keys = [key for key, *_ in rows]
    # The number of an outcome among the outcomes of its kind.
    numbers = [keys[:index].count(key) + 1 for index, key in enumerate(keys)]
    return tuple(replace(Outcome(KINDS[key], *rest), number=number) for (key, *rest), number in zip(rows, numbers, strict=True))
