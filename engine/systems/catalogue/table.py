"""The potentials included in the engine, with descriptions and references. `docs/systems.md` also lists them."""

from __future__ import annotations

from collections.abc import Mapping

from engine.foundations.names import ByName
from engine.foundations.plug_ins import Entries, Group
from engine.systems.catalogue.entry import CatalogueEntry, EnergyRange
from engine.systems.catalogue.rotating_systems import ROTATING_ENTRIES
from engine.systems.formulas.formula_parser import make_potential
from engine.systems.parameters import WELL_PARAMETERS

PAPER_ENERGIES = {
    "I": EnergyRange(low=0.1, high=0.5, marked=(0.13, 0.15, 0.17, 0.19, 0.21, 0.23, 0.25, 0.27, 0.30), first=0.19),
    "II": EnergyRange(low=0.14, high=0.5, marked=(0.17, 0.18, 0.19, 0.20, 0.22, 0.24, 0.26, 0.28, 0.30), first=0.20),
    "III": EnergyRange(low=0.2, high=1.0, marked=(0.26, 0.28, 0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60), first=0.35),
}
"""Energy ranges of the cases of Zotos (2014)."""


def _paper_entry(name: str, formula: str, description: str) -> CatalogueEntry:
    reference = "E. E. Zotos, Nonlinear Dynamics 78, 1389 (2014)"
    return CatalogueEntry(name, f"Case {name}", formula, description, reference, energies=PAPER_ENERGIES[name])


def _family_entry(n: int, count_word: str, polynomial: str, escape_energy: str) -> CatalogueEntry:
    """Return the entry of V = r²/2 − (1/n) rⁿ cos nθ, given rⁿ cos nθ, the real part of (x + iy)ⁿ, as a polynomial."""
    description = f"{count_word} equal channels at θ = 2πk/{n}, open above {escape_energy}."
    reference = "V = r²/2 − (1/n) rⁿ cos nθ, a family of potentials of this project"
    return CatalogueEntry(f"C{n}", f"C{n} family", f"r²/2 − ({polynomial})/{n}", description, reference)


_ENTRIES = (
    _paper_entry("I", "½(x² + y²) − xy²", "Two channels, mirror images of each other in the x axis."),
    _paper_entry(
        "II", "½(x² + y²) − x(x²/3 − y²)", "Three channels at angles of 120° to each other: the Hénon–Heiles potential, rotated."
    ),
    _paper_entry("III", "½(x² + y²) − x²y²", "Four channels along the diagonals."),
    _family_entry(3, "Three", "x^3 − 3xy^2", "1/6: identical to case II"),
    _family_entry(4, "Four", "x^4 − 6x^2y^2 + y^4", "1/4"),
    _family_entry(5, "Five", "x^5 − 10x^3y^2 + 5xy^4", "3/10"),
    _family_entry(6, "Six", "x^6 − 15x^4y^2 + 15x^2y^4 − y^6", "1/3"),
    _family_entry(7, "Seven", "x^7 − 21x^5y^2 + 35x^3y^4 − 7xy^6", "5/14"),
    _family_entry(8, "Eight", "x^8 − 28x^6y^2 + 70x^4y^4 − 28x^2y^6 + y^8", "3/8"),
    CatalogueEntry(
        "HH",
        "Hénon–Heiles",
        "½(x² + y²) + x²y − y³/3",
        "Three channels, one of them along the +y axis: the original orientation, even in x but not in y.",
        "M. Hénon & C. Heiles, Astronomical Journal 69, 73 (1964)",
        sections=("x = 0, px > 0",),
    ),
    CatalogueEntry(
        "Barbanis",
        "Barbanis, unequal frequencies",
        "½(x² + 1.1² y²) − 0.11xy²",
        "Two channels far from the origin, as in case I, with frequencies 1 and 1.1 and a weak coupling.",
        "S. Naik & S. Wiggins, arXiv:1904.10018 (2019), for the form of the potential; this project chose the coefficients",
    ),
    CatalogueEntry(
        "Separable",
        "Integrable Hénon–Heiles, separable",
        "½(x² + y²) + xy² + x³/3",
        "Two channels and no chaos: the motions along x + y and along x − y are independent.",
        "G. Contopoulos, A. C. Tzemos & F. Zanias, arXiv:2501.08437 (2025)",
    ),
    CatalogueEntry(
        "One exit",
        "Integrable Hénon–Heiles, one exit",
        "½(x² + y²) + xy² + 2x³",
        "A single channel along −x and no chaos.",
        "A. C. Tzemos, G. Contopoulos & F. Zanias, arXiv:2509.10201 (2025)",
    ),
)


def _check_formula(entry: CatalogueEntry) -> None:
    """Raise ValueError if the formula of an entry cannot be parsed."""
    letters = {name: value for name, value in entry.parameters.items() if name not in WELL_PARAMETERS}
    make_potential(entry.formula, entry.name, letters)


_ENTRIES_BY_NAME = Entries(Group.SYSTEMS, CatalogueEntry, (*_ENTRIES, *ROTATING_ENTRIES), check=_check_formula)

CATALOGUE: Mapping[str, CatalogueEntry] = ByName(
    "potential", _ENTRIES_BY_NAME, _ENTRIES_BY_NAME.__getitem__, lambda name: _ENTRIES_BY_NAME[name].title
)
"""The potentials with their descriptions, by name: the three cases of Zotos (2014), others, and those of other packages."""
