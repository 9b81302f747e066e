"""Sparse polynomials in x and y, stored as {(i, j): c} for Σ c x^i y^j."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

Powers = tuple[int, int]
"""The exponents (i, j) of x^i y^j."""

Terms = Mapping[Powers, float]
"""The polynomial Σ c x^i y^j as {(i, j): c}."""

HIGHEST_DEGREE = 12
"""Highest degree of a potential. For higher degrees, the search for critical points is untested, and Taylor steps are slow."""


def degree(terms: Mapping[Powers, object]) -> int:
    """Return the highest i + j of a term x^i y^j; 0 for a constant."""
    return max((i + j for i, j in terms), default=0)


def largest_coefficients(*polynomials: Terms) -> dict[int, float]:
    """Return, for each degree n, the largest magnitude of the coefficients of the terms of this degree."""
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
    """Return x^i with exactly equal magnitudes for x and −x. NumPy does not ensure this for exponents above 3."""
    if i < 4:
        return x**i
    return np.abs(x) ** i if i % 2 == 0 else x * np.abs(x) ** (i - 1)


def derivative(terms: Terms, axis: int) -> dict[Powers, float]:
    """Return the terms of ∂/∂x (axis 0) or ∂/∂y (axis 1)."""
    if axis == 0:
        return {(i - 1, j): i * c for (i, j), c in terms.items() if i}
    return {(i, j - 1): j * c for (i, j), c in terms.items() if j}


def multiply[C: (float, complex)](a: Mapping[Powers, C], b: Mapping[Powers, C]) -> dict[Powers, C]:
    """Return the product of two polynomials. Terms that cancel remain as zeros."""
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
