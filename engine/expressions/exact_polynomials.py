"""FLINT's polynomials in x and y with rational coefficients, and their products and powers of limited size."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from engine.expressions.polynomials import HIGHEST_DEGREE, Powers

RING = fmpq_mpoly_ctx.get(("x", "y"), Ordering.lex)
"""The context of polynomials in x and y with rational coefficients."""

# Limit on the bits of a numerator or denominator, so that a short formula cannot cause long computations.
_MOST_BITS = 1000


class TooLargeError(ValueError):
    """The degree of a polynomial is too high, or one of its numbers has too many digits."""


def exact_polynomial(terms: Mapping[Powers, Fraction]) -> fmpq_mpoly:
    """Return Σ c x^i y^j as a polynomial of FLINT."""
    return RING.from_dict({powers: fmpq(c.numerator, c.denominator) for powers, c in terms.items()})


def exact_constant(value: Fraction) -> fmpq_mpoly:
    """Return a number as a polynomial of FLINT."""
    return RING.constant(fmpq(value.numerator, value.denominator))


def exact_terms(polynomial: fmpq_mpoly) -> dict[Powers, Fraction]:
    """Return the terms {(i, j): c} of a polynomial of FLINT; empty for 0."""
    return {(int(i), int(j)): Fraction(int(c.p), int(c.q)) for (i, j), c in polynomial.to_dict().items()}


def limited_product(a: fmpq_mpoly, b: fmpq_mpoly) -> fmpq_mpoly:
    """Return a · b; raise `TooLargeError`, before multiplying if the degree would be too high."""
    if a and b and a.total_degree() + b.total_degree() > HIGHEST_DEGREE:
        raise TooLargeError(f"degree {a.total_degree() + b.total_degree()}; the highest degree is {HIGHEST_DEGREE}")
    return checked_size(a * b)


def limited_power(a: fmpq_mpoly, exponent: int) -> fmpq_mpoly:
    """Return a^exponent for an exponent from 0 to `HIGHEST_DEGREE`; raise `TooLargeError` if the power is too large."""
    total = RING.constant(1)
    for _ in range(exponent):
        total = limited_product(total, a)
    return total


def checked_size(polynomial: fmpq_mpoly) -> fmpq_mpoly:
    """Return the polynomial itself; raise `TooLargeError` if one of its numbers has too many digits."""
    for c in polynomial.coeffs():
        if max(int(c.p).bit_length(), int(c.q).bit_length()) > _MOST_BITS:
            raise TooLargeError("a number of more than 300 digits")
    return polynomial
