"""Make potentials of the family C_n, with any number of channels."""

from __future__ import annotations

from fractions import Fraction
from math import comb

from engine import Potential


def channel_family(n: int) -> Potential:
    """Return V = r²/2 − (1/n) rⁿ cos nθ, with n channels at θ = 2πk/n. The saddles have r = 1 and the energy 1/2 − 1/n."""
    # rⁿ cos nθ is the real part of (x + iy)ⁿ.
    perturbation = ((n - j, j, float(Fraction((-1) ** (j // 2 + 1) * comb(n, j), n))) for j in range(0, n + 1, 2))
    return Potential(f"C{n}", ((2, 0, 0.5), (0, 2, 0.5), *perturbation))
