"""The potentials of the catalogue by name, and the C_n family."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from math import comb

from engine.expressions.polynomials import HIGHEST_DEGREE
from engine.foundations.validation import checked_count
from engine.systems.catalogue.names import ByName
from engine.systems.catalogue.table import CATALOGUE, PAPER_ENERGIES
from engine.systems.potential import Potential
from engine.systems.system import System


@cache
def _potential(name: str) -> Potential:
    return System(name).potential


CASES: Mapping[str, Potential] = ByName("case", PAPER_ENERGIES, _potential)
"""The three cases of Zotos (2014): V = (x² + y²)/2 + V1 with V1 = −x y², −x (x²/3 − y²) and −x² y²."""

POTENTIALS: Mapping[str, Potential] = ByName(
    "potential", CATALOGUE, _potential, {name: entry.title for name, entry in CATALOGUE.items()}
)
"""All potentials included in the engine, by name: ``POTENTIALS["HH"]``. The three cases of Zotos (2014) come first."""


def channel_family(n: int) -> Potential:
    """Make a potential of the C_n family: V = r²/2 − (1/n) rⁿ cos nθ, with n exit channels at θ = 2πk/n, k = 0 … n − 1.

    The saddles lie at r = 1 and the escape energy is 1/2 − 1/n. The potential has the symmetry of a regular polygon with n
    corners. n = 3 is case II.

    Parameters
    ----------
    n
        Number of channels, 3 to 12.

    Raises
    ------
    ValueError
        If n is out of range.

    Examples
    --------
    >>> from escape_explorer import POTENTIALS
    >>> potential = POTENTIALS["C5"]
    >>> potential.channels, round(potential.escape_energy, 6)
    (5, 0.3)
    """
    n = checked_count("n", n, 3, HIGHEST_DEGREE)
    # rⁿ cos nθ is the real part of (x + iy)ⁿ.
    perturbation = ((n - j, j, float(Fraction((-1) ** (j // 2 + 1) * comb(n, j), n))) for j in range(0, n + 1, 2))
    return Potential(f"C{n}", ((2, 0, 0.5), (0, 2, 0.5), *perturbation))
