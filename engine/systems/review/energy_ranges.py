"""Energies to explore, for any potential."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from engine.systems.catalogue.entry import EnergyRange
from engine.systems.potential import Potential

HIGHEST_SHOWN = 4.0
"""Upper end of the range in units of the depth of the well, unless exits merge at a lower energy."""

# Lower end of the range, in units of the depth of the well.
_LOW = 0.8
# Initial energy, in units of the depth of the well.
_FIRST = 1.5
# Upper limit, as a share of the way from the escape energy to the highest energy with separate exits.
_BELOW_HIGHEST = 0.99
# Smallest span in units of the depth of the well; rounding dominates narrower spans.
_NARROWEST = 1e-9
# Smallest span of a range around critical energies, as a share of their largest magnitude.
_LEAST_SPREAD = 0.25


def energy_range(potential: Potential, highest_energy: float, critical_energies: Sequence[float]) -> EnergyRange:
    """Return a range given by multiples of the depth of the well. With an escape radius, it is around the critical energies.

    Parameters
    ----------
    potential
        The potential.
    highest_energy
        The energy up to which exits are separate.
    critical_energies
        The energies of all critical points.
    """
    if potential.escape_radius is not None:
        return _range_around(potential, np.array(critical_energies or [potential.well.bottom]))
    escape, depth = potential.escape_energy, potential.escape_energy - potential.well.bottom
    span = max(_BELOW_HIGHEST * (highest_energy - escape), _NARROWEST * depth)
    first, high = (
        min(potential.well.energy_at(_FIRST), escape + 0.5 * span),
        min(potential.well.energy_at(HIGHEST_SHOWN), escape + span),
    )
    # Enough decimals to keep the three energies distinct.
    decimals = max(2 - math.floor(math.log10(depth)), 1 - math.floor(math.log10(high - escape)))
    low, first, high = (round(energy, decimals) for energy in (potential.well.energy_at(_LOW), first, high))
    return EnergyRange(low, high, (), first, decimals)


def depth_levels(potential: Potential, multiples: Sequence[float]) -> list[float]:
    """Return energies at multiples of the depth of the well; empty with an escape radius, where the depth is not defined."""
    return [potential.well.energy_at(multiple) for multiple in multiples] if potential.escape_radius is None else []


def _range_around(potential: Potential, energies: np.ndarray) -> EnergyRange:
    """Return energies from below the lowest critical point to above the highest one, where the whole plane is allowed."""
    span = max(float(np.ptp(energies)), _LEAST_SPREAD * float(np.abs(energies).max()), _NARROWEST * potential.units.energy)
    decimals = 2 - math.floor(math.log10(span))
    ends = energies.min() - 0.5 * span, energies.max() + 0.5 * span, np.median(energies)
    low, high, first = (round(float(energy), decimals) for energy in ends)
    return EnergyRange(low, high, (), first, decimals)
