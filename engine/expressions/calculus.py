"""Derivatives of expressions, and substitution of their coordinates."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache

from engine.expressions.nodes import (
    Coordinate,
    Expression,
    Function,
    Product,
    Sum,
    X,
    Y,
    apply_function,
    as_number,
    as_terms,
    linear_combination,
    multiply,
    number,
    power,
)

# Largest relative difference of coefficients that count as equal.
_ROUNDING = 1e-14
# Number of cached derivatives, of about 1 kB each.
_DERIVATIVES = 4096


@lru_cache(maxsize=_DERIVATIVES)
def derivative(expression: Expression, axis: int) -> Expression:
    """Return ∂/∂x (axis 0) or ∂/∂y (axis 1)."""
    match expression:
        case Coordinate(own_axis):
            return number(1.0 if own_axis == axis else 0.0)
        case Sum(_, terms):
            return linear_combination((c, derivative(part, axis)) for part, c in terms)
        case Product(factors):
            return linear_combination((n, _differentiate_factor(factors, k, axis)) for k, (_, n) in enumerate(factors))
        case Function("log", argument) if (special_derivative := _inverse_hyperbolic_sine_derivative(argument, axis)) is not None:
            return special_derivative
        case Function(name, argument):
            return multiply(_outer_derivative(name, argument), derivative(argument, axis))
    raise TypeError(expression)


def slopes(expression: Expression) -> tuple[Expression, Expression]:
    """Return the first derivatives along x and y."""
    return derivative(expression, 0), derivative(expression, 1)


def curvatures(expression: Expression) -> tuple[Expression, Expression, Expression]:
    """Return the second derivatives ∂²/∂x², ∂²/∂x∂y and ∂²/∂y²."""
    along_x, along_y = slopes(expression)
    return derivative(along_x, 0), derivative(along_x, 1), derivative(along_y, 1)


def _differentiate_factor(factors: tuple[tuple[Expression, float], ...], k: int, axis: int) -> Expression:
    """Return a product with factor k, b^n, replaced by b^(n − 1) b'."""
    base, n = factors[k]
    other_factors = (power(other, m) for index, (other, m) in enumerate(factors) if index != k)
    return multiply(power(base, n - 1.0), derivative(base, axis), *other_factors)


def _outer_derivative(name: str, argument: Expression) -> Expression:
    """Return f'(argument) of the function f called `name`."""
    match name:
        case "exp":
            return apply_function("exp", argument)
        case "log":
            return power(argument, -1.0)
        case "sin":
            return apply_function("cos", argument)
    return linear_combination([(-1.0, apply_function("sin", argument))])


def _inverse_hyperbolic_sine_derivative(argument: Expression, axis: int) -> Expression | None:
    """Return (p'/c) b^(−½), the derivative of log(p + c b^½) if c² b' = 2 p' p with a number p' ≠ 0; None for other arguments.

    Where p < 0, the terms of u = p + c b^½ cancel, and the usual derivative u'/u would lose digits.
    """
    terms = argument.terms if isinstance(argument, Sum) else ()
    roots = [(part, c) for part, c in terms if isinstance(part, Product) and [n for _, n in part.factors] == [0.5]]
    if len(roots) != 1:
        return None
    root, c = roots[0]
    base, _ = root.factors[0]
    p = linear_combination([(1.0, argument), (-c, root)])
    slope = as_number(derivative(p, axis))
    base_slope_terms, p_terms = as_terms(derivative(base, axis)), as_terms(p)
    if not slope or base_slope_terms is None or p_terms is None:
        return None
    # The coefficients of c² b' and of 2 p' p.
    pairs = (
        (c * c * base_slope_terms.get(powers, 0.0), 2.0 * slope * p_terms.get(powers, 0.0))
        for powers in base_slope_terms | p_terms
    )
    if not all(math.isclose(one, other, rel_tol=_ROUNDING) for one, other in pairs):
        return None
    return linear_combination([(slope / c, power(base, -0.5))])


def substitute(expression: Expression, x: Expression, y: Expression) -> Expression:
    """Replace x and y in an expression by two other expressions."""
    return replace_parts(expression, {X: x, Y: y})


def replace_parts(expression: Expression, parts: Mapping[Expression, Expression]) -> Expression:
    """Replace each part of an expression that is a key of `parts` by its value there."""
    if expression in parts:
        return parts[expression]
    match expression:
        case Coordinate():
            return expression
        case Sum(constant, terms):
            return linear_combination([(constant, number(1.0)), *((c, replace_parts(part, parts)) for part, c in terms)])
        case Product(factors):
            return multiply(*(power(replace_parts(base, parts), n) for base, n in factors))
        case Function(name, argument):
            return apply_function(name, replace_parts(argument, parts))
    raise TypeError(expression)
