"""Comparison of the numbers stated in the paper with computed ones.

`compare_all(shelf, search)` returns a `Comparison` for each of `STATED_NUMBERS`; `search` is `shelf.super_sticky()`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from engine import CASES, EscapeMap, Fate, Plane, compute_statistics, find_lyapunov_orbits
from engine.service import SuperStickySearch
from reproduction.map_shelf import MapShelf
from reproduction.stated_numbers import STATED_NUMBERS, Quantity, Relation, StatedNumber
from reproduction.unknown_windows import FittedWindow, fit_window

POINTS = 2.0
"""Largest difference of shares that agree, in percentage points."""

PERCENT = 2.0
"""Largest relative difference of other numbers that agree, in percent."""

CLASSIFIED_SIDE = 74
"""Columns and rows of the maps of I and II whose bounded orbits are classified: this takes ten times as long as the map."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """One number of the paper with the computed one.

    Attributes
    ----------
    stated
        The number in the paper.
    computed
        Computed values in the same unit, one per energy; shares are relative to the starts inside. For Lyapunov orbits the
        smallest and the largest R². NaN if there is no value.
    windows
        For each energy the window that best explains the stated shares; empty if the number needs no window.
    counted
        Computed shares in these windows, with starts outside counted.
    """

    stated: StatedNumber
    computed: tuple[float, ...]
    windows: tuple[FittedWindow, ...] = ()
    counted: tuple[float, ...] = ()

    @property
    def difference(self) -> float:
        """Largest difference computed − stated; 0 if a stated bound holds, NaN without a computed value."""
        return _furthest(self.stated, self.computed)

    @property
    def counted_difference(self) -> float:
        """The same with starts outside counted; NaN if the number needs no window."""
        return _furthest(self.stated, self.counted)

    @property
    def agrees(self) -> bool:
        """Whether the difference is within `POINTS` for shares, or `PERCENT` for other numbers."""
        return _small(self.stated, self.difference)

    @property
    def agrees_when_counted(self) -> bool:
        """The same with starts outside counted."""
        return _small(self.stated, self.counted_difference)


def compare_all(
    shelf: MapShelf, search: SuperStickySearch, numbers: tuple[StatedNumber, ...] = STATED_NUMBERS
) -> tuple[Comparison, ...]:
    """Compute all numbers that the paper states.

    Parameters
    ----------
    shelf
        Source of the maps.
    search
        Search for super-sticky orbits of case III at h = 0.26.
    numbers
        Numbers to compute.

    Raises
    ------
    concurrent.futures.CancelledError
        If the shelf is cancelled.
    """
    context = _Context(shelf, search, numbers)
    return tuple(context.compare(number) for number in numbers)


class _Context:
    """Data shared by the comparisons."""

    def __init__(self, shelf: MapShelf, search: SuperStickySearch, numbers: tuple[StatedNumber, ...]) -> None:
        self.shelf, self.search, self.numbers = shelf, search, numbers
        coarse = replace(shelf.quality, resolution=min(shelf.quality.resolution, CLASSIFIED_SIDE))
        self.classified_shelf = MapShelf(coarse, shelf.executor, shelf.cancel)
        self.windows: dict[tuple[str, Plane, float], FittedWindow] = {}

    def compare(self, number: StatedNumber) -> Comparison:
        """Compare one number."""
        computed = _MEASURES[number.quantity](self, number)
        if not number.needs_window:
            return Comparison(number, computed)
        windows = tuple(self.window(number, energy) for energy in number.energies)
        return Comparison(number, computed, windows, tuple(window.share(_codes(number)) for window in windows))

    def window(self, number: StatedNumber, energy: float) -> FittedWindow:
        """Window that explains all shares stated for one map."""
        assert number.plane is not None
        key = (number.case, number.plane, energy)
        if key not in self.windows:
            stated = {
                _codes(other): other.value
                for other in self.numbers
                if other.needs_window and (other.case, other.plane) == key[:2] and energy in other.energies
            }
            self.windows[key] = fit_window(self.shelf, number.case, self.shelf.map(*key), stated, POINTS)
        return self.windows[key]

    def maps(self, number: StatedNumber) -> list[EscapeMap]:
        """Maps of a number, one per energy."""
        assert number.plane is not None
        return [self.shelf.map(number.case, number.plane, energy) for energy in number.energies]


def _measure_shares(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    shares = [frame.fractions() for frame in context.maps(number)]
    return tuple(100.0 * sum(share[code] for code in _codes(number)) for share in shares)


def _measure_direct(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    return tuple(100.0 * compute_statistics(frame).direct_share for frame in context.maps(number))


def _measure_chaotic(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    if number.case == "III":
        return (100.0 * context.search.chaotic_share,)
    assert number.plane is not None
    frames = [context.classified_shelf.map(number.case, number.plane, energy) for energy in number.energies]
    return tuple(100.0 * context.classified_shelf.regularity(frame).chaotic_share for frame in frames)


def _measure_last_bounded(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    low, high = number.energies
    frame = context.shelf.map(number.case, Plane.X_H, (low, high))
    # In III the orbit from x = 0 stays on the y axis: it is bounded, but not part of an island.
    rows = np.flatnonzero((frame.fate == Fate.BOUNDED)[:, frame.x != 0.0].any(axis=1))
    return (float(frame.ordinate[rows[-1]]) if rows.size else float("nan"),)


def _measure_median_time(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    return tuple(compute_statistics(frame).median_escape_time for frame in context.maps(number))


def _measure_energy_error(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    assert number.plane is not None
    return (float(context.shelf.curves(number.case, number.plane)["worst_energy_error"].max()),)


def _measure_escape_energy(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    return (CASES[number.case].escape_energy,)


def _measure_lyapunov_r2(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    orbits = find_lyapunov_orbits(CASES[number.case], number.energies[0])
    r2 = np.concatenate([orbit.x**2 + orbit.y**2 for orbit in orbits])
    return float(r2.min()), float(r2.max())


def _measure_last_escape(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    escapers = context.search.escapers
    return (float(context.search.escape_time[escapers[-1]]) if escapers.size else float("nan"),)


def _measure_nearest_escape(context: _Context, number: StatedNumber) -> tuple[float, ...]:
    times = context.search.escape_time[np.isin(context.search.fate, number.channels)]
    return (float(times[np.argmin(np.abs(times - number.value))]) if times.size else float("nan"),)


_MEASURES: Mapping[Quantity, Callable[[_Context, StatedNumber], tuple[float, ...]]] = MappingProxyType(
    {
        Quantity.ESCAPED_BY: _measure_shares,
        Quantity.BOUNDED: _measure_shares,
        Quantity.ESCAPED: _measure_shares,
        Quantity.DIRECT: _measure_direct,
        Quantity.CHAOTIC: _measure_chaotic,
        Quantity.LAST_BOUNDED_ENERGY: _measure_last_bounded,
        Quantity.MEDIAN_ESCAPE_TIME: _measure_median_time,
        Quantity.ENERGY_ERROR: _measure_energy_error,
        Quantity.ESCAPE_ENERGY: _measure_escape_energy,
        Quantity.LYAPUNOV_R2: _measure_lyapunov_r2,
        Quantity.LAST_ESCAPE: _measure_last_escape,
        Quantity.NEAREST_ESCAPE: _measure_nearest_escape,
    }
)


def _codes(number: StatedNumber) -> tuple[int, ...]:
    """Fates that a share counts."""
    if number.quantity is Quantity.BOUNDED:
        return (int(Fate.BOUNDED),)
    return number.channels or tuple(range(1, CASES[number.case].channels + 1))


def _furthest(stated: StatedNumber, values: tuple[float, ...]) -> float:
    differences = np.array(values) - stated.value
    if not differences.size or np.isnan(differences).any():
        return float("nan")
    if stated.relation is Relation.MORE_THAN:
        differences = np.minimum(differences, 0.0)
    elif stated.relation is Relation.LESS_THAN:
        differences = np.maximum(differences, 0.0)
    return float(differences[np.argmax(np.abs(differences))])


def _small(stated: StatedNumber, difference: float) -> bool:
    return abs(difference) <= (POINTS if stated.is_share else PERCENT / 100.0 * stated.value)
