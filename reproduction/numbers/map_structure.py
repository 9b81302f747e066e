"""Measure the structure of basins: starts inside basins, starts next to all basins, escape times near islands and exits."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap, Fate, compute_wada_test

BOUNDARY_PIXELS = 2
"""Largest distance, in pixels, from the boundary of each basin to a start that counts as next to all basins."""

# A start and its eight neighbours.
_NEIGHBOURHOOD = (3, 3)


def neighbouring_fates(fate: np.ndarray, is_counted: np.ndarray, highest_fate: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest and the highest fate among each start and its eight neighbours, without those that are not counted.

    The counted fates are from 0 to `highest_fate`.
    """
    from scipy import ndimage

    lowest = ndimage.minimum_filter(np.where(is_counted, fate, highest_fate), _NEIGHBOURHOOD, mode="nearest")
    return lowest, ndimage.maximum_filter(np.where(is_counted, fate, 0), _NEIGHBOURHOOD, mode="nearest")


def share_in_basins(frame: EscapeMap, *, count_outside: bool = False) -> float:
    """Return the percentage of the starts that escape through the same exit as their eight neighbours.

    Parameters
    ----------
    frame
        A complete map.
    count_outside
        Whether starts outside count as escaped through the exit beyond which they are. Otherwise, they are neither starts nor
        neighbours.
    """
    fate = np.where(frame.fate == Fate.OUTSIDE, frame.outside, frame.fate) if count_outside else frame.fate
    is_counted = fate >= Fate.BOUNDED
    lowest, highest = neighbouring_fates(fate, is_counted, frame.spec.potential.channels)
    return 100.0 * float(np.mean((lowest == highest)[is_counted] & (fate[is_counted] >= 1)))


def share_next_to_all_basins(frame: EscapeMap) -> float:
    """Return the percentage of the starts on a basin boundary that are within `BOUNDARY_PIXELS` of all boundaries.

    The value is 100 for Wada basins, 0 if the basins do not touch, and NaN for fewer than three basins.
    """
    test = compute_wada_test(frame)
    if not test.is_applicable:
        return float("nan")
    return 100.0 * float(test.shares[: BOUNDARY_PIXELS + 1].max(initial=0.0))


def orders_of_escape_times(frame: EscapeMap) -> float:
    """Return log10 of the ratio of median escape times: of neighbours of bounded starts to neighbours of starts outside.

    The value is NaN if there are no such neighbours.

    Parameters
    ----------
    frame
        A complete map on (x, y).
    """
    near_islands, near_exits = (_median_time_next_to(frame, fate) for fate in (Fate.BOUNDED, Fate.OUTSIDE))
    return float(np.log10(near_islands / near_exits))


def _median_time_next_to(frame: EscapeMap, fate: Fate) -> float:
    """Return the median escape time of the neighbours of the starts with a fate."""
    from scipy import ndimage

    is_near = ndimage.binary_dilation(frame.fate == fate, np.ones(_NEIGHBOURHOOD))
    times = frame.escape_time[is_near & (frame.fate >= 1)]
    return float(np.median(times)) if times.size else float("nan")
