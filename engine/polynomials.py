"""Polynomials in x and y with exact rational coefficients, kept small enough that no expression can blow up."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

Exact = Mapping[tuple[int, int], Fraction]

HIGHEST_DEGREE = 12
"""The highest degree of a potential: saddles are tested to it, and a Taylor step costs the more the higher it is."""

# Bits of a numerator or denominator: no number that anyone means needs more, and products of longer ones take long.
_MOST_BITS = 1000


class TooLargeError(ValueError):
    """A polynomial of too high a degree, or with a number of too many digits."""


def add(a: Exact, b: Exact) -> dict[tuple[int, int], Fraction]:
    """a + b, without the terms that cancel."""
    total = {powers: a.get(powers, Fraction(0)) + b.get(powers, Fraction(0)) for powers in {**a, **b}}
    return _checked({powers: c for powers, c in total.items() if c})


def negative(a: Exact) -> dict[tuple[int, int], Fraction]:
    """−a."""
    return {powers: -c for powers, c in a.items()}


def product(a: Exact, b: Exact) -> dict[tuple[int, int], Fraction]:
    """a · b; raises `TooLargeError` before anything is multiplied out that is of too high a degree."""
    if a and b and degree(a) + degree(b) > HIGHEST_DEGREE:
        raise TooLargeError(f"of degree {degree(a) + degree(b)}; the highest degree is {HIGHEST_DEGREE}")
    total: dict[tuple[int, int], Fraction] = {}
    for (i, j), c in a.items():
        for (k, m), d in b.items():
            total[i + k, j + m] = total.get((i + k, j + m), Fraction(0)) + c * d
    return _checked({powers: c for powers, c in total.items() if c})


def power(a: Exact, exponent: int) -> dict[tuple[int, int], Fraction]:
    """a to a power from 0 to `HIGHEST_DEGREE`."""
    total: dict[tuple[int, int], Fraction] = {(0, 0): Fraction(1)}
    for _ in range(exponent):
        total = product(total, a)
    return total


def degree(a: Exact) -> int:
    """The highest i + j of a term x^i y^j; 0 for a number."""
    return max((i + j for i, j in a), default=0)


def _checked(a: dict[tuple[int, int], Fraction]) -> dict[tuple[int, int], Fraction]:
    for c in a.values():
        if max(c.numerator.bit_length(), c.denominator.bit_length()) > _MOST_BITS:
            raise TooLargeError("a number of more than 300 digits")
    return a
