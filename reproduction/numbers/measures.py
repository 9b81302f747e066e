"""Compute the quantities for which the paper states numbers, with `ComputedNumbers(cache, search).values(number)`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from engine import CASES, EscapeMap, Fate, Plane, compute_statistics
from reproduction.map_cache import MapCache
from reproduction.numbers.map_structure import orders_of_escape_times, share_in_basins, share_next_to_all_basins
from reproduction.numbers.stated_numbers import Quantity, StatedNumber
from reproduction.paper_ranges import STICKY_CASE, plane_energies
from reproduction.sample_orbits import find_lyapunov_r2
from reproduction.super_sticky import SuperStickySearch

ACCURATE_ENERGY_ERROR = 1e-11
"""Largest relative energy error of most orbits of the paper."""


class ComputedNumbers:
    """Computes numbers from maps and searches.

    Parameters
    ----------
    cache
        Source of the maps.
    search
        Search for super-sticky orbits of case III at h = 0.26.
    """

    def __init__(self, cache: MapCache, search: SuperStickySearch) -> None:
        self.cache, self.search = cache, search

    def values(self, number: StatedNumber) -> tuple[float, ...]:
        """Return the computed values in the unit of the stated value, as in `Comparison.computed`."""
        return _MEASURES[number.quantity](self, number)

    def maps(self, number: StatedNumber) -> list[EscapeMap]:
        """Return the maps of a number, one for each energy."""
        assert number.plane is not None
        return [self.cache.map(number.case, number.plane, energy) for energy in number.energies]

    def searches(self, number: StatedNumber) -> list[SuperStickySearch]:
        """Return the searches for late escapes, one for each energy of a number; for case III, the one search at h = 0.26."""
        if number.case == STICKY_CASE:
            return [self.search]
        return [self.cache.late_escapes(number.case, energy) for energy in number.energies]

    def energy_map(self, case: str) -> EscapeMap:
        """Return the map of a case on (x, h), over the range `plane_energies`."""
        return self.cache.map(case, Plane.X_H, plane_energies(case))

    def last_bounded_energy(self, case: str) -> float:
        """Return the highest h on (x, h) with a bounded start; NaN if there is none."""
        frame = self.energy_map(case)
        rows = np.flatnonzero((frame.fate == Fate.BOUNDED).any(axis=1))
        return float(frame.ordinate[rows[-1]]) if rows.size else float("nan")


def counted_codes(number: StatedNumber) -> tuple[int, ...]:
    """Return the codes of the fates that a share counts: bounded, or the given channels, or else all channels of the case."""
    if number.quantity is Quantity.BOUNDED:
        return (int(Fate.BOUNDED),)
    return number.channels or tuple(range(1, CASES[number.case].channels + 1))


Measure = Callable[[ComputedNumbers, StatedNumber], tuple[float, ...]]
"""Computes the values of a number from maps and searches."""


def _of_each_map(measure: Callable[[EscapeMap], float]) -> Measure:
    """Return the function that measures each map of a number."""
    return lambda computed, number: tuple(measure(frame) for frame in computed.maps(number))


def _shares(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    shares = [frame.fractions() for frame in computed.maps(number)]
    return tuple(100.0 * sum(share[code] for code in counted_codes(number)) for share in shares)


def _largest_energy_error(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    assert number.plane is not None
    return (float(computed.cache.curves(number.case, number.plane)["worst_energy_error"].max()),)


def _accurate_share(frame: EscapeMap) -> float:
    return 100.0 * float(np.mean(frame.energy_error[frame.interior] < ACCURATE_ENERGY_ERROR))


def _last_escape(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    escapers = computed.search.escapers
    return (float(computed.search.escape_time[escapers[-1]]) if escapers.size else float("nan"),)


def _nearest_escape(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    """Return the escape time closest to the stated time, of the orbits that escape through the channels of the number."""
    times = computed.search.escape_time[np.isin(computed.search.fate, number.channels)]
    return (float(times[np.argmin(np.abs(times - number.value))]) if times.size else float("nan"),)


def _energy_of_largest_share(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    return (number.energies[int(np.argmax(_shares(computed, number)))],)


def _exponents(computed: ComputedNumbers, number: StatedNumber) -> tuple[float, ...]:
    assert number.plane is not None
    return tuple(computed.cache.exponent(number.case, number.plane, energy).exponent for energy in number.energies)


_MEASURES: Mapping[Quantity, Measure] = MappingProxyType(
    {
        Quantity.ESCAPED_BY: _shares,
        Quantity.BOUNDED: _shares,
        Quantity.ESCAPED: _shares,
        Quantity.DIRECT: _of_each_map(lambda frame: 100.0 * compute_statistics(frame).direct_share),
        Quantity.CHAOTIC: lambda computed, number: tuple(100.0 * search.chaotic_share for search in computed.searches(number)),
        Quantity.LAST_BOUNDED_ENERGY: lambda computed, number: (computed.last_bounded_energy(number.case),),
        Quantity.MEDIAN_ESCAPE_TIME: _of_each_map(lambda frame: compute_statistics(frame).median_escape_time),
        Quantity.ENERGY_ERROR: _largest_energy_error,
        Quantity.ACCURATE: _of_each_map(_accurate_share),
        Quantity.ESCAPE_ENERGY: lambda computed, number: (CASES[number.case].escape_energy,),
        Quantity.LYAPUNOV_R2: lambda computed, number: find_lyapunov_r2(CASES[number.case], number.energies[0]),
        Quantity.LAST_ESCAPE: _last_escape,
        Quantity.NEAREST_ESCAPE: _nearest_escape,
        Quantity.LARGEST_SHARE_ENERGY: _energy_of_largest_share,
        Quantity.IN_BASINS: _of_each_map(share_in_basins),
        Quantity.WADA: _of_each_map(share_next_to_all_basins),
        Quantity.EXPONENT: _exponents,
        Quantity.TIME_ORDERS: _of_each_map(orders_of_escape_times),
    }
)
