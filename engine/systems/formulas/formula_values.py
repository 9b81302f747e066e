"""Arithmetic of the parser: polynomials with exact coefficients as far as possible, otherwise expressions.

A part of a formula without functions, roots, or x and y in divisors is expanded exactly. Its coefficients are rounded once, when
the part enters an expression.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial

from flint import fmpq_mpoly

from engine.expressions.exact_polynomials import (
    checked_size,
    exact_constant,
    exact_polynomial,
    exact_terms,
    limited_power,
    limited_product,
)
from engine.expressions.nodes import (
    FUNCTIONS,
    Expression,
    apply_function,
    as_number,
    as_terms,
    from_terms,
    linear_combination,
    multiply,
    number,
    power,
)

FormulaValue = fmpq_mpoly | Expression
"""A polynomial with exact coefficients, or an expression."""


def add(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """Return one + other."""
    if isinstance(one, Expression) or isinstance(other, Expression):
        return _simplify(linear_combination([(1.0, _as_expression(one)), (1.0, _as_expression(other))]))
    return checked_size(one + other)


def negate(value: FormulaValue) -> FormulaValue:
    """Return −value."""
    return linear_combination([(-1.0, value)]) if isinstance(value, Expression) else -value


def times(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """Return one · other."""
    if isinstance(one, Expression) or isinstance(other, Expression):
        return _simplify(multiply(_as_expression(one), _as_expression(other)))
    return limited_product(one, other)


def divide(one: FormulaValue, other: FormulaValue) -> FormulaValue:
    """Return one / other; ZeroDivisionError if the divisor is 0."""
    divisor = constant_of(other)
    if divisor is not None:
        return times(one, exact_constant(1 / divisor))
    return times(one, raise_to(other, Fraction(-1)))


def raise_to(base: FormulaValue, exponent: Fraction) -> FormulaValue:
    """Return a power; ArithmeticError or ValueError if the power is a number that is not finite and real."""
    if exponent.denominator == 1 and not isinstance(base, Expression):
        if exponent >= 0:
            return limited_power(base, int(exponent))
        # For a negative power of 0, `power` raises the error.
        if base:
            return _simplify(_power_of_factors(base, int(exponent)))
    return _simplify(power(_as_expression(base), float(exponent)))


def _power_of_factors(base: fmpq_mpoly, exponent: int) -> Expression:
    """Return a negative power of a polynomial other than 0.

    If a square-free factor is repeated, the power is a product of powers of the factors: 1/(x² + 2x + 1) is (x + 1)^−2.
    """
    constant, factors = base.factor_squarefree()
    if all(multiplicity == 1 for _, multiplicity in factors):
        return power(_as_expression(base), float(exponent))
    # The factors in the product are monic; their leading coefficients are collected in `constant`.
    factor_powers = []
    for factor, multiplicity in factors:
        leading = factor.leading_coefficient()
        constant *= leading**multiplicity
        factor_powers.append(power(_as_expression(factor * (1 / leading)), float(multiplicity * exponent)))
    coefficient = Fraction(int(constant.p), int(constant.q)) ** exponent
    return multiply(number(float(coefficient)), *factor_powers)


def apply_named(name: str, argument: FormulaValue) -> FormulaValue:
    """Apply a function of `FUNCTIONS`; ArithmeticError or ValueError for a number outside its domain."""
    return _simplify(apply_function(name, _as_expression(argument)))


def constant_of(value: FormulaValue) -> Fraction | None:
    """Return a value without x and y as a number; None for other values."""
    if isinstance(value, Expression) or not value.is_constant():
        return None
    return exact_terms(value).get((0, 0), Fraction(0))


def _as_expression(value: FormulaValue) -> Expression:
    """Return a value as an expression; the exact coefficients of a polynomial are rounded to doubles."""
    if isinstance(value, Expression):
        return value
    return from_terms({powers: float(c) for powers, c in exact_terms(value).items()})


def _simplify(value: Expression) -> FormulaValue:
    """Convert a number or a polynomial to exact coefficients; keep other expressions."""
    constant = as_number(value)
    if constant is not None:
        return exact_constant(Fraction(constant))
    terms = as_terms(value)
    return value if terms is None else exact_polynomial({powers: Fraction(c) for powers, c in terms.items()})


NAMED_FUNCTIONS: dict[str, Callable[[FormulaValue], FormulaValue]] = {
    **{name: partial(apply_named, name) for name in FUNCTIONS},
    "ln": partial(apply_named, "log"),
    "sqrt": lambda argument: raise_to(argument, Fraction(1, 2)),
}
"""The functions of formulas by name."""
