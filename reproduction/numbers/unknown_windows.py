"""Estimate the windows that the paper does not state.

In the percentages of the paper, starts outside seem to count as immediate escapes through the exit beyond which they lie, so the
percentages depend on the window. `fit_window` finds the window that best explains the stated percentages.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine import EscapeMap, Fate, MapSpec, Window, compute_map
from reproduction.map_cache import MapCache

LARGEST_HALF_SIDE = 3.0
"""Largest half side of a tried window: about three times the half side of the interior."""

STEP = 0.05
"""Step between the half sides of windows."""

# Number of pixels per side. It determines shares of areas to a few tenths of a percentage point.
_SIDE = 400
# Integration time close to 0, because only the positions of starts are needed.
_INSTANT = 1e-9


@dataclass(frozen=True, eq=False)
class FittedWindow:
    """The window that best explains stated percentages.

    Attributes
    ----------
    window
        A square centred on the origin, or a rectangle that differs from such a square only in its right edge.
    outside_share
        Fraction, 0 to 1, of the starts in the window that lie beyond an exit.
    escape_map
        The map of the window.
    """

    window: Window
    outside_share: float
    escape_map: EscapeMap

    @property
    def half_side(self) -> float:
        """Half side: the window extends from −half_side to half_side along both axes, except for its right edge."""
        return self.window.ordinate_high

    def percentage(self, codes: tuple[int, ...]) -> float:
        """Return the percentage of the starts with one of these fates. Starts outside are counted."""
        fractions = self.escape_map.fractions(count_outside=True)
        return 100.0 * sum(fractions[code] for code in codes)


def fit_window(
    cache: MapCache, case: str, interior: EscapeMap, stated: Mapping[tuple[int, ...], float], tolerance: float
) -> FittedWindow:
    """Find the square whose largest difference from the stated percentages is smallest.

    If no square is within the tolerance, the right edge is also fitted, because in case II the interior, and perhaps the paper's
    figures, extend furthest to the right. With more free parameters, any percentages could be fitted. If no such rectangle is
    within the tolerance either, the square is kept.

    Parameters
    ----------
    cache
        Source of the map in the window.
    case
        Key of `engine.CASES`.
    interior
        Map of the interior.
    stated
        Stated percentages, 0 to 100. Each key contains the fates that are counted together: `Fate.BOUNDED` or exits.
    tolerance
        Largest acceptable difference, in percentage points.
    """
    spec = interior.spec
    window = _find_best_window(interior, stated, tolerance)
    escape_map = cache.map(case, spec.plane, spec.energy, window)
    start_count = np.count_nonzero(escape_map.fate != Fate.FORBIDDEN)
    return FittedWindow(window, float(np.count_nonzero(escape_map.fate == Fate.OUTSIDE) / start_count), escape_map)


@dataclass(frozen=True, eq=False)
class _GridStarts:
    """The number of starts inside, and the exit and position of each start outside, on a fine grid."""

    inside: int
    channel: np.ndarray
    x: np.ndarray
    ordinate: np.ndarray

    @classmethod
    def of(cls, spec: MapSpec) -> _GridStarts:
        square = Window(-LARGEST_HALF_SIDE, LARGEST_HALF_SIDE, -LARGEST_HALF_SIDE, LARGEST_HALF_SIDE)
        frame = compute_map(replace(spec, resolution=(_SIDE, _SIDE), window=square, t_max=_INSTANT, use_evidence=False))
        rows, columns = np.nonzero(frame.fate == Fate.OUTSIDE)
        channel = frame.outside[rows, columns].astype(np.intp)
        return cls(int(np.count_nonzero(frame.interior)), channel, frame.x[columns], frame.ordinate[rows])

    def count(self, window: Window) -> np.ndarray:
        """Return the number of starts in a window beyond each exit, indexed by exit up to the last with starts. Entry 0 is 0."""
        contained = (self.x >= window.x_low) & (self.x <= window.x_high) & (np.abs(self.ordinate) <= window.ordinate_high)
        return np.bincount(self.channel[contained], minlength=int(self.channel.max(initial=0)) + 1)


def _multiples_of_step(least: float) -> list[float]:
    """Return the multiples of `STEP` between `least` and `LARGEST_HALF_SIDE`."""
    steps = np.arange(np.ceil(least / STEP), round(LARGEST_HALF_SIDE / STEP) + 1)
    return (STEP * steps).round(6).tolist()


def _find_best_window(interior: EscapeMap, stated: Mapping[tuple[int, ...], float], tolerance: float) -> Window:
    """Return the window that `fit_window` describes. All tried windows contain the window of the interior."""
    inner = interior.spec.find_window()
    starts = _GridStarts.of(interior.spec)
    fractions = interior.fractions()
    half_sides = _multiples_of_step(max(-inner.x_low, inner.x_high, -inner.ordinate_low, inner.ordinate_high))
    squares = [Window(-side, side, -side, side) for side in half_sides]
    square, difference = _best_window(squares, starts, fractions, stated)
    if difference <= tolerance:
        return square
    # The right edge varies separately, so it does not limit the half sides.
    half_sides = _multiples_of_step(max(-inner.x_low, -inner.ordinate_low, inner.ordinate_high))
    right_edges = _multiples_of_step(inner.x_high)
    rectangles = [Window(-side, right, -side, side) for side in half_sides for right in right_edges]
    rectangle, difference = _best_window(rectangles, starts, fractions, stated)
    return rectangle if difference <= tolerance else square


def _best_window(
    windows: Sequence[Window], starts: _GridStarts, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> tuple[Window, float]:
    """Return the window whose largest difference is smallest, and this difference."""
    differences = [_largest_difference(starts.count(window), starts.inside, fractions, stated) for window in windows]
    index = int(np.argmin(differences))
    return windows[index], differences[index]


def _largest_difference(
    outside_counts: np.ndarray, inside: int, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> float:
    """Return the largest difference from the stated percentages, given the numbers of starts outside, by exit, and inside."""
    total = inside + outside_counts.sum()

    def percentage(code: int) -> float:
        outside_count = outside_counts[code] if 0 < code < outside_counts.size else 0
        return float(100.0 * (inside * fractions[code] + outside_count) / total)

    return max(abs(sum(map(percentage, codes)) - value) for codes, value in stated.items())
