"""Potentials from the attributes of files that `Potential.provenance` writes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from engine.systems.formulas.formula_parser import parse_formula
from engine.systems.outcomes import end_kinds
from engine.systems.potential import Potential

# A term of a polynomial, such as "0.5 x^2 y^0".
_TERM = re.compile(r"(\S+) x\^(\d+) y\^(\d+)")


def read_potential(attributes: Mapping[Any, Any]) -> Potential:
    """Return the potential of attributes. Missing attributes stand for no rotation, no ends, no shift, and a mass of 1."""
    text = str(attributes["terms"])
    name = str(attributes["potential"])
    matches = [_TERM.fullmatch(term) for term in text.split("; ")]
    if all(matches):
        terms = tuple((int(match[2]), int(match[3]), float(match[1])) for match in matches if match is not None)
        potential = Potential(name, terms)
    else:
        potential = parse_formula(text, name)
    kinds = [kind for kind in end_kinds() if kind.attribute in attributes]
    ends = [end for kind in kinds for end in kind.read(attributes[kind.attribute])]
    x, y = json.loads(attributes.get("origin", "[0.0, 0.0]"))
    names = json.loads(attributes.get("exit_names", "[]"))
    rotation = float(attributes.get("rotation", 0.0))
    mass = float(attributes.get("mass", 1.0))
    # The terms are those of the effective potential, so the rotation is not applied again.
    return Potential(name, potential.form, rotation, origin=(x, y), ends=ends, exit_names=names, mass=mass)
