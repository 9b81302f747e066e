"""A potential with its parameters, and what the page derives from it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, lru_cache

from app.state.energy_ranges import ENERGIES, EnergyRange
from engine import CASES, POTENTIALS, Potential, PotentialReview, parse_formula, review_potential, write_formula
from engine.service import LARGEST_NUMBER
from plots.palette import MOST_CHANNELS

TYPED = "typed"
"""Case of a potential that the user typed."""

PARAMETERS = {"omega_1": "ω1", "omega_2": "ω2", "epsilon": "ε"}
"""Symbols of the parameters."""

SYSTEM = ("case", "formula", *PARAMETERS)
"""Attributes of a view state that define its system."""

SHOWN_DIGITS = 12
"""Significant digits of the coefficients in formulas, where 1.46²/2 is 1.0658 without the rounding error of the product."""

# In units of the escape energy: lower end of the slider, initial energy, upper end of the slider.
_LOW, _FIRST, _HIGH = 0.8, 1.5, 4.0
# Upper limit of the slider, as a share of the way from the escape energy to the highest energy with separate exits.
_BELOW_HIGHEST = 0.99
# Smallest span of the slider in units of the escape energy: narrower spans are dominated by rounding.
_NARROWEST = 1e-9


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
    def is_known(self) -> bool:
        """Whether this is a case of the paper, whose review is known from the start."""
        return self.case in CASES and not self.changed


@dataclass(frozen=True)
class SystemReview:
    """A system with everything that the page derives from its potential, so that the event loop computes none of it.

    Attributes
    ----------
    system
        The system.
    review
        The review of its potential.
    problem
        Reason why the page cannot show it; None if it can.
    energies
        Energy range of the paper for its cases, else multiples of the escape energy; None if there is a problem.
    """

    system: System
    review: PotentialReview
    problem: str | None
    energies: EnergyRange | None

    @property
    def potential(self) -> Potential:
        """The potential, with its saddles already found."""
        return self.review.potential

    @property
    def formula_shown(self) -> str:
        """V(x, y) as text, with the values of the parameters."""
        if self.system.case == TYPED or self.system.changed:
            return write_formula(self.potential, SHOWN_DIGITS)
        return POTENTIALS[self.system.case].formula


def review_system(system: System) -> SystemReview:
    """Review a system: up to seconds, so that the page calls this on worker threads only.

    Raises
    ------
    ValueError
        If the formula or a parameter is invalid.
    """
    review = review_potential(system.potential)
    problem = refusal(review)
    return SystemReview(system, review, problem, None if problem else _energies(system, review))


@cache
def review_catalogue_entry(case: str) -> SystemReview:
    """The review of a catalogue entry; the server reviews the cases of the paper before it serves pages."""
    return review_system(System(case))


@lru_cache(maxsize=64)
def _potential(system: System) -> Potential:
    plain = parse_formula(system.formula) if system.case == TYPED else POTENTIALS[system.case].potential
    return plain.with_parameters(system.omega_1, system.omega_2, system.epsilon)


def _energies(system: System, review: PotentialReview) -> EnergyRange:
    if system.is_known:
        return ENERGIES[system.case]
    escape = review.escape_energy
    span = max(_BELOW_HIGHEST * (review.highest_energy - escape), _NARROWEST * escape)
    first, high = min(_FIRST * escape, escape + 0.5 * span), min(_HIGH * escape, escape + span)
    # Enough decimals to keep all of these distinct.
    decimals = max(2 - math.floor(math.log10(escape)), 1 - math.floor(math.log10(high - escape)))
    low, first, high = (round(energy, decimals) for energy in (_LOW * escape, first, high))
    return EnergyRange(low, high, (), first, decimals)


def refusal(found: PotentialReview) -> str | None:
    """Reason why the page cannot show a potential; None if it can."""
    if found.refusal is None and found.channels > MOST_CHANNELS:
        return f"It has {found.channels} channels; the page has colours for {MOST_CHANNELS}."
    if found.refusal is None and found.escape_energy <= 0.0:
        return f"Its escape energy is {found.escape_energy:.6g}; leave out the constant term, so that it is above 0."
    if found.refusal is None and _HIGH * found.escape_energy > LARGEST_NUMBER:
        return f"Its escape energy is {found.escape_energy:.6g}; the page shows energies up to {LARGEST_NUMBER:g}."
    return found.refusal
