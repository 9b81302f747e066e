"""Clauses after a formula: "−1/r − x² + ½y²; centre the planet (0, 0) 0.001; escape 10", "x + x² + y² + x³; well (−0.2, 0)".

The clause of an end, see `engine.systems.outcomes`, is its word, an optional name, its place in brackets and its radius. The
clause ``well`` with a place moves the axes to the nearest minimum. The clause ``exits`` lists the names of the exits in channel
order: "exits L2, L1". The clause ``masses`` has the masses of px²/2m₁ + py²/2m₂, which must be equal: "masses (8, 8)". Places,
radii and masses are formulas without x and y. They can contain the letters of the potential.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from engine.systems.escape_arcs import end_kinds
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.motion import MASS_RANGE
from engine.systems.outcomes import End

SEPARATOR = ";"
"""The character between the formula and the clauses."""

# At most 12 names of at most 21 characters.
_EXITS = re.compile(r"\s*exits\s+(?P<names>\w[\w ]{0,20}(?:,\s*\w[\w ]{0,20}){0,11})$")
_WELL = re.compile(r"\s*well\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)\s*$")
# A value of a letter, which is no clause.
_VALUE = re.compile(r"\s*(?P<letter>\w+)\s*=")
_MASSES = re.compile(r"\s*masses\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)\s*$")


class Part(NamedTuple):
    """A part of the whole text, with the index of its first character."""

    text: str
    position: int


class EndClause(NamedTuple):
    """The clause of an end: its kind, the texts of x, y and radius by key, and its name, which may be empty."""

    kind: type[End]
    numbers: Mapping[str, Part]
    name: str

    def evaluate(self, value_of: Callable[[Part], float]) -> list[End]:
        """Return the ends; FormulaError for a number that is out of range."""
        named: dict[str, Any] = {"name": self.name} if self.name else {}
        parameters = named | {key: value_of(part) for key, part in self.numbers.items()}
        try:
            return list(self.kind.make(**parameters))
        except ValueError as error:
            raise FormulaError(self.numbers["radius"].position, str(error)) from None


class Clauses(NamedTuple):
    """The formula of V, the clauses of ends, the place of a well or None, both masses or None, and the names of exits."""

    formula: str
    ends: tuple[EndClause, ...]
    well: tuple[Part, Part] | None
    masses: tuple[Part, Part] | None
    exits: tuple[str, ...]

    @property
    def numbers(self) -> tuple[Part, ...]:
        """All places, radii and masses."""
        end_numbers = (part for end in self.ends for part in end.numbers.values())
        return (*end_numbers, *(self.well or ()), *(self.masses or ()))

    def find_mass(self, value_of: Callable[[Part], float]) -> float:
        """Return the mass of both directions, 1 without a clause; FormulaError if a mass is illegal, or the masses differ."""
        if self.masses is None:
            return 1.0
        x_mass, y_mass = map(value_of, self.masses)
        position, (low, high) = self.masses[0].position, MASS_RANGE
        if x_mass != y_mass:
            remedy = "for two masses write V(x/√m₁, y/√m₂), whose axes are √m₁ x and √m₂ y"
            raise FormulaError(position, f"masses ({x_mass:g}, {y_mass:g}): both must be equal; {remedy}")
        if not low <= x_mass <= high:
            raise FormulaError(position, f"masses ({x_mass:g}, {y_mass:g}): must be from {low:g} to {high:g}")
        return x_mass


def split_clauses(text: str) -> Clauses:
    """Split a text into the formula and the clauses; FormulaError for a clause that is not understood."""
    formula, *clauses = text.split(SEPARATOR)
    position = len(formula) + 1
    ends: list[EndClause] = []
    pairs: dict[re.Pattern[str], tuple[Part, Part]] = {}
    exits: list[str] = []
    for clause in clauses:
        pair = _WELL.match(clause) or _MASSES.match(clause)
        if end := _end_clause(clause, position):
            ends.append(end)
        elif pair and pair.re not in pairs:
            pairs[pair.re] = _part(pair, "x", position), _part(pair, "y", position)
        elif (exits_match := _EXITS.match(clause)) and not exits:
            exits = [name.strip() for name in exits_match["names"].split(",")]
        elif value := _VALUE.match(clause):
            raise FormulaError(
                position,
                f"the value of {value['letter']} is no part of the formula: delete it, and set the parameter {value['letter']}",
            )
        else:
            allowed = ", ".join(kind.syntax.format(kind.word) for kind in end_kinds())
            others = "one well (x, y), one masses (m, m), and once exits NAME, NAME"
            raise FormulaError(position, f"{clause.strip()!r} is not understood; allowed are {allowed}, {others}")
        position += len(clause) + 1
    for word, count in Counter(end.kind.word for end in ends).items():
        most = next(end.kind.most_clauses for end in ends if end.kind.word == word)
        if count > most:
            raise FormulaError(len(formula), f"the formula has {count} clauses of {word!r}; at most {most} can be given")
    return Clauses(formula, tuple(ends), pairs.get(_WELL), pairs.get(_MASSES), tuple(exits))


def _end_clause(clause: str, position: int) -> EndClause | None:
    """Return the clause of an end, or None for any other clause; FormulaError if a number is missing."""
    for kind in end_kinds():
        if match := kind.match(clause):
            texts = match.groupdict()
            numbers = [key for key, text in texts.items() if key != "name" and text is not None]
            if missing := next((key for key in numbers if not texts[key].strip()), ""):
                raise FormulaError(position + match.start(missing), f"the {missing} is missing in {clause.strip()!r}")
            return EndClause(kind, {key: _part(match, key, position) for key in numbers}, texts.get("name", ""))
    return None


def _part(match: re.Match[str], key: str, position: int) -> Part:
    """Return a named group of the match of a clause that begins at `position`."""
    return Part(match[key], position + match.start(key))


def write_clauses(ends: Iterable[End], exits: Sequence[str], mass: float) -> str:
    """Return the clauses as text, with all digits of numbers."""
    names = [f"exits {', '.join(exits)}"] if exits else []
    masses = [] if mass == 1.0 else [f"masses ({mass!r}, {mass!r})"]
    return "".join(f"{SEPARATOR} {clause}" for clause in (*(end.text for end in ends), *names, *masses) if clause)
