"""Arithmetic of the parser: polynomials with exact coefficients as long as possible, expressions where they end.

A part of a formula without functions, roots or divisions by x and y is expanded exactly. As a part of an expression each of its
coefficients is rounded once.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from engine.expressions.nodes import (
    FUNCTIONS,
    Expression,
    apply_function,
    as_number,
    as_terms,
    from_terms,
    linear_combination,
    multiply,
    power,
)
from engine.polynomials import ExactTerms, exact_negative, exact_power, exact_product, exact_sum

FormulaValue = ExactTerms | Expression

LARGEST_EXPONENT = 12
"""Largest magnitude of an exponent."""


def add(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """The sum."""
    if isinstance(one, Expression) or isinstance(other, Expression):
        return _simplified(linear_combination([(1.0, _rounded(one)), (1.0, _rounded(other))]))
    return exact_sum(one, other)


def negative(value: FormulaValue) -> FormulaValue:
    """−value."""
    return linear_combination([(-1.0, value)]) if isinstance(value, Expression) else exact_negative(value)


def product(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """The product."""
    if isinstance(one, Expression) or isinstance(other, Expression):
        return _simplified(multiply(_rounded(one), _rounded(other)))
    return exact_product(one, other)


def quotient(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """one / other; ZeroDivisionError if the divisor is 0."""
    divisor = constant_of(other)
    if divisor is not None and not isinstance(other, Expression):
        return product(one, {(0, 0): 1 / divisor})
    return product(one, power(_rounded(other), -1.0))


def raised(base: FormulaValue, exponent: Fraction) -> FormulaValue:
    """A power; ArithmeticError or ValueError for one of a number that is not a finite real number."""
    if exponent.denominator == 1 and exponent >= 0 and not isinstance(base, Expression):
        return exact_power(base, int(exponent))
    return _simplified(power(_rounded(base), float(exponent)))


def applied(name: str, argument: FormulaValue) -> FormulaValue:
    """A function of `FUNCTIONS`; ArithmeticError or ValueError for a number outside its domain."""
    return _simplified(apply_function(name, _rounded(argument)))


def constant_of(value: FormulaValue) -> Fraction | None:
    """The value of a formula without x and y; None for others."""
    if isinstance(value, Expression):
        return None
    return value.get((0, 0), Fraction(0)) if set(value) <= {(0, 0)} else None


def _rounded(value: FormulaValue) -> Expression:
    if isinstance(value, Expression):
        return value
    return from_terms({powers: float(c) for powers, c in value.items()})


def _simplified(value: Expression) -> FormulaValue:
    """A number or a polynomial, whose coefficients are exact from here on; others unchanged."""
    number = as_number(value)
    if number is not None:
        return {(0, 0): Fraction(number)} if number else {}
    terms = as_terms(value)
    return value if terms is None else {powers: Fraction(c) for powers, c in terms.items()}


NAMES: dict[str, Callable[[FormulaValue], FormulaValue]] = {
    **{name: lambda argument, name=name: applied(name, argument) for name in FUNCTIONS},  # type: ignore[misc]
    "ln": lambda argument: applied("log", argument),
    "sqrt": lambda argument: raised(argument, Fraction(1, 2)),
}
"""The functions of formulas by name."""
