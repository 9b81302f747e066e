"""Compare the numbers stated in the paper with computed numbers.

`compare_all(cache, search)` returns a `Comparison` for each of `STATED_NUMBERS`; `search` is `cache.super_sticky()`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from engine import Plane
from reproduction.map_cache import MapCache
from reproduction.numbers.map_structure import share_in_basins
from reproduction.numbers.measures import ComputedNumbers, counted_codes
from reproduction.numbers.reasons import explain
from reproduction.numbers.stated_numbers import STATED_NUMBERS, Quantity, Relation, StatedNumber
from reproduction.numbers.unknown_windows import FittedWindow, fit_window
from reproduction.super_sticky import SuperStickySearch

POINTS = 2.0
"""Largest difference of shares that agree, in percentage points."""

PERCENT = 2.0
"""Largest difference of other numbers that agree, in percent."""

# Quantities whose stated values determine the window.
_WINDOW_QUANTITIES = (Quantity.ESCAPED_BY, Quantity.BOUNDED)


@dataclass(frozen=True, eq=False)
class Comparison:
    """A number of the paper and its computed values.

    Attributes
    ----------
    stated
        The number in the paper.
    computed
        Computed values in the unit of the paper, one for each energy; for Lyapunov orbits, the smallest and the largest R².
        Shares are relative to the starts inside. A missing value is NaN.
    windows
        For each energy, the window that best explains the stated shares; empty if the number needs no window.
    counted_shares
        Computed shares in these windows, with starts outside counted.
    reason
        Reason for a difference.
    """

    stated: StatedNumber
    computed: tuple[float, ...]
    windows: tuple[FittedWindow, ...] = ()
    counted_shares: tuple[float, ...] = ()
    reason: str = ""

    @property
    def difference(self) -> float:
        """The largest difference computed − stated; 0 if a stated bound holds, NaN without a value.

        For `RISES_TO`, it is the difference at the last energy.
        """
        return _largest_difference(self.stated, self.computed)

    @property
    def counted_difference(self) -> float:
        """Largest difference when starts outside count; NaN if the number needs no window."""
        return _largest_difference(self.stated, self.counted_shares)

    @property
    def agrees(self) -> bool:
        """Whether the difference is within `POINTS` for shares, or `PERCENT` for other numbers."""
        return _is_small(self.stated, self.difference)

    @property
    def agrees_when_counted(self) -> bool:
        """Whether the difference is within the limits of `agrees` when starts outside count."""
        return _is_small(self.stated, self.counted_difference)


def compare_all(
    cache: MapCache, search: SuperStickySearch, numbers: tuple[StatedNumber, ...] = STATED_NUMBERS
) -> tuple[Comparison, ...]:
    """Compare all numbers that the paper states with computed numbers.

    Parameters
    ----------
    cache
        Source of the maps.
    search
        Search for super-sticky orbits of case III at h = 0.26.
    numbers
        Numbers to compute.

    Raises
    ------
    concurrent.futures.CancelledError
        If the cache is cancelled.
    """
    computed_numbers = ComputedNumbers(cache, search)
    windows = _Windows(cache, numbers)
    return tuple(_compare(number, computed_numbers, windows) for number in numbers)


def _compare(number: StatedNumber, computed_numbers: ComputedNumbers, windows: _Windows) -> Comparison:
    """Compare one number. The reason is computed only if there is a difference."""
    fitted_windows = tuple(windows.fit(number, energy) for energy in number.energies) if number.needs_window else ()
    counted_shares = tuple(_count(number, window) for window in fitted_windows)
    row = Comparison(number, computed_numbers.values(number), fitted_windows, counted_shares)
    return row if row.agrees else replace(row, reason=explain(computed_numbers, number))


def _count(number: StatedNumber, window: FittedWindow) -> float:
    """Return a share in a window, with starts outside counted."""
    if number.quantity is Quantity.IN_BASINS:
        return share_in_basins(window.escape_map, count_outside=True)
    return window.percentage(counted_codes(number))


class _Windows:
    """Fits, for each map, the window that explains the stated shares."""

    def __init__(self, cache: MapCache, numbers: tuple[StatedNumber, ...]) -> None:
        self.cache = cache
        self.window_numbers = [number for number in numbers if number.needs_window and number.quantity in _WINDOW_QUANTITIES]
        self.windows: dict[tuple[str, Plane, float], FittedWindow] = {}

    def fit(self, number: StatedNumber, energy: float) -> FittedWindow:
        """Return the window that explains all shares of exits and bounded starts stated for one map."""
        assert number.plane is not None
        key = (number.case, number.plane, energy)
        if key not in self.windows:
            stated = {
                counted_codes(other): other.value
                for other in self.window_numbers
                if (other.case, other.plane) == (number.case, number.plane) and energy in other.energies
            }
            self.windows[key] = fit_window(self.cache, number.case, self.cache.map(*key), stated, POINTS)
        return self.windows[key]


def _largest_difference(stated: StatedNumber, values: tuple[float, ...]) -> float:
    # A quantity that rises to the stated value must reach it only at the last energy.
    compared_values = np.array(values[-1:] if stated.relation is Relation.RISES_TO else values)
    differences = compared_values[~np.isnan(compared_values)] - stated.value
    if not differences.size:
        return float("nan")
    if stated.relation is Relation.MORE_THAN:
        differences = np.minimum(differences, 0.0)
    elif stated.relation is Relation.LESS_THAN:
        differences = np.maximum(differences, 0.0)
    return float(differences[np.argmax(np.abs(differences))])


def _is_small(stated: StatedNumber, difference: float) -> bool:
    return abs(difference) <= (POINTS if stated.is_share else PERCENT / 100.0 * stated.value)
