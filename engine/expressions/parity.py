"""Mirror symmetries of expressions. They are found node by node, so mirror images of orbits are exact in floating point."""

from __future__ import annotations

from functools import lru_cache

from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum

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
