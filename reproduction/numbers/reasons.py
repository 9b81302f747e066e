"""Explain differences from the paper with computed values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from string import Formatter
from types import MappingProxyType

import numpy as np

from engine import Fate, compute_statistics
from engine.systems.catalogue.published_fits import PAPER_FITS
from reproduction.numbers.measures import ComputedNumbers
from reproduction.numbers.stated_numbers import Quantity, StatedNumber


def explain(computed: ComputedNumbers, number: StatedNumber) -> str:
    """Return the remark of a number. The fields in braces, which are names of `FACTS`, are filled in."""
    names = [name for _, name, _, _ in Formatter().parse(number.remark) if name]
    return number.remark.format(**{name: FACTS[name](computed, number) for name in names})


def _late_share(computed: ComputedNumbers, number: StatedNumber) -> float:
    times = compute_statistics(computed.maps(number)[0]).escape_times
    return 100.0 * float(np.mean(times > number.value))


def _bounded_at(time: float) -> Callable[[ComputedNumbers, StatedNumber], float]:
    def measure(computed: ComputedNumbers, number: StatedNumber) -> float:
        frame = computed.maps(number)[0]
        fate, escape_time = frame.fate[frame.interior], frame.escape_time[frame.interior]
        return 100.0 * float(np.mean((fate == Fate.BOUNDED) | (escape_time > time)))

    return measure


def _bounded_above(computed: ComputedNumbers, number: StatedNumber) -> int:
    frame = computed.energy_map(number.case)
    return int(np.count_nonzero(frame.fate[frame.ordinate > number.value] == Fate.BOUNDED))


def _below_largest(computed: ComputedNumbers, number: StatedNumber) -> float:
    shares = computed.values(replace(number, quantity=Quantity.ESCAPED_BY))
    return max(shares) - shares[number.energies.index(number.value)]


FACTS: Mapping[str, Callable[[ComputedNumbers, StatedNumber], float]] = MappingProxyType(
    {
        "late_share": _late_share,
        "bounded_at_5000": _bounded_at(5e3),
        "bounded_at_20000": _bounded_at(2e4),
        "chaotic_orbits": lambda computed, number: sum(search.fate.size for search in computed.searches(number)),
        "chaotic_escapes": lambda computed, number: sum(search.escapers.size for search in computed.searches(number)),
        "bounded_above": _bounded_above,
        "last_bounded": lambda computed, number: computed.last_bounded_energy(number.case),
        "paper_direct": lambda computed, number: 100.0 * float(PAPER_FITS[number.case].direct(number.energies[0])),
        "share_at_last": lambda computed, number: computed.values(number)[-1],
        "below_largest": _below_largest,
    }
)
"""Computed values for the remarks of numbers, by name. Shares are in percent."""
