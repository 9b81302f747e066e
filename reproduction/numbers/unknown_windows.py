"""Estimate the windows that the paper does not state.

Starts outside count as immediate escapes through the exit beyond which they lie, so their number depends on the window.
`fit_window` finds the square centred on the origin that best explains the stated percentages.
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
        A square centred on the origin, or such a square with another right edge.
    outside_share
        Share of the starts in the window that lie beyond an exit.
    counted
        The map of the window, whose percentages are computed with `count_outside`.
    """

    window: Window
    outside_share: float
    counted: EscapeMap

    @property
    def half_side(self) -> float:
        """Half side: the window extends from −half_side to half_side along both axes, except for its right edge."""
        return self.window.ordinate_high

    def share(self, codes: tuple[int, ...]) -> float:
        """Return the percentage of the starts with one of these fates, with starts outside counted."""
        fractions = self.counted.fractions(count_outside=True)
        return 100.0 * sum(fractions[code] for code in codes)


def fit_window(
    cache: MapCache, case: str, interior: EscapeMap, stated: Mapping[tuple[int, ...], float], enough: float
) -> FittedWindow:
    """Find the square with the smallest maximal difference from the stated percentages.

    If no square is good enough, the right edge is also fitted, because in II the interior, and perhaps the paper's figures,
    extend furthest to the right. With more free parameters, any percentages could be fitted.

    Parameters
    ----------
    cache
        Source of the map in the window.
    case
        Key of `engine.CASES`.
    interior
        Map of the interior.
    stated
        Percentages, by the fates that they count: `Fate.BOUNDED` or exits.
    enough
        Largest acceptable difference, in percentage points.
    """
    spec = interior.spec
    outside = _Outside.of(spec)
    inner = spec.find_window()
    half_sides = _edges(max(-inner.x_low, inner.x_high, -inner.ordinate_low, inner.ordinate_high))
    squares = [Window(-side, side, -side, side) for side in half_sides]
    best_window, difference = _best(squares, outside, interior.fractions(), stated)
    if difference > enough:
        # The right edge is a parameter of its own.
        least_half_side = max(-inner.x_low, -inner.ordinate_low, inner.ordinate_high)
        right_edges = _edges(inner.x_high)
        rectangles = [Window(-side, right, -side, side) for side in _edges(least_half_side) for right in right_edges]
        best_rectangle, difference = _best(rectangles, outside, interior.fractions(), stated)
        if difference <= enough:
            best_window = best_rectangle
    counted = cache.map(case, spec.plane, spec.energy, best_window)
    start_count = np.count_nonzero(counted.fate != Fate.FORBIDDEN)
    return FittedWindow(best_window, float(np.count_nonzero(counted.fate == Fate.OUTSIDE) / start_count), counted)


@dataclass(frozen=True, eq=False)
class _Outside:
    """The number of starts inside, and the exit and position of each start outside, on a fine grid."""

    inside: int
    channel: np.ndarray
    x: np.ndarray
    ordinate: np.ndarray

    @classmethod
    def of(cls, spec: MapSpec) -> _Outside:
        square = Window(-LARGEST_HALF_SIDE, LARGEST_HALF_SIDE, -LARGEST_HALF_SIDE, LARGEST_HALF_SIDE)
        frame = compute_map(replace(spec, resolution=(_SIDE, _SIDE), window=square, t_max=_INSTANT, use_evidence=False))
        rows, columns = np.nonzero(frame.fate == Fate.OUTSIDE)
        channel = frame.outside[rows, columns].astype(np.intp)
        return cls(int(np.count_nonzero(frame.interior)), channel, frame.x[columns], frame.ordinate[rows])

    def count(self, window: Window) -> np.ndarray:
        """Return how many starts of a window lie beyond each exit, of shape (exits + 1,). Entry 0 is 0."""
        contained = (self.x >= window.x_low) & (self.x <= window.x_high) & (np.abs(self.ordinate) <= window.ordinate_high)
        return np.bincount(self.channel[contained], minlength=int(self.channel.max(initial=0)) + 1)


def _edges(least: float) -> list[float]:
    """Return the multiples of `STEP` from the first that is at least `least` to `LARGEST_HALF_SIDE`."""
    steps = np.arange(np.ceil(least / STEP), round(LARGEST_HALF_SIDE / STEP) + 1)
    return (STEP * steps).round(6).tolist()


def _best(
    windows: Sequence[Window], outside: _Outside, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> tuple[Window, float]:
    """Return the window with the smallest maximal difference, and this difference."""
    differences = [_largest_difference(outside.count(window), outside.inside, fractions, stated) for window in windows]
    index = int(np.argmin(differences))
    return windows[index], differences[index]


def _largest_difference(
    outside: np.ndarray, inside: int, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> float:
    """Return the largest difference of percentages from the stated ones. `outside` contains the numbers of starts by exit."""
    total = inside + outside.sum()

    def share(code: int) -> float:
        outside_count = outside[code] if 0 < code < outside.size else 0
        return float(100.0 * (inside * fractions[code] + outside_count) / total)

    return max(abs(sum(map(share, codes)) - value) for codes, value in stated.items())
