"""Sparse polynomials in x and y, stored as {(i, j): c} for Σ c x^i y^j. Exact arithmetic limits the size of its results."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

Powers = tuple[int, int]
Terms = Mapping[Powers, float]
ExactTerms = Mapping[Powers, Fraction]

HIGHEST_DEGREE = 12
"""Highest degree of a potential. Searches for critical points are tested up to it, and higher degrees make Taylor steps slow."""

# Largest number of bits of a numerator or denominator, so that a short formula cannot cause long computations.
_MOST_BITS = 1000


class TooLargeError(ValueError):
    """The degree of a polynomial is too high, or one of its numbers has too many digits."""


def degree(terms: Mapping[Powers, object]) -> int:
    """Return the highest i + j of a term x^i y^j; 0 for a constant."""
    return max((i + j for i, j in terms), default=0)


def largest_coefficients(*polynomials: Terms) -> dict[int, float]:
    """Return {n: largest magnitude of a coefficient of degree n}."""
    largest: dict[int, float] = {}
    for terms in polynomials:
        for (i, j), c in terms.items():
            largest[i + j] = max(largest.get(i + j, 0.0), abs(c))
    return largest


def evaluate(terms: Terms, x: Any, y: Any) -> Any:
    """Return the polynomial at (x, y). Arrays broadcast."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
    for (i, j), c in terms.items():
        total = total + c * _power(x, i) * _power(y, j)
    # An array without dimensions becomes a number.
    return total[()]


def _power(x: np.ndarray, i: int) -> np.ndarray:
    """Return x^i with exactly equal magnitudes for x and −x. Powers of NumPy above 3 do not ensure this."""
    if i < 4:
        return x**i
    return np.abs(x) ** i if i % 2 == 0 else x * np.abs(x) ** (i - 1)


def derivative(terms: Terms, axis: int) -> dict[Powers, float]:
    """Return the terms of ∂/∂x (axis 0) or ∂/∂y (axis 1)."""
    if axis == 0:
        return {(i - 1, j): i * c for (i, j), c in terms.items() if i}
    return {(i, j - 1): j * c for (i, j), c in terms.items() if j}


def multiply[C: (float, complex, Fraction)](a: Mapping[Powers, C], b: Mapping[Powers, C]) -> dict[Powers, C]:
    """Return a · b. Terms that cancel remain as zeros."""
    total: dict[Powers, C] = {}
    for (i, j), c in a.items():
        for (k, m), d in b.items():
            powers = i + k, j + m
            total[powers] = total.get(powers, 0) + c * d
    return total


def substitute[C: (float, complex)](terms: Terms, x: Mapping[Powers, C], y: Mapping[Powers, C]) -> dict[Powers, C]:
    """Replace x and y in a polynomial by two polynomials. Terms that cancel remain as zeros or rounding errors."""
    total: dict[Powers, C] = {}
    for (i, j), c in terms.items():
        monomial: dict[Powers, C] = {(0, 0): 1.0}
        for factor in [x] * i + [y] * j:
            monomial = multiply(monomial, factor)
        for powers, d in monomial.items():
            total[powers] = total.get(powers, 0) + c * d
    return total


def exact_sum(a: ExactTerms, b: ExactTerms) -> dict[Powers, Fraction]:
    """Return a + b, without the terms that cancel."""
    zero = Fraction(0)
    return _nonzero_terms({powers: a.get(powers, zero) + b.get(powers, zero) for powers in {**a, **b}})


def exact_negative(a: ExactTerms) -> dict[Powers, Fraction]:
    """Return −a."""
    return {powers: -c for powers, c in a.items()}


def exact_product(a: ExactTerms, b: ExactTerms) -> dict[Powers, Fraction]:
    """Return a · b, without the terms that cancel; raise `TooLargeError` before multiplying if the degree would be too high."""
    if a and b and degree(a) + degree(b) > HIGHEST_DEGREE:
        raise TooLargeError(f"degree {degree(a) + degree(b)}; the highest degree is {HIGHEST_DEGREE}")
    return _nonzero_terms(multiply(a, b))


def exact_power(a: ExactTerms, exponent: int) -> dict[Powers, Fraction]:
    """Return a to an integer power from 0 to `HIGHEST_DEGREE`."""
    total: dict[Powers, Fraction] = {(0, 0): Fraction(1)}
    for _ in range(exponent):
        total = exact_product(total, a)
    return total


def _nonzero_terms(a: ExactTerms) -> dict[Powers, Fraction]:
    """Return the nonzero terms; raise `TooLargeError` if a number has too many digits."""
    nonzero = {powers: c for powers, c in a.items() if c}
    for c in nonzero.values():
        if max(c.numerator.bit_length(), c.denominator.bit_length()) > _MOST_BITS:
            raise TooLargeError("a number of more than 300 digits")
    return nonzero
