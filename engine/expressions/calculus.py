"""Derivatives of expressions, and expressions with other coordinates."""

from __future__ import annotations

from functools import lru_cache

from engine.expressions.nodes import (
    Coordinate,
    Expression,
    Function,
    Product,
    Sum,
    apply_function,
    linear_combination,
    multiply,
    number,
    power,
)

# Cached derivatives, 1 kB each.
_DERIVATIVES = 4096


@lru_cache(maxsize=_DERIVATIVES)
def derivative(expression: Expression, axis: int) -> Expression:
    """∂/∂x (axis 0) or ∂/∂y (axis 1)."""
    match expression:
        case Coordinate(own):
            return number(1.0 if own == axis else 0.0)
        case Sum(_, terms):
            return linear_combination((c, derivative(part, axis)) for part, c in terms)
        case Product(factors):
            return linear_combination((n, _factor_derived(factors, k, axis)) for k, (_, n) in enumerate(factors))
        case Function(name, argument):
            return multiply(_outer_derivative(name, argument), derivative(argument, axis))
    raise TypeError(expression)


def _factor_derived(factors: tuple[tuple[Expression, float], ...], k: int, axis: int) -> Expression:
    """A product with factor k, b^n, replaced by b^(n − 1) b'."""
    base, n = factors[k]
    others = (power(other, m) for place, (other, m) in enumerate(factors) if place != k)
    return multiply(power(base, n - 1.0), derivative(base, axis), *others)


def _outer_derivative(name: str, argument: Expression) -> Expression:
    match name:
        case "exp":
            return apply_function("exp", argument)
        case "log":
            return power(argument, -1.0)
        case "sin":
            return apply_function("cos", argument)
    return linear_combination([(-1.0, apply_function("sin", argument))])


def substitute(expression: Expression, x: Expression, y: Expression) -> Expression:
    """The expression with x and y replaced by two other expressions."""
    match expression:
        case Coordinate(axis):
            return (x, y)[axis]
        case Sum(constant, terms):
            return linear_combination([(constant, number(1.0)), *((c, substitute(part, x, y)) for part, c in terms)])
        case Product(factors):
            return multiply(*(power(substitute(base, x, y), n) for base, n in factors))
        case Function(name, argument):
            return apply_function(name, substitute(argument, x, y))
    raise TypeError(expression)
