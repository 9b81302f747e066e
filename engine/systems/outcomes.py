"""What orbits end at: exits over saddles, and besides these centres with a radius of collision, and an escape circle.

A kind of outcome is a class, an entry of `KINDS`: its words, and for an end besides the exits its place, its row for the kernels,
its clause after a formula and its attribute in files. The colours of each kind are in `plots.pictures.palette`.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import groupby
from typing import Any, ClassVar, Self

import numpy as np

from engine.foundations.validation import check_type, checked_number, replace_unchecked
from engine.foundations.wording import format_number
from engine.integrator.kernels import events

SMALLEST_RADIUS, LARGEST_RADIUS = 1e-6, 1e6
"""Legal radii of centres and of escape, dimensionless: steps near the singularity of a smaller disc would not change t."""


class Kind:
    """A way in which orbits end.

    Attributes
    ----------
    key
        Its name in files and in palettes.
    word
        What one that orbits end at is called: "exit", "centre".
    label, action
        Those of its outcomes, with the name of one for {}; the verb of the action ends with e.
    event
        What ends an orbit in a word: "escape", "collision".
    origin
        How an orbit began that ends so backward in time, with {label} and {present} of the outcome.
    """

    key: ClassVar[str]
    word: ClassVar[str]
    label: ClassVar[str]
    action: ClassVar[str]
    event: ClassVar[str] = "escape"
    origin: ClassVar[str] = "backward in time it {present}"

    @classmethod
    def outcome(cls, number: int, name: str = "", *, occurs: bool = True) -> Outcome:
        """The outcome of orbits that end at the one of this number, which has a name or is called "exit 1"."""
        name = name or f"{cls.word} {number}"
        return Outcome(cls, cls.label.format(name), cls.action.format(name), occurs, number)


class Exit(Kind):
    """Through an exit over a saddle, the curve or line across a channel; see `engine.exits`."""

    key = word = "exit"
    label, action = "{}", "escape through {}"
    origin = "entered through {label}"


@dataclass(frozen=True)
class End(Kind):
    """An end besides the exits over saddles: the edge of a disc, and of a subclass any other circle.

    Attributes
    ----------
    side
        On which side of the circle orbits have ended: −1 within, 1 beyond.
    clause, syntax, spellings
        Its clause after a formula: the pattern of its parameters, how errors describe it, and other spellings of its word.
    most
        How many a formula can have.
    attribute
        Its attribute in files.
    x, y, radius, name
        As of `Centre`.
    """

    side: ClassVar[int] = -1
    clause: ClassVar[str] = r"\s*(?P<name>[\w ]{0,40}?)\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)(?P<radius>[^();]*)$"
    syntax: ClassVar[str] = "{} (x, y) radius"
    spellings: ClassVar[tuple[str, ...]] = ()
    most: ClassVar[int] = 8
    attribute: ClassVar[str]

    x: float
    y: float
    radius: float
    name: str = ""

    def __post_init__(self) -> None:
        check_type("name", self.name, str)
        for axis in ("x", "y"):
            object.__setattr__(self, axis, checked_number(f"{self.word} {axis}", getattr(self, axis)))
        object.__setattr__(self, "radius", self._checked_radius(f"{self.word} radius"))

    def _checked_radius(self, name: str) -> float:
        """The radius as a float, if it is legal."""
        radius = checked_number(name, self.radius, f"a number from {SMALLEST_RADIUS:g} to {LARGEST_RADIUS:g}")
        if not SMALLEST_RADIUS <= radius <= LARGEST_RADIUS:
            raise ValueError(f"{name}={radius!r}: must be from {SMALLEST_RADIUS:g} to {LARGEST_RADIUS:g}")
        return radius

    @classmethod
    def match(cls, clause: str) -> re.Match[str] | None:
        """The parameters in a clause, if it is one of the kind."""
        return re.match(rf"\s*(?:{'|'.join((cls.word, *cls.spellings))}){cls.clause}", clause)

    @property
    def text(self) -> str:
        """Its clause, to be read back exactly."""
        return f"{self.word} {self.name + ' ' if self.name else ''}({self.x!r}, {self.y!r}) {self.radius!r}"

    @property
    def geometry(self) -> str:
        """The circle in words."""
        return f"disc of radius {format_number(self.radius)} around ({format_number(self.x)}, {format_number(self.y)})"

    @classmethod
    def write(cls, ends: Sequence[End]) -> Any:
        """All ends of the kind as their attribute in files."""
        return json.dumps([asdict(end) for end in ends])

    @classmethod
    def read(cls, attribute: Any) -> list[Self]:
        """The ends of an attribute."""
        return [cls(**values) for values in json.loads(attribute)]

    @property
    def row(self) -> np.ndarray:
        """(columns,) the circle as an exit for the kernels, see `engine.integrator.kernels.events`."""
        row = np.zeros(events.CURVE_COLUMNS)
        shape = events.DISC if self.side < 0 else events.CIRCLE
        row[[events.ORIGIN_X, events.ORIGIN_Y, events.HALF_WIDTH, events.SHAPE]] = self.x, self.y, self.radius, shape
        return row

    def scaled(self, factor: float) -> Self:
        """The same end in other units of length; a power of 2 as factor is exact."""
        # Legal radii are in the units of the system.
        return replace_unchecked(self, x=self.x * factor, y=self.y * factor, radius=self.radius * factor)

    def moved(self, x: float, y: float) -> Self:
        """The same end with the origin of the axes moved to (x, y)."""
        return replace(self, x=self.x - x, y=self.y - y)

    def contains(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Whether points of any shape lie where orbits have ended."""
        distance = np.hypot(x - self.x, y - self.y)
        ended: np.ndarray = distance < self.radius if self.side < 0 else distance > self.radius
        return ended


class Centre(End):
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

    key, word, event, attribute = "collision", "centre", "collision", "centres"
    label, action = "collision with {}", "collide with {}"
    spellings = ("center",)


@dataclass(frozen=True)
class EscapeCircle(End):
    """The circle around the origin beyond which orbits have escaped; with it saddles are no exits."""

    key, word, attribute = "escape", "escape", "escape_radius"
    label, action = "escape", "escape beyond the escape radius"
    side, clause, syntax, most = 1, "(?P<radius>[^;]*)$", "one {} radius", 1

    x: float = field(default=0.0, init=False, repr=False)
    y: float = field(default=0.0, init=False, repr=False)
    name: str = field(default="", init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", self._checked_radius("escape_radius"))

    @property
    def text(self) -> str:
        """See `End.text`."""
        return f"{self.word} {self.radius!r}"

    @property
    def geometry(self) -> str:
        """See `End.geometry`."""
        return f"escape radius {format_number(self.radius)}"

    def moved(self, x: float, y: float) -> Self:
        """The same circle: it is around any origin."""
        return self

    @classmethod
    def write(cls, ends: Sequence[End]) -> float:
        """The radius; 0 for none."""
        return ends[0].radius if ends else 0.0

    @classmethod
    def read(cls, attribute: Any) -> list[Self]:
        """See `write`."""
        return [cls(float(attribute))] if float(attribute) else []


KINDS: dict[str, type[Kind]] = {kind.key: kind for kind in (Exit, Centre, EscapeCircle)}
"""The kinds by their keys, in the order of fates."""


def end_kinds() -> list[type[End]]:
    """The kinds of ends besides the exits, in the order of fates."""
    return [kind for kind in KINDS.values() if issubclass(kind, End)]


@dataclass(frozen=True)
class Outcome:
    """How orbits of a fate of 1 or more end.

    Attributes
    ----------
    kind
        Through an exit over a saddle, by a collision with a centre, or beyond the escape radius: a class with its words.
    label
        In legends and tables: "exit 1", "collision with the Moon", "escape".
    action
        What orbits do: "escape through exit 1", "collide with the Moon", "escape beyond the escape radius".
    occurs
        Whether orbits can have it: not a channel that is part of an exit of a lower number.
    number
        Its number among those of its kind, from 1 on, which decides its colour.
    """

    kind: type[Kind]
    label: str
    action: str
    occurs: bool = True
    number: int = 1

    @property
    def present(self) -> str:
        """What an orbit does: "escapes through exit 1"."""
        verb, rest = self.action.split(" ", 1)
        return f"{verb}s {rest}"

    @property
    def past(self) -> str:
        """What an orbit has done, as the beginning of a sentence: "Escaped through exit 1"."""
        verb, rest = self.action.split(" ", 1)
        return f"{verb.capitalize()}d {rest}"

    @property
    def event(self) -> str:
        """What ends an orbit: "escape" or "collision"."""
        return self.kind.event

    @property
    def origin(self) -> str:
        """How an orbit began that ends so backward in time: "entered through exit 1"."""
        return self.kind.origin.format(label=self.label, present=self.present)

    @property
    def sentence(self) -> str:
        """What an orbit has done, as a sentence: "Escaped through exit 1."."""
        return f"{self.past}."


def outcomes_of(channels: int, ends: Iterable[End]) -> tuple[Outcome, ...]:
    """The outcomes of a system with ends in the order of fates; the fate of an orbit is 1 for the first one."""
    groups = [list(group) for _, group in groupby(ends, type)]
    return (
        *(Exit.outcome(channel) for channel in range(1, channels + 1)),
        *(end.outcome(number, end.name) for group in groups for number, end in enumerate(group, 1)),
    )


def write_outcomes(outcomes: Sequence[Outcome]) -> str:
    """Outcomes as an attribute of files."""
    return json.dumps([[each.kind.key, each.label, each.action, each.occurs] for each in outcomes])


def read_outcomes(text: str) -> tuple[Outcome, ...]:
    """The outcomes of an attribute."""
    rows = json.loads(text)
    keys = [key for key, *_ in rows]
    numbers = [keys[:place].count(key) + 1 for place, key in enumerate(keys)]
    return tuple(replace(Outcome(KINDS[key], *rest), number=number) for (key, *rest), number in zip(rows, numbers, strict=True))
