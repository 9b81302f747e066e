"""Parser of potentials in common notation: "½(x² + y²) − x²y²", "0.5*(x^2+y^2) - x^2*y^2", "−1/√(x² + y² + c²) + x² exp(−y²)".

The text is expanded with exact fractions as far as it is a polynomial; it is never evaluated as code. The grammar is that of
`engine.systems.formulas.formula_grammar`. Clauses can follow, see `engine.systems.formulas.outcome_clauses`.
"""

from __future__ import annotations

import json
import re
import reprlib
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from types import MappingProxyType
from typing import Any

from engine.expressions.exact_polynomials import exact_terms
from engine.expressions.nodes import Expression
from engine.expressions.polynomials import Powers
from engine.expressions.text import monomial
from engine.foundations.validation import checked_between
from engine.systems.escape_arcs import end_kinds
from engine.systems.forms.expression_form import Form, as_form
from engine.systems.forms.polynomial_form import COEFFICIENT_RANGE, MOST_TERMS
from engine.systems.formulas.formula_grammar import Parser
from engine.systems.formulas.formula_tokens import FormulaError, tokenize
from engine.systems.formulas.formula_values import FormulaValue, constant_of
from engine.systems.formulas.formula_writer import by_degree, write_form
from engine.systems.formulas.outcome_clauses import Clauses, Part, split_clauses
from engine.systems.potential import Potential

LONGEST_TEXT = 500
"""Largest number of characters of a formula."""

LARGEST_VALUE = COEFFICIENT_RANGE[1]
"""Largest magnitude of the value of a letter; unlike a coefficient, it may be 0."""

MOST_LETTERS = 8
"""Largest number of different letters of a formula."""

# A term of a polynomial, such as "0.5 x^2 y^0".
_TERM = re.compile(r"(\S+) x\^(\d+) y\^(\d+)")


def make_potential(text: str, name: str = "", parameters: Mapping[str, float] = MappingProxyType({})) -> Potential:
    """Return the potential of a formula, as `engine.systems.system.parse_formula` does, but without its system."""
    if len(text) > LONGEST_TEXT:
        raise FormulaError(LONGEST_TEXT, f"the text has {len(text)} characters; at most {LONGEST_TEXT} characters are allowed")
    clauses = split_clauses(text)
    values = _exact_values(_letters_of(clauses), parameters)
    form = _make_form(Parser(clauses.formula, values).parse())
    evaluate_number = partial(_evaluate_number, values=values)
    ends = [end for clause in clauses.ends for end in clause.evaluate(evaluate_number)]
    potential = Potential(name or write_form(form), form, ends=ends, mass=clauses.find_mass(evaluate_number))
    if clauses.well is not None:
        place = tuple(map(evaluate_number, clauses.well))
        try:
            potential = potential.at_minimum(*place)
        except ValueError as error:
            raise FormulaError(max(text.find("well"), 0), str(error)) from None
    return replace(potential, exit_names=clauses.exits) if clauses.exits else potential


def _make_form(value: FormulaValue) -> Form:
    """Return the form of V; FormulaError if V exceeds a limit."""
    if isinstance(value, Expression):
        form = as_form(value)
        # All further steps need the derivatives, whose size is limited.
        if (problem := form.limits_refusal()) is not None:
            raise FormulaError(0, problem)
        return form
    expanded = exact_terms(value)
    _check_expanded(expanded)
    return as_form(tuple((i, j, float(expanded[i, j])) for i, j in sorted(expanded, key=by_degree)))


@lru_cache(maxsize=64)
def formula_letters(text: str) -> tuple[str, ...]:
    """Return the letters of a formula, then those of its clauses; FormulaError for an unknown character or too many letters."""
    return _letters_of(split_clauses(text))


def _letters_of(clauses: Clauses) -> tuple[str, ...]:
    letters: dict[str, int] = {}
    for part in (Part(clauses.formula, 0), *clauses.numbers):
        for token in tokenize(part.text):
            if token.kind == "letter":
                letters.setdefault(token.text, part.position + token.position)
    if len(letters) > MOST_LETTERS:
        problem = f"the formula has {len(letters)} letters for coefficients; at most {MOST_LETTERS} are allowed"
        raise FormulaError(list(letters.values())[MOST_LETTERS], problem)
    return tuple(letters)


def _evaluate_number(part: Part, values: Mapping[str, Fraction]) -> float:
    """Return the value of a place, a radius or a mass in a clause; FormulaError if the text is not a number."""
    try:
        number = constant_of(Parser(part.text, values).parse())
    except FormulaError as error:
        raise FormulaError(part.position + error.position, error.problem) from None
    if number is None:
        raise FormulaError(part.position, "a place, a radius or a mass must be a number, without x and y")
    return float(number)


def checked_letter_value(name: str, value: float) -> float:
    """Return the value of a letter as a float; ValueError if the value is not finite or too large."""
    return checked_between(name, value, -LARGEST_VALUE, LARGEST_VALUE)


def _exact_values(letters: tuple[str, ...], parameters: Mapping[str, float]) -> dict[str, Fraction]:
    """Return the values of letters as the decimals that Python prints; ValueError for an unknown letter or illegal value."""
    for name in parameters:
        if name not in letters:
            legal = f"its letters are {', '.join(letters)}" if letters else "it has no letters"
            raise ValueError(f"parameters: {reprlib.repr(name)} is not a letter of the formula; {legal}")
    return {name: Fraction(repr(checked_letter_value(name, value))) for name, value in parameters.items()}


def _check_expanded(expanded: Mapping[Powers, Fraction]) -> None:
    """Raise FormulaError unless the terms of a polynomial depend on x or y, and their number and coefficients are legal."""
    if not any(i + j for i, j in expanded):
        raise FormulaError(0, "the expanded formula has neither x nor y; a potential must depend on at least one of them")
    if len(expanded) > MOST_TERMS:
        raise FormulaError(0, f"the expanded formula has {len(expanded)} terms; at most {MOST_TERMS} are allowed")
    low, high = COEFFICIENT_RANGE
    for (i, j), c in expanded.items():
        if not low <= abs(c) <= high:
            problem = f"the coefficient of {monomial(i, j) or '1'} must be between {low:g} and {high:g} in magnitude"
            raise FormulaError(0, problem)


def read_potential(attributes: Mapping[Any, Any]) -> Potential:
    """Return the potential described by attributes of a file, those of `Potential.provenance`.

    Missing attributes stand for no rotation, no ends, no shift, and a mass of 1.
    """
    text = str(attributes["terms"])
    name = str(attributes["potential"])
    matches = [_TERM.fullmatch(term) for term in text.split("; ")]
    if all(matches):
        form = as_form((int(match[2]), int(match[3]), float(match[1])) for match in matches if match is not None)
    else:
        form = make_potential(text).form
    kinds = [kind for kind in end_kinds() if kind.attribute in attributes]
    ends = [end for kind in kinds for end in kind.read(attributes[kind.attribute])]
    x, y = json.loads(attributes.get("origin", "[0.0, 0.0]"))
    names = json.loads(attributes.get("exit_names", "[]"))
    rotation = float(attributes.get("rotation", 0.0))
    mass = float(attributes.get("mass", 1.0))
    # The terms are those of the effective potential, so the rotation is not applied again.
    return Potential(name, form, rotation, origin=(x, y), ends=ends, exit_names=names, mass=mass)
