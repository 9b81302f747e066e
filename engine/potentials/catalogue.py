"""The potentials included in the engine, each with a description and a reference; `docs/potentials.md` lists them too."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import comb
from types import MappingProxyType

from engine.polynomials import HIGHEST_DEGREE
from engine.potentials.names import ByName
from engine.potentials.potential import Potential
from engine.potentials.potential_entry import PotentialEntry
from engine.potentials.rotating_systems import ROTATING_ENTRIES
from engine.validation import checked_count


def channel_family(n: int) -> Potential:
    """The C_n family: V = r²/2 − (1/n) rⁿ cos nθ, with n exit channels at θ = 2πk/n, k = 0 … n − 1.

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
    >>> from escape_explorer import channel_family
    >>> potential = channel_family(5)
    >>> potential.channels, round(potential.escape_energy, 6)
    (5, 0.3)
    """
    n = checked_count("n", n, 3, HIGHEST_DEGREE)
    # rⁿ cos nθ is the real part of (x + iy)ⁿ.
    perturbation = ((n - j, j, float(Fraction((-1) ** (j // 2 + 1) * comb(n, j), n))) for j in range(0, n + 1, 2))
    return Potential(f"C{n}", ((2, 0, 0.5), (0, 2, 0.5), *perturbation))


def _paper_entry(name: str, formula: str, description: str) -> PotentialEntry:
    reference = "E. E. Zotos, Nonlinear Dynamics 78, 1389 (2014)"
    return PotentialEntry(name, f"Case {name}", formula, description, reference)


def _family_entry(n: int) -> PotentialEntry:
    count = {3: "Three", 4: "Four", 5: "Five", 6: "Six", 7: "Seven", 8: "Eight"}[n]
    equal = ": identical to case II" if n == 3 else ""
    return PotentialEntry(
        f"C{n}",
        f"C{n} family",
        f"r²/2 − ({' '.join(_signed_term(n, j) for j in range(0, n + 1, 2)).removeprefix('+ ')})/{n}",
        f"{count} equal channels at θ = 2πk/{n}, open above {Fraction(1, 2) - Fraction(1, n)}{equal}.",
        "V = r²/2 − (1/n) rⁿ cos nθ, a family of potentials of this project",
    )


def _signed_term(n: int, j: int) -> str:
    """The term with x^(n − j) y^j of the real part of (x + iy)ⁿ, as text."""
    letters = "".join(f"{name}^{power}" if power > 1 else name for name, power in (("x", n - j), ("y", j)) if power)
    return f"{'−' if j % 4 else '+'} {comb(n, j) if comb(n, j) > 1 else ''}{letters}"


def _literature_entry(name: str, title: str, formula: str, description: str, reference: str) -> PotentialEntry:
    return PotentialEntry(name, title, formula, description, reference)


_ENTRIES = (
    _paper_entry("I", "½(x² + y²) − xy²", "Two channels, mirror images of each other in the x axis."),
    _paper_entry(
        "II", "½(x² + y²) − x(x²/3 − y²)", "Three channels at angles of 120° to each other: the Hénon–Heiles potential, rotated."
    ),
    _paper_entry("III", "½(x² + y²) − x²y²", "Four channels along the diagonals."),
    *(_family_entry(n) for n in range(3, 9)),
    _literature_entry(
        "HH",
        "Hénon–Heiles",
        "½(x² + y²) + x²y − y³/3",
        "Three channels, one of them along the +y axis: the original orientation, even in x but not in y.",
        "M. Hénon & C. Heiles, Astronomical Journal 69, 73 (1964)",
    ),
    _literature_entry(
        "Barbanis",
        "Barbanis, unequal frequencies",
        "½(x² + 1.1² y²) − 0.11xy²",
        "Two channels far from the origin, as in case I, with frequencies 1 and 1.1 and a weak coupling.",
        "S. Naik & S. Wiggins, arXiv:1904.10018 (2019), for the form of the potential; the coefficients are chosen here",
    ),
    _literature_entry(
        "Separable",
        "Integrable Hénon–Heiles, separable",
        "½(x² + y²) + xy² + x³/3",
        "Two channels and no chaos: the motions along x + y and along x − y are independent.",
        "G. Contopoulos, A. C. Tzemos & F. Zanias, arXiv:2501.08437 (2025)",
    ),
    _literature_entry(
        "One exit",
        "Integrable Hénon–Heiles, one exit",
        "½(x² + y²) + xy² + 2x³",
        "A single channel along −x and no chaos.",
        "A. C. Tzemos, G. Contopoulos & F. Zanias, arXiv:2509.10201 (2025)",
    ),
)

CATALOGUE: Mapping[str, PotentialEntry] = MappingProxyType({entry.name: entry for entry in (*_ENTRIES, *ROTATING_ENTRIES)})
"""The potentials included in the engine with their descriptions, by name; the three cases of Zotos (2014) come first."""


class _Potentials(Mapping[str, Potential]):
    """The potentials of the catalogue, each made at its first use."""

    def __getitem__(self, name: str) -> Potential:
        return CATALOGUE[name].potential

    def __contains__(self, name: object) -> bool:
        return name in CATALOGUE

    def __iter__(self) -> Iterator[str]:
        return iter(CATALOGUE)

    def __len__(self) -> int:
        return len(CATALOGUE)


POTENTIALS: Mapping[str, Potential] = ByName(
    "potential",
    _Potentials(),
    {name: entry.title for name, entry in CATALOGUE.items()},
)
"""All potentials included in the engine, by name: ``POTENTIALS["HH"]``; the three cases of Zotos (2014) come first."""
