"""Measure complete maps for the comparison with the papers: shares, escape times by region, exponents of boundaries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import EscapeMap, Fate, compute_uncertainty_exponent
from reproduction.numbers.map_structure import neighbouring_fates

ISLAND_PIXELS = 2
"""Largest distance, in pixels, from a bounded start to a start that counts as next to an island."""

LATE = 0.01
"""Share of the escaping orbits that count as late."""

# Limit of the total integration time of the pairs of starts of an exponent, in time units of the well.
_WORK = 1e7


@dataclass(frozen=True)
class EndTimes:
    """Median times to the end of orbits; NaN if there are none.

    Attributes
    ----------
    inside
        For starts whose eight neighbours have the same outcome.
    at_boundary
        For starts next to a start with another outcome, but not next to a bounded start.
    """

    inside: float
    at_boundary: float


def outcome_share(frame: EscapeMap, *codes: int) -> float:
    """Return the percentage of the interior starts with one of these fates."""
    fractions = frame.fractions()
    return 100.0 * sum(fractions[code] for code in codes)


def bounded_share_beside(frame: EscapeMap, sign: int) -> float:
    """Return the percentage of the interior starts with x of this sign, 1 or −1, whose orbits are bounded."""
    has_sign = frame.interior & (sign * frame.x > 0.0)
    return 100.0 * float(np.mean(frame.fate[has_sign] == Fate.BOUNDED))


def end_times(frame: EscapeMap) -> EndTimes:
    """Return the median times to the end inside basins and at their boundaries."""
    fate = frame.fate
    lowest, highest = neighbouring_fates(fate, frame.interior, len(frame.spec.outcomes))
    has_ended = (fate > Fate.BOUNDED) & (lowest > Fate.BOUNDED)
    regions = (lowest == highest, lowest < highest)
    times = [frame.escape_time[has_ended & region] for region in regions]
    return EndTimes(*(float(np.median(each)) if each.size else float("nan") for each in times))


def share_next_to_islands(frame: EscapeMap, *, late: bool) -> float:
    """Return the percentage of ending orbits, or of late ones, whose starts are within `ISLAND_PIXELS` of a bounded start."""
    from scipy import ndimage

    is_near_island = ndimage.distance_transform_edt(frame.fate != Fate.BOUNDED) <= ISLAND_PIXELS
    has_ended = frame.fate > Fate.BOUNDED
    if late:
        has_ended &= frame.escape_time >= np.quantile(frame.escape_time[has_ended], 1.0 - LATE)
    return 100.0 * float(np.mean(is_near_island[has_ended]))


def boundary_exponent(frame: EscapeMap) -> float:
    """Return the uncertainty exponent of the boundaries, 1 if they are smooth; NaN if too few starts are uncertain."""
    return compute_uncertainty_exponent(frame.spec, work=_WORK, rng=0).exponent
