"""Values of the letters of a formula in a link, ``letters=a:1.5,b:-2``: one parameter, as other names are letters, too."""

from __future__ import annotations

from typing import Any

from engine import System
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.formulas.formula_parser import checked_letter_value, formula_letters
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED

LETTERS = "letters"
"""Parameter with the values of the letters of a formula, such as a:1.5,b:-2."""


def read_letters(text: str) -> dict[str, float]:
    """Values of letters from "a:1.5,b:-2"."""
    pairs = [pair.split(":") for pair in text.split(",")]
    if any(name in WELL_PARAMETERS for name, *_ in pairs):
        raise ValueError
    return {name: checked_letter_value(name, float(value)) for name, value in pairs}


def letters_in_link(system: System) -> dict[str, str]:
    """The values of letters that are not 1, as a parameter of a link."""
    chosen = ",".join(f"{name}:{value!r}" for name, value in system.letter_parameters.items())
    return {LETTERS: chosen} if chosen else {}


def drop_unknown_letters(values: dict[str, Any]) -> list[str]:
    """Drop values of letters that the formula does not have, and return a message for them."""
    letters = _letters(values)
    given = values.get("parameters", {})
    unknown = [name for name in given if name not in WELL_PARAMETERS and name not in letters]
    if not unknown:
        return []
    values["parameters"] = {name: value for name, value in given.items() if name not in unknown}
    legal = f"letters of the formula: {', '.join(letters)}" if letters else "a formula with letters"
    return [f"Ignored the values of letters that the formula does not have: choose {legal}."]


def _letters(values: dict[str, Any]) -> tuple[str, ...]:
    """The letters of a known system or of a formula; none of one that is not understood."""
    case = values.get("case", TYPED)
    if case != TYPED:
        return CATALOGUE[case].adjustable
    try:
        return formula_letters(values.get("formula", ""))
    except ValueError:
        return ()
