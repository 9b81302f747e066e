"""Ranges of energies to explore, derived from any potential."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from engine.systems.catalogue.entry import EnergyRange
from engine.systems.potential import Potential

HIGHEST_SHOWN = 4.0
"""Upper end of a range, in depths of the well above its bottom. It is lower if exits merge at a lower energy."""

# Lower end of a range, in depths of the well above its bottom.
_LOWEST_SHOWN = 0.8
# Energy shown first, in depths of the well above its bottom.
_FIRST_SHOWN = 1.5
# Upper limit of a range, as a share of the way from the escape energy to the highest energy with separate exits.
_SEPARATE_SHARE = 0.99
# Lower end, energy shown first and upper end of a range in a closed well, as shares of its span above the bottom.
_CLOSED_SHARES = (0.05, 0.25, 1.0)
# Largest span of this range, as a share of the height up to which the well is closed.
_CLOSED_SHARE = 0.99
# Smallest span of a range, in depths of the well or, with an escape radius, in units of energy of the well. Rounding dominates
# narrower spans.
_SMALLEST_SPAN = 1e-9
# Smallest span of a range around critical energies, as a share of their largest magnitude.
_SMALLEST_RELATIVE_SPAN = 0.25


def energy_range(
    potential: Potential, highest_energy: float, closed_energy: float, critical_energies: Sequence[float]
) -> EnergyRange:
    """Return a range of energies around the escape energy; with an escape radius, around the critical energies.

    In a well without exits, the range is below the energy up to which the well is closed.

    Parameters
    ----------
    potential
        The potential.
    highest_energy
        The energy up to which exits are separate; infinite if they do not merge.
    closed_energy
        The energy up to which the well is shown to be closed.
    critical_energies
        The energies of all critical points.
    """
    if not potential.escapes_over_saddles:
        return _range_around(potential, np.array(critical_energies or [potential.well.bottom]))
    if not potential.channels:
        return _closed_range(potential, closed_energy, critical_energies)
    escape = potential.escape_energy
    depth = escape - potential.well.bottom
    span = max(_SEPARATE_SHARE * (highest_energy - escape), _SMALLEST_SPAN * depth)
    low = potential.well.energy_at(_LOWEST_SHOWN)
    first = min(potential.well.energy_at(_FIRST_SHOWN), escape + 0.5 * span)
    high = min(potential.well.energy_at(HIGHEST_SHOWN), escape + span)
    # These decimals keep the three energies distinct.
    decimals = max(2 - math.floor(math.log10(depth)), 1 - math.floor(math.log10(high - escape)))
    return EnergyRange(round(low, decimals), round(high, decimals), (), round(first, decimals), decimals)


def depth_levels(potential: Potential, multiples: Sequence[float]) -> list[float]:
    """Return energies at multiples of the depth of the well; empty with an escape radius, where the depth is not defined."""
    return [potential.well.energy_at(multiple) for multiple in multiples] if potential.escapes_over_saddles else []


def _closed_range(potential: Potential, closed_energy: float, critical_energies: Sequence[float]) -> EnergyRange:
    """Return a range above the bottom of a well without exits, beyond its critical energies as far as it is closed."""
    bottom = potential.well.bottom
    height = max(critical_energies, default=bottom) - bottom or potential.units.energy
    span = min(HIGHEST_SHOWN * height, _CLOSED_SHARE * (closed_energy - bottom))
    low, first, high = (bottom + share * span for share in _CLOSED_SHARES)
    decimals = 2 - math.floor(math.log10(span))
    return EnergyRange(round(low, decimals), round(high, decimals), (), round(first, decimals), decimals)


def _range_around(potential: Potential, energies: np.ndarray) -> EnergyRange:
    """Return a range from below the lowest critical energy to above the highest, where no part of the plane is forbidden."""
    span = max(
        float(np.ptp(energies)), _SMALLEST_RELATIVE_SPAN * float(np.abs(energies).max()), _SMALLEST_SPAN * potential.units.energy
    )
    decimals = 2 - math.floor(math.log10(span))
    exact_energies = energies.min() - 0.5 * span, energies.max() + 0.5 * span, np.median(energies)
    low, high, first = (round(float(energy), decimals) for energy in exact_energies)
    return EnergyRange(low, high, (), first, decimals)
