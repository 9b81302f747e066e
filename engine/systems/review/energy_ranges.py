"""Energies to explore, for any potential."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from engine.systems.catalogue.entry import EnergyRange
from engine.systems.potential import Potential

HIGHEST_SHOWN = 4.0
"""Upper end of a range, in depths of the well above its bottom, unless exits merge at a lower energy."""

# Lower end of a range, in depths of the well above its bottom.
_LOW = 0.8
# Energy shown first, in depths of the well above its bottom.
_FIRST = 1.5
# Upper limit of a range, as a share of the way from the escape energy to the highest energy with separate exits.
_BELOW_HIGHEST = 0.99
# Smallest span of a range, in units of the depth of the well. Rounding dominates narrower spans.
_NARROWEST = 1e-9
# Smallest span of a range around critical energies, as a share of their largest magnitude.
_LEAST_SPREAD = 0.25


def energy_range(potential: Potential, highest_energy: float, critical_energies: Sequence[float]) -> EnergyRange:
    """Return a range of energies around the escape energy; with an escape radius, around the critical energies.

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
    escape = potential.escape_energy
    depth = escape - potential.well.bottom
    span = max(_BELOW_HIGHEST * (highest_energy - escape), _NARROWEST * depth)
    low = potential.well.energy_at(_LOW)
    first = min(potential.well.energy_at(_FIRST), escape + 0.5 * span)
    high = min(potential.well.energy_at(HIGHEST_SHOWN), escape + span)
    # Enough decimals to keep the three energies distinct.
    decimals = max(2 - math.floor(math.log10(depth)), 1 - math.floor(math.log10(high - escape)))
    return EnergyRange(round(low, decimals), round(high, decimals), (), round(first, decimals), decimals)


def depth_levels(potential: Potential, multiples: Sequence[float]) -> list[float]:
    """Return energies at multiples of the depth of the well; empty with an escape radius, where the depth is not defined."""
    return [potential.well.energy_at(multiple) for multiple in multiples] if potential.escape_radius is None else []


def _range_around(potential: Potential, energies: np.ndarray) -> EnergyRange:
    """Return a range from below the lowest critical energy to above the highest, where no part of the plane is forbidden."""
    span = max(float(np.ptp(energies)), _LEAST_SPREAD * float(np.abs(energies).max()), _NARROWEST * potential.units.energy)
    decimals = 2 - math.floor(math.log10(span))
    exact_energies = energies.min() - 0.5 * span, energies.max() + 0.5 * span, np.median(energies)
    low, high, first = (round(float(energy), decimals) for energy in exact_energies)
    return EnergyRange(low, high, (), first, decimals)
