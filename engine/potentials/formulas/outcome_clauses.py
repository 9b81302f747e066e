"""Clauses after a formula that say at what orbits end: "−1/r − x² + ½y²; centre the planet (0, 0) 0.001; escape 10".

A clause is ``centre``, a name, which can be left out, the place of a body in brackets and its radius of collision, or ``escape``
and a radius. Places and radii are formulas without x and y, with the letters of the potential.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from engine.potentials.formulas.formula_tokens import FormulaError
from engine.potentials.outcomes import Centre

SEPARATOR = ";"
_CENTRE = re.compile(r"\s*centre\s*(?P<name>[\w ]{0,40}?)\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)(?P<radius>[^();]*)$")
_ESCAPE = re.compile(r"\s*escape(?P<radius>[^;]*)$")
MOST_CENTRES = 8
"""Largest number of centres of a formula."""


class Part(NamedTuple):
    """A part of a text, and its position there."""

    text: str
    position: int


class Clauses(NamedTuple):
    """The formula of V, and the clauses: (name, x, y, radius) of each centre, and the escape radius if there is one."""

    formula: str
    centres: tuple[tuple[str, Part, Part, Part], ...]
    escape: Part | None

    @property
    def numbers(self) -> tuple[Part, ...]:
        """All places and radii."""
        return (*(part for _, *parts in self.centres for part in parts), *([] if self.escape is None else [self.escape]))

    def evaluate(self, value_of: Callable[[Part], float]) -> tuple[tuple[Centre, ...], float | None]:
        """The centres and the escape radius; FormulaError for a number that is out of range."""
        centres = []
        for name, *parts in self.centres:
            x, y, radius = map(value_of, parts)
            try:
                centres.append(Centre(x, y, radius, name))
            except ValueError as error:
                raise FormulaError(parts[-1].position, str(error)) from None
        return tuple(centres), None if self.escape is None else value_of(self.escape)


def split_clauses(text: str) -> Clauses:
    """The formula and the clauses of a text; FormulaError for a clause that is not understood."""
    formula, *rest = text.split(SEPARATOR)
    position = len(formula) + 1
    centres: list[tuple[str, Part, Part, Part]] = []
    escapes: list[Part] = []
    for clause in rest:
        centre, escape = _CENTRE.match(clause), _ESCAPE.match(clause)
        if centre:
            x, y, radius = (Part(centre[key], position + centre.start(key)) for key in ("x", "y", "radius"))
            centres.append((centre["name"], x, y, radius))
        elif escape and not escapes:
            escapes.append(Part(escape["radius"], position + escape.start("radius")))
        else:
            raise FormulaError(
                position, f"{clause.strip()!r} is not understood; allowed are centre (x, y) radius, and one escape radius"
            )
        position += len(clause) + 1
    if len(centres) > MOST_CENTRES:
        raise FormulaError(len(formula), f"the formula has {len(centres)} centres; at most {MOST_CENTRES} are allowed")
    return Clauses(formula, tuple(centres), escapes[0] if escapes else None)


def write_clauses(centres: Sequence[Centre], escape_radius: float | None) -> str:
    """The clauses as text, to be read back exactly."""
    named = (f"{each.name} " if each.name else "" for each in centres)
    clauses = [f"centre {name}({each.x!r}, {each.y!r}) {each.radius!r}" for name, each in zip(named, centres, strict=True)]
    if escape_radius is not None:
        clauses.append(f"escape {escape_radius!r}")
    return "".join(f"{SEPARATOR} {clause}" for clause in clauses)
