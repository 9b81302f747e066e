"""Clauses after a formula: "−1/r − x² + ½y²; centre the planet (0, 0) 0.001; escape 10", "x + x² + y² + x³; well (−0.2, 0)".

A clause is ``centre``, a name, which can be left out, the place of a body in brackets and its radius of collision; ``escape``
and a radius; or ``well`` and a place: the axes are moved to the minimum nearest to it. Places and radii are formulas without x
and y, with the letters of the potential.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import NamedTuple

from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.outcomes import Centre

SEPARATOR = ";"
_CENTRE = re.compile(r"\s*cent(?:re|er)\s*(?P<name>[\w ]{0,40}?)\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)(?P<radius>[^();]*)$")
_WELL = re.compile(r"\s*well\s*\((?P<x>[^,;]*),(?P<y>[^,;]*)\)\s*$")
_ESCAPE = re.compile(r"\s*escape(?P<radius>[^;]*)$")
MOST_CENTRES = 8
"""Largest number of centres of a formula."""


class Part(NamedTuple):
    """A part of a text, and its position there."""

    text: str
    position: int


class Clauses(NamedTuple):
    """The formula of V, and the clauses: (name, x, y, radius) of each centre, and the escape radius and a place if there are."""

    formula: str
    centres: tuple[tuple[str, Part, Part, Part], ...]
    escape: Part | None
    well: tuple[Part, Part] | None

    @property
    def numbers(self) -> tuple[Part, ...]:
        """All places and radii."""
        of_centres = (part for _, *parts in self.centres for part in parts)
        return (*of_centres, *([] if self.escape is None else [self.escape]), *(self.well or ()))

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
    wells: list[tuple[Part, Part]] = []
    for clause in rest:
        centre, escape, well = _CENTRE.match(clause), _ESCAPE.match(clause), _WELL.match(clause)
        if centre:
            x, y, radius = (Part(centre[key], position + centre.start(key)) for key in ("x", "y", "radius"))
            centres.append((centre["name"], x, y, radius))
        elif escape and not escapes:
            escapes.append(Part(escape["radius"], position + escape.start("radius")))
        elif well and not wells:
            wells.append((Part(well["x"], position + well.start("x")), Part(well["y"], position + well.start("y"))))
        else:
            allowed = "centre (x, y) radius, one escape radius, and one well (x, y)"
            raise FormulaError(position, f"{clause.strip()!r} is not understood; allowed are {allowed}")
        position += len(clause) + 1
    if len(centres) > MOST_CENTRES:
        raise FormulaError(len(formula), f"the formula has {len(centres)} centres; at most {MOST_CENTRES} are allowed")
    return Clauses(formula, tuple(centres), escapes[0] if escapes else None, wells[0] if wells else None)


def write_clauses(centres: Sequence[Centre], escape_radius: float | None) -> str:
    """The clauses as text, to be read back exactly."""
    named = (f"{each.name} " if each.name else "" for each in centres)
    clauses = [f"centre {name}({each.x!r}, {each.y!r}) {each.radius!r}" for name, each in zip(named, centres, strict=True)]
    if escape_radius is not None:
        clauses.append(f"escape {escape_radius!r}")
    return "".join(f"{SEPARATOR} {clause}" for clause in clauses)
