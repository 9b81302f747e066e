"""The rotations under which a polynomial potential stays as it is, read off its terms."""

from __future__ import annotations

import math

from engine.potentials.potential import Potential

# Coefficients that cancel to this share of the largest are zero.
_ROUNDING = 1e-12


def count_rotations(potential: Potential) -> int:
    """The largest n for which a turn by 2π/n leaves a potential as it is: 1 when none does, 0 when every turn does.

    In z = x + iy a polynomial is Σ c z^a z̄^b, and a turn by an angle φ multiplies a term by exp(i (a − b) φ): n is the greatest
    common divisor of all a − b.
    """
    windings = {a - b for (a, b), c in _complex_terms(potential).items() if a != b}
    return math.gcd(*windings)


def _complex_terms(potential: Potential) -> dict[tuple[int, int], complex]:
    """{(a, b): c} of V = Σ c z^a z̄^b; those that rounding has left of a zero are left out."""
    x, y = {(1, 0): 0.5 + 0j, (0, 1): 0.5 + 0j}, {(1, 0): -0.5j, (0, 1): 0.5j}
    total: dict[tuple[int, int], complex] = {}
    for i, j, c in potential.terms:
        term: dict[tuple[int, int], complex] = {(0, 0): complex(c)}
        for factor in [x] * i + [y] * j:
            term = _product(term, factor)
        for powers, value in term.items():
            total[powers] = total.get(powers, 0j) + value
    sizes = {n: max(abs(c) for i, j, c in potential.terms if i + j == n) for n in {i + j for i, j, _ in potential.terms}}
    return {(a, b): c for (a, b), c in total.items() if abs(c) > _ROUNDING * sizes[a + b]}


def _product(a: dict[tuple[int, int], complex], b: dict[tuple[int, int], complex]) -> dict[tuple[int, int], complex]:
    out: dict[tuple[int, int], complex] = {}
    for (i, j), c in a.items():
        for (k, m), d in b.items():
            out[i + k, j + m] = out.get((i + k, j + m), 0j) + c * d
    return out
