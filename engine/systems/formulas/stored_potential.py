"""Potentials from the attributes of files, which `engine.systems.provenance` writes."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

from engine.systems.formulas.formula_parser import parse_formula
from engine.systems.outcomes import end_kinds
from engine.systems.potential import Potential

_TERM = re.compile(r"(\S+) x\^(\d+) y\^(\d+)")


def read_potential(attributes: Mapping[Any, Any]) -> Potential:
    """Return the potential of attributes; missing ones stand for no rotation, no ends, no shift, and a mass of 1."""
    text, name = str(attributes["terms"]), str(attributes["potential"])
    terms = [_TERM.fullmatch(term) for term in text.split("; ")]
    if all(terms):
        potential = Potential(name, tuple((int(term[2]), int(term[3]), float(term[1])) for term in terms if term is not None))
    else:
        potential = parse_formula(text, name)
    kinds = [kind for kind in end_kinds() if kind.attribute in attributes]
    ends = [end for kind in kinds for end in kind.read(attributes[kind.attribute])]
    # The terms are those of the effective potential.
    x, y = json.loads(attributes.get("origin", "[0.0, 0.0]"))
    names = json.loads(attributes.get("exit_names", "[]"))
    rotation, mass = float(attributes.get("rotation", 0.0)), float(attributes.get("mass", 1.0))
    return Potential(name, potential.form, rotation, origin=(x, y), ends=ends, exit_names=names, mass=mass)
