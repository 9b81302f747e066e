"""Which window would explain percentages whose window is not stated.

Starts outside count as escaped at once through the channel they lie in; how many there are, the window decides. The paper's text
gives none, so we look for the square about the origin that comes nearest to what it states.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine import EscapeMap, Fate, MapSpec, Window, compute_map
from reproduction.map_shelf import MapShelf

LARGEST_HALF_SIDE = 3.0
"""Of the windows tried: some three times as wide as the interior."""

STEP = 0.05
"""From one window to the next."""

# Fine enough for shares of areas to a few tenths of a point.
_SIDE = 400
# So short that no orbit goes anywhere: what is wanted is where starts lie.
_INSTANT = 1e-9


@dataclass(frozen=True, eq=False)
class FittedWindow:
    """The window that explains stated percentages best.

    Attributes
    ----------
    window
        The window; a square about the origin, or one whose right edge is moved.
    outside_share
        Share of its starts that lie outside.
    counted
        The map in it; its percentages are those with `count_outside`.
    """

    window: Window
    outside_share: float
    counted: EscapeMap

    @property
    def half_side(self) -> float:
        """It reaches from −half_side to half_side along both axes, but for the right edge."""
        return self.window.ordinate_high

    def share(self, codes: tuple[int, ...]) -> float:
        """Percentage of the starts with one of these fates, outside ones counted."""
        fractions = self.counted.fractions(count_outside=True)
        return 100.0 * sum(fractions[code] for code in codes)


def fit_window(
    shelf: MapShelf, case: str, interior: EscapeMap, stated: Mapping[tuple[int, ...], float], enough: float
) -> FittedWindow:
    """Find the square for which the largest difference from what is stated is least.

    Where that is not good enough, the right edge may lie elsewhere: in II the interior reaches furthest to the right, and so may
    the paper's pictures. More freedom than this would explain anything.

    Parameters
    ----------
    shelf
        Gives the map in the window.
    case
        Of `engine.CASES`.
    interior
        The map of the interior at this energy, on this plane.
    stated
        Percentages by the fates that they are of, `Fate.BOUNDED` or channels.
    enough
        The largest difference, in points, with which a square is good enough; also what another window must reach.
    """
    outside, spec = _Outside.found(interior.spec), interior.spec
    sides = _edges(max(-spec.window.x_low, spec.window.x_high, -spec.window.ordinate_low, spec.window.ordinate_high))
    squares = [Window(-side, side, -side, side) for side in sides]
    best, difference = _best(squares, outside, interior.fractions(), stated)
    if difference > enough:
        least = max(-spec.window.x_low, -spec.window.ordinate_low, spec.window.ordinate_high)
        moved = [Window(-side, right, -side, side) for side in _edges(least) for right in _edges(spec.window.x_high)]
        other, smaller = _best(moved, outside, interior.fractions(), stated)
        best = other if smaller <= enough else best
    counted = shelf.map(case, spec.plane, spec.energy, best)
    exists = np.count_nonzero(counted.fate != Fate.FORBIDDEN)
    return FittedWindow(best, float(np.count_nonzero(counted.fate == Fate.OUTSIDE) / exists), counted)


@dataclass(frozen=True, eq=False)
class _Outside:
    """On a fine grid: how many starts lie inside, and of each that lies outside the channel and the place."""

    inside: int
    channel: np.ndarray
    x: np.ndarray
    ordinate: np.ndarray

    @classmethod
    def found(cls, spec: MapSpec) -> _Outside:
        square = Window(-LARGEST_HALF_SIDE, LARGEST_HALF_SIDE, -LARGEST_HALF_SIDE, LARGEST_HALF_SIDE)
        wide = compute_map(replace(spec, resolution=(_SIDE, _SIDE), window=square, t_max=_INSTANT, certify=False))
        rows, columns = np.nonzero(wide.fate == Fate.OUTSIDE)
        channel = wide.outside[rows, columns].astype(np.intp)
        return cls(int(np.count_nonzero(wide.interior)), channel, wide.x[columns], wide.ordinate[rows])

    def count(self, window: Window) -> np.ndarray:
        """(channels + 1,) how many of them lie in a window, by channel; entry 0 is 0."""
        held = (self.x >= window.x_low) & (self.x <= window.x_high) & (np.abs(self.ordinate) <= window.ordinate_high)
        counts: np.ndarray = np.bincount(self.channel[held], minlength=int(self.channel.max(initial=0)) + 1)
        return counts


def _edges(least: float) -> list[float]:
    """From the first step that holds the interior on."""
    steps = np.arange(np.ceil(least / STEP), round(LARGEST_HALF_SIDE / STEP) + 1)
    edges: list[float] = (STEP * steps).round(6).tolist()
    return edges


def _best(
    windows: Sequence[Window], outside: _Outside, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> tuple[Window, float]:
    """The window with the least largest difference, and this."""
    differences = [_largest_difference(outside.count(window), outside.inside, fractions, stated) for window in windows]
    place = int(np.argmin(differences))
    return windows[place], differences[place]


def _largest_difference(
    outside: np.ndarray, inside: int, fractions: Mapping[int, float], stated: Mapping[tuple[int, ...], float]
) -> float:
    whole = inside + outside.sum()

    def share(code: int) -> float:
        beyond = outside[code] if 0 < code < outside.size else 0
        return float(100.0 * (inside * fractions[code] + beyond) / whole)

    return max(abs(sum(map(share, codes)) - value) for codes, value in stated.items())
