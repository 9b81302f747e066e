"""What the paper states, and what we measure in its place.

`compare_all(shelf, hunt)` gives a `Comparison` for each of `STATED_NUMBERS`; `hunt` is what `shelf.hunt()` gives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from engine import CASES, EscapeMap, Fate, Plane, SuperStickySearch, compute_statistics, find_lyapunov_orbits
from reproduction.map_shelf import MapShelf
from reproduction.stated_numbers import STATED_NUMBERS, Quantity, Relation, StatedNumber
from reproduction.unknown_windows import FittedWindow, fit_window

POINTS = 2.0
"""Shares that differ by no more than so many points of percentage agree."""

PERCENT = 2.0
"""Other numbers agree when they differ by no more than so many percent."""

JUDGED_SIDE = 75
"""Columns and rows of the maps of I and II whose bounded orbits are judged: it takes ten times as long as the map itself."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """One number of the paper beside ours.

    Attributes
    ----------
    stated
        What the paper states.
    ours
        What we measure, in the same unit, a value for each of its energies; shares are out of the starts inside. Of Lyapunov
        orbits the smallest and the largest R². NaN where there is none.
    windows
        For each energy the window that comes nearest to what is stated there; empty where none is needed.
    counted
        Our shares in these windows, with starts outside counted.
    """

    stated: StatedNumber
    ours: tuple[float, ...]
    windows: tuple[FittedWindow, ...] = ()
    counted: tuple[float, ...] = ()

    @property
    def difference(self) -> float:
        """Ours less what is stated, where this is largest; 0 where a bound holds, NaN where we have none."""
        return _furthest(self.stated, self.ours)

    @property
    def counted_difference(self) -> float:
        """The same with starts outside counted; NaN where no window is needed."""
        return _furthest(self.stated, self.counted)

    @property
    def agrees(self) -> bool:
        """Whether the difference is within `POINTS`, or `PERCENT` for what is no share."""
        return _small(self.stated, self.difference)

    @property
    def agrees_when_counted(self) -> bool:
        """Whether it is so with starts outside counted."""
        return _small(self.stated, self.counted_difference)


def compare_all(
    shelf: MapShelf, hunt: SuperStickySearch, numbers: tuple[StatedNumber, ...] = STATED_NUMBERS
) -> tuple[Comparison, ...]:
    """Measure all that the paper states.

    Parameters
    ----------
    shelf
        Of the maps.
    hunt
        The super-sticky orbits of case III at h = 0.26.
    numbers
        What to measure.

    Raises
    ------
    concurrent.futures.CancelledError
        When the shelf is stopped.
    """
    bench = _Bench(shelf, hunt, numbers)
    return tuple(bench.compare(number) for number in numbers)


class _Bench:
    """What the measurements share."""

    def __init__(self, shelf: MapShelf, hunt: SuperStickySearch, numbers: tuple[StatedNumber, ...]) -> None:
        self.shelf, self.hunt, self.numbers = shelf, hunt, numbers
        coarse = replace(shelf.quality, resolution=min(shelf.quality.resolution, JUDGED_SIDE))
        self.judged_shelf = MapShelf(coarse, shelf.executor, shelf.cancel)
        self.windows: dict[tuple[str, Plane, float], FittedWindow] = {}

    def compare(self, number: StatedNumber) -> Comparison:
        """Ours beside one number."""
        ours = _MEASURES[number.quantity](self, number)
        if not number.needs_window:
            return Comparison(number, ours)
        windows = tuple(self.window(number, energy) for energy in number.energies)
        return Comparison(number, ours, windows, tuple(window.share(_codes(number)) for window in windows))

    def window(self, number: StatedNumber, energy: float) -> FittedWindow:
        """The window that explains all shares stated of one map."""
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
        """One for each energy."""
        assert number.plane is not None
        return [self.shelf.map(number.case, number.plane, energy) for energy in number.energies]


def _measure_shares(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    shares = [frame.fractions() for frame in bench.maps(number)]
    return tuple(100.0 * sum(share[code] for code in _codes(number)) for share in shares)


def _measure_direct(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    return tuple(100.0 * compute_statistics(frame).direct_share for frame in bench.maps(number))


def _measure_chaotic(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    if number.case == "III":
        return (100.0 * bench.hunt.chaotic_share,)
    assert number.plane is not None
    frames = [bench.judged_shelf.map(number.case, number.plane, energy) for energy in number.energies]
    return tuple(100.0 * bench.judged_shelf.judged(frame).chaotic_share for frame in frames)


def _measure_last_bounded(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    low, high = number.energies
    frame = bench.shelf.map(number.case, Plane.X_H, (low, high))
    # At x = 0 of III a start runs along the y axis, where it stays: one orbit, and no island.
    rows = np.flatnonzero((frame.fate == Fate.BOUNDED)[:, frame.x != 0.0].any(axis=1))
    return (float(frame.ordinate[rows[-1]]) if rows.size else float("nan"),)


def _measure_median_time(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    return tuple(compute_statistics(frame).median_escape_time for frame in bench.maps(number))


def _measure_energy_error(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    assert number.plane is not None
    return (float(bench.shelf.curves(number.case, number.plane)["worst_energy_error"].max()),)


def _measure_escape_energy(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    return (CASES[number.case].escape_energy,)


def _measure_lyapunov_r2(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    orbits = find_lyapunov_orbits(CASES[number.case], number.energies[0])
    r2 = np.concatenate([orbit.x**2 + orbit.y**2 for orbit in orbits])
    return float(r2.min()), float(r2.max())


def _measure_last_leaver(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    leavers = bench.hunt.leavers
    return (float(bench.hunt.escape_time[leavers[-1]]) if leavers.size else float("nan"),)


def _measure_nearest_leaver(bench: _Bench, number: StatedNumber) -> tuple[float, ...]:
    times = bench.hunt.escape_time[np.isin(bench.hunt.fate, number.channels)]
    return (float(times[np.argmin(np.abs(times - number.value))]) if times.size else float("nan"),)


_MEASURES: Mapping[Quantity, Callable[[_Bench, StatedNumber], tuple[float, ...]]] = MappingProxyType(
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
        Quantity.LAST_LEAVER: _measure_last_leaver,
        Quantity.NEAREST_LEAVER: _measure_nearest_leaver,
    }
)


def _codes(number: StatedNumber) -> tuple[int, ...]:
    """The fates that a share is of."""
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
