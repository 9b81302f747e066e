"""A potential as users choose it: a name of the catalogue or a formula, with the parameters of Zotos (2014)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from engine.potentials.catalogue import POTENTIALS
from engine.potentials.energy_ranges import PAPER_ENERGIES, EnergyRange, energy_range
from engine.potentials.formula_parser import parse_formula, write_formula
from engine.potentials.potential import CASES, Potential

TYPED = "typed"
"""Case of a potential that is given by a formula."""

PARAMETERS = {"omega_1": "ω1", "omega_2": "ω2", "epsilon": "ε"}
"""Symbols of the parameters."""

SHOWN_DIGITS = 12
"""Significant digits of the coefficients in formulas, where 1.46²/2 is 1.0658 without the rounding error of the product."""


@dataclass(frozen=True)
class System:
    """A potential with the parameters ω1, ω2 and ε of Zotos (2014), V = ½(ω1² x² + ω2² y²) + ε V1.

    Attributes
    ----------
    case
        A key of `engine.POTENTIALS`, or `TYPED`.
    formula
        V(x, y) as text for `TYPED`, else empty.
    omega_1, omega_2, epsilon
        As in `Potential.with_parameters`.
    """

    case: str
    formula: str = ""
    omega_1: float = 1.0
    omega_2: float = 1.0
    epsilon: float = 1.0

    @property
    def potential(self) -> Potential:
        """The potential; ValueError if the formula or a parameter is invalid."""
        return _potential(self)

    @property
    def changed(self) -> dict[str, float]:
        """The parameters that are not 1."""
        return {name: getattr(self, name) for name in PARAMETERS if getattr(self, name) != 1.0}

    @property
    def title(self) -> str:
        """Name of the potential, with the parameters that are not 1."""
        name = "Typed potential" if self.case == TYPED else POTENTIALS[self.case].title
        changed = ", ".join(f"{PARAMETERS[name]} = {value:.6g}" for name, value in self.changed.items())
        return f"{name} with {changed}" if changed else name

    @property
    def formula_shown(self) -> str:
        """V(x, y) as text, with the values of the parameters."""
        if self.case == TYPED or self.changed:
            return write_formula(self.potential, SHOWN_DIGITS)
        return POTENTIALS[self.case].formula

    @property
    def energies(self) -> EnergyRange:
        """Energy range of the paper for its cases, else multiples of the escape energy."""
        if self.case in CASES and not self.changed:
            return PAPER_ENERGIES[self.case]
        return energy_range(self.potential)


@lru_cache(maxsize=64)
def _potential(system: System) -> Potential:
    plain = parse_formula(system.formula) if system.case == TYPED else POTENTIALS[system.case].potential
    return plain.with_parameters(system.omega_1, system.omega_2, system.epsilon)
