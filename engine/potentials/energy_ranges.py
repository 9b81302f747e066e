"""Ranges of energies to explore: those of the maps in Zotos (2014), and of any potential."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.potentials.potential import Potential
from engine.potentials.validation_report import PointKind, review_potential

HIGHEST_SHOWN = 4.0
"""Upper end of the range of a potential in units of the escape energy, unless its exits join below it."""

# In units of the escape energy: lower end, initial energy.
_LOW, _FIRST = 0.8, 1.5
# Upper limit, as a share of the way from the escape energy to the highest energy with separate exits.
_BELOW_HIGHEST = 0.99
# Smallest span in units of the escape energy: narrower spans are dominated by rounding.
_NARROWEST = 1e-9
# Least spread of the critical energies, as a share of the largest.
_LEAST_SPREAD = 0.25


@dataclass(frozen=True)
class EnergyRange:
    """Energies of a potential, dimensionless.

    Attributes
    ----------
    low, high
        Its ends; `high` is also the upper end of the (x, h) plane.
    marked
        Energies of special interest, such as the nine of the paper.
    first
        Energy to begin with.
    decimals
        Decimals that distinguish the energies of the range.
    """

    low: float
    high: float
    marked: tuple[float, ...]
    first: float
    decimals: int = 3


PAPER_ENERGIES = {
    "I": EnergyRange(0.1, 0.5, (0.13, 0.15, 0.17, 0.19, 0.21, 0.23, 0.25, 0.27, 0.30), 0.19),
    "II": EnergyRange(0.14, 0.5, (0.17, 0.18, 0.19, 0.20, 0.22, 0.24, 0.26, 0.28, 0.30), 0.20),
    "III": EnergyRange(0.2, 1.0, (0.26, 0.28, 0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60), 0.35),
}
"""Energy ranges of the cases of Zotos (2014)."""


@lru_cache(maxsize=64)
def energy_range(potential: Potential) -> EnergyRange:
    """The range in multiples of the depth of the well, which is above 0; with an escape radius around the critical energies."""
    if potential.escape_radius is not None:
        return _range_around_critical_energies(potential)
    escape, depth = potential.escape_energy, potential.escape_energy - potential.well.bottom
    span = max(_BELOW_HIGHEST * (review_potential(potential).highest_energy - escape), _NARROWEST * depth)
    first, high = (
        min(potential.well.energy_at(_FIRST), escape + 0.5 * span),
        min(potential.well.energy_at(HIGHEST_SHOWN), escape + span),
    )
    # Enough decimals to keep all of these distinct.
    decimals = max(2 - math.floor(math.log10(depth)), 1 - math.floor(math.log10(high - escape)))
    low, first, high = (round(energy, decimals) for energy in (potential.well.energy_at(_LOW), first, high))
    return EnergyRange(low, high, (), first, decimals)


def critical_energies(potential: Potential) -> tuple[float, ...]:
    """The energies whose equipotentials are the limits of connected regions.

    With exits that of the lowest one; with an escape radius those of all saddles.
    """
    if potential.escape_radius is None:
        return (potential.escape_energy,)
    points = review_potential(potential).critical_points
    return tuple(sorted({point.energy for point in points if point.kind is PointKind.SADDLE}))


def depth_levels(potential: Potential, multiples: Sequence[float]) -> list[float]:
    """Energies at multiples of the depth of the well; none with an escape radius, where no well has a depth."""
    return [potential.well.energy_at(multiple) for multiple in multiples] if potential.escape_radius is None else []


def _range_around_critical_energies(potential: Potential) -> EnergyRange:
    """From below the lowest critical point to above the highest one, where all of the plane is allowed."""
    energies = np.array([point.energy for point in review_potential(potential).critical_points] or [potential.well.bottom])
    span = max(float(np.ptp(energies)), _LEAST_SPREAD * float(np.abs(energies).max()), _NARROWEST * potential.units.energy)
    decimals = 2 - math.floor(math.log10(span))
    ends = energies.min() - 0.5 * span, energies.max() + 0.5 * span, np.median(energies)
    low, high, first = (round(float(energy), decimals) for energy in ends)
    return EnergyRange(low, high, (), first, decimals)
