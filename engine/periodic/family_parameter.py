"""The parameter of a family of periodic orbits, which changes along the family: the energy, or a parameter of the system.

Values of a parameter are in its own unit. All orbits of a family are in the units of one well, that of its first orbit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from engine.periodic.symmetries import Symmetry, symmetries_of
from engine.slices.axes import Coordinate, ParameterAxis
from engine.slices.sections.section import Section
from engine.systems.potential import Potential
from engine.systems.related_wells import with_well_of
from engine.systems.well_units import nearest_power_of_two

ENERGY = Coordinate.H.key
"""Name of the energy."""

# Half the distance of the values between which differences are taken. Newton's method needs no more than their first digits.
_DIFFERENCE = 1e-5
# Number of potentials that are kept. Several functions are called for each value.
_KEPT_POTENTIALS = 64


class NoPotentialError(ValueError):
    """The system has no potential at a value of its parameter."""


class Conditions(NamedTuple):
    """What an orbit of a family has to meet, in units of the well.

    Attributes
    ----------
    potential
        The potential in which the orbit moves.
    section
        The section to which it returns.
    energy
        Its energy h.
    """

    potential: Potential
    section: Section
    energy: float


Residual = Callable[[Conditions], np.ndarray]
"""A function that returns by how much an orbit misses some conditions, (m,)."""


@dataclass(frozen=True)
class FamilyParameter:
    """The parameter of a family.

    Attributes
    ----------
    potential
        The potential of the first orbit.
    section
        The section, in the units of the potential.
    """

    potential: Potential
    section: Section

    @property
    def noun(self) -> str:
        """The parameter in sentences: "energy"."""
        raise NotImplementedError

    @property
    def unit(self) -> float:
        """Unit of its values, a power of 2."""
        raise NotImplementedError

    @property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest legal value, in its unit."""
        raise NotImplementedError

    def potential_at(self, value: float) -> Potential:
        """Return the potential at a value, with the units of the first one; `NoPotentialError` if there is none."""
        raise NotImplementedError

    def energy_at(self, value: float) -> float:
        """Return the energy of the orbits at a value, in units of the well."""
        raise NotImplementedError

    def derivative(self, value: float, size: int, residual: Residual) -> np.ndarray:
        """Return the derivative by the value, (size,), of a residual whose last entry is an energy minus that of the orbit."""
        raise NotImplementedError

    def symmetries_at(self, value: float) -> tuple[Symmetry, ...]:
        """Return the symmetries of the motion at a value and at the values beside it."""
        raise NotImplementedError

    def at(self, value: float) -> Conditions:
        """Return the conditions at a value; `NoPotentialError` if there is no potential."""
        potential = self.potential_at(value)
        return Conditions(potential.in_well_units, self.section.in_well_units(potential.units), self.energy_at(value))


@dataclass(frozen=True)
class EnergyParameter(FamilyParameter):
    """The energy h, in one potential."""

    @property
    def noun(self) -> str:
        """See `FamilyParameter.noun`."""
        return "energy"

    @property
    def unit(self) -> float:
        """The unit of energy of the well."""
        return self.potential.units.energy

    @property
    def limits(self) -> tuple[float, float]:
        """None: every energy is legal."""
        return -np.inf, np.inf

    def potential_at(self, value: float) -> Potential:
        """Return the potential."""
        return self.potential

    def energy_at(self, value: float) -> float:
        """Return the value."""
        return value

    def derivative(self, value: float, size: int, residual: Residual) -> np.ndarray:
        """See `FamilyParameter.derivative`. Only the last entry depends on the energy."""
        column = np.zeros(size)
        column[-1] = -1.0
        return column

    def symmetries_at(self, value: float) -> tuple[Symmetry, ...]:
        """Return the symmetries of the motion, which do not depend on the energy."""
        return symmetries_of(self.potential.in_well_units)


@dataclass(frozen=True)
class SystemParameter(FamilyParameter):
    """A parameter of the system, at one energy.

    Attributes
    ----------
    axis
        The parameter with its range along the family.
    energy
        The energy h of all orbits, in the units of the potential.
    """

    axis: ParameterAxis
    energy: float

    @property
    def noun(self) -> str:
        """See `FamilyParameter.noun`."""
        return f"value of {self.axis.symbol}"

    @property
    def unit(self) -> float:
        """About the range, which thus takes as many steps as a change of the orbit by the size of the well."""
        return nearest_power_of_two(self.axis.high - self.axis.low)

    @property
    def limits(self) -> tuple[float, float]:
        """See `FamilyParameter.limits`."""
        lowest, highest = self.axis.system.range_of(self.axis.key)
        return lowest / self.unit, highest / self.unit

    def potential_at(self, value: float) -> Potential:
        """See `FamilyParameter.potential_at`."""
        return _potential_on(self.axis, value * self.unit, self.potential)

    def energy_at(self, value: float) -> float:
        """Return the energy of all orbits."""
        return self.energy / self.potential.units.energy

    def derivative(self, value: float, size: int, residual: Residual) -> np.ndarray:
        """See `FamilyParameter.derivative`. This is a central difference."""
        low, high = self._beside(value)
        return (residual(self.at(high)) - residual(self.at(low))) / (high - low)

    def symmetries_at(self, value: float) -> tuple[Symmetry, ...]:
        """See `FamilyParameter.symmetries_at`. A symmetry of one value alone is none of the family."""
        here, *beside = (symmetries_of(self.at(each).potential) for each in (value, *self._beside(value)))
        return tuple(each for each in here if all(each in others for others in beside))

    def _beside(self, value: float) -> tuple[float, float]:
        """Return the legal values below and above a value, in the unit of the parameter."""
        lowest, highest = self.limits
        return max(value - _DIFFERENCE, lowest), min(value + _DIFFERENCE, highest)


def parameter_of_family(
    potential: Potential, section: Section, along: str, bounds: tuple[float, float], energy: float
) -> FamilyParameter:
    """Return the parameter of a family, with the potential and the energy of its first orbit, and the range of its values."""
    if along == ENERGY:
        return EnergyParameter(potential, section)
    return SystemParameter(potential, section, ParameterAxis(along, *bounds, potential), energy)


@lru_cache(maxsize=_KEPT_POTENTIALS)
def _potential_on(axis: ParameterAxis, value: float, first: Potential) -> Potential:
    """Return the potential at a value of a parameter of the system, with the well of the first potential of a family."""
    try:
        return with_well_of(axis.potential(value), first)
    except ValueError as error:
        raise NoPotentialError(str(error)) from error
