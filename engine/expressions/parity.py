"""Mirror symmetries of expressions. They are found node by node, so mirror images of orbits are exact in floating point."""

from __future__ import annotations

from functools import lru_cache

from engine.expressions.calculus import substitute
from engine.expressions.nodes import (
    Coordinate,
    Expression,
    Function,
    Product,
    Sum,
    X,
    Y,
    apply_function,
    linear_combination,
    multiply,
    number,
    power,
)

EVEN = 1
"""Parity of a function with f(−x) = f(x)."""

ODD = -1
"""Parity of a function with f(−x) = −f(x)."""

NEITHER = 0
"""Parity of any other function."""

# Number of cached parities.
_PARITIES = 1024


@lru_cache(maxsize=_PARITIES)
def parity(expression: Expression, axis: int) -> int:
    """Return the parity under a change of sign of x (axis 0) or y (axis 1): `EVEN`, `ODD` or `NEITHER`.

    A sum whose terms are exchanged by the reflection, such as the terms of two equal bodies, is `NEITHER`: in floating point its
    values at mirror images can differ in the last bit.
    """
    match expression:
        case Coordinate(own_axis):
            return ODD if own_axis == axis else EVEN
        case Sum(constant, terms):
            signs = {parity(part, axis) for part, _ in terms} | ({EVEN} if constant or not terms else set())
            return signs.pop() if len(signs) == 1 else NEITHER
        case Product(factors):
            sign = EVEN
            for base, exponent in factors:
                sign *= _power_parity(parity(base, axis), exponent)
            return sign
        case Function(name, argument):
            inner = parity(argument, axis)
            if inner != ODD:
                return inner
            return {"sin": ODD, "cos": EVEN}.get(name, NEITHER)
    raise TypeError(expression)


def _power_parity(sign: int, exponent: float) -> int:
    """Return the parity of a power of a base with the parity `sign`."""
    if sign != ODD:
        return sign
    if exponent != int(exponent):
        return NEITHER
    return ODD if int(exponent) % 2 else EVEN


def is_even(expression: Expression, axis: int) -> bool:
    """Return whether a change of sign of x (axis 0) or y (axis 1) leaves an expression unchanged.

    In contrast to `parity`, the change may exchange parts, such as the terms of two equal bodies.
    """
    reflected = substitute(expression, *((_negative(X), Y), (X, _negative(Y)))[axis])
    return _with_positive_parts(reflected) == _with_positive_parts(expression)


def _negative(expression: Expression) -> Expression:
    return linear_combination([(-1.0, expression)])


def _with_positive_parts(expression: Expression) -> Expression:
    """Return an equal expression in which sums in integer powers, in sines and in cosines begin with a positive coefficient."""
    match expression:
        case Sum(constant, terms):
            return linear_combination([(constant, number(1.0)), *((c, _with_positive_parts(part)) for part, c in terms)])
        case Product(factors):
            return multiply(*(_positive_power(_with_positive_parts(base), exponent) for base, exponent in factors))
        case Function(name, argument):
            inner = _with_positive_parts(argument)
            if name not in ("sin", "cos") or not _begins_with_minus(inner):
                return apply_function(name, inner)
            return linear_combination([(-1.0 if name == "sin" else 1.0, apply_function(name, _negative(inner)))])
    return expression


def _positive_power(base: Expression, exponent: float) -> Expression:
    """Return a power. For an integer exponent, a base that begins with a negative coefficient is replaced by its negative."""
    if exponent != int(exponent) or not _begins_with_minus(base):
        return power(base, exponent)
    return linear_combination([(-1.0 if int(exponent) % 2 else 1.0, power(_negative(base), exponent))])


def _begins_with_minus(expression: Expression) -> bool:
    return isinstance(expression, Sum) and bool(expression.terms) and expression.terms[0][1] < 0.0
