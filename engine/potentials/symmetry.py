"""The rotations that leave a polynomial potential unchanged, from its terms."""

from __future__ import annotations

import math

from engine.polynomials import Powers, largest_coefficients, substitute
from engine.potentials.potential import Potential

# Coefficients below this share of the largest one of the same degree are rounding errors of zero.
_ROUNDING = 1e-12


def count_rotations(potential: Potential) -> int:
    """The largest n for which a rotation by 2π/n leaves a potential unchanged: 1 if none does, 0 if every rotation does.

    In z = x + iy the potential is Σ c z^a z̄^b, and a rotation by φ multiplies each term by exp(i (a − b) φ). So n is the greatest
    common divisor of all a − b.
    """
    return math.gcd(*(a - b for a, b in _complex_terms(potential) if a != b))


def _complex_terms(potential: Potential) -> dict[Powers, complex]:
    """{(a, b): c} of V = Σ c z^a z̄^b, without rounding errors of zero coefficients."""
    x, y = {(1, 0): 0.5 + 0j, (0, 1): 0.5 + 0j}, {(1, 0): -0.5j, (0, 1): 0.5j}
    terms = potential.coefficients
    largest = largest_coefficients(terms)
    return {(a, b): c for (a, b), c in substitute(terms, x, y).items() if abs(c) > _ROUNDING * largest[a + b]}
