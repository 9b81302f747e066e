"""Reasons for differences are filled with computed values."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, compute_map
from reproduction.map_cache import MapCache
from reproduction.numbers.measures import ComputedNumbers
from reproduction.numbers.reasons import explain
from reproduction.numbers.stated_numbers import Quantity, Relation, StatedNumber
from reproduction.quality import Quality

SMALL = Quality(
    "small", resolution=22, t_max=6e3, curve_points=7, search_resolution=10, search_t_max=7e3, classified_resolution=10,
    exponent_work=1e4,
)  # fmt: skip
NUMBER = StatedNumber("I", Plane.X_PX, (0.13,), "0.13", Quantity.BOUNDED, Relation.ABOUT, 50.0)


@pytest.fixture(scope="module")
def computed() -> ComputedNumbers:
    cache = MapCache(SMALL)
    return ComputedNumbers(cache, cache.super_sticky())


def test_bounded_shares_at_earlier_times_count_later_escapes(computed: ComputedNumbers) -> None:
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (22, 22), t_max=5e3))
    expected = 100.0 * np.sum(frame.fate == Fate.BOUNDED) / np.sum(frame.fate >= 0)
    assert float(explain(computed, replace(NUMBER, remark="{bounded_at_5000}"))) == pytest.approx(expected)


def test_late_escapes_are_a_share_of_the_escapes(computed: ComputedNumbers) -> None:
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (22, 22), t_max=6e3))
    number = replace(NUMBER, quantity=Quantity.MEDIAN_ESCAPE_TIME, value=500.0, remark="{late_share}")
    expected = 100.0 * np.sum(frame.escape_time > 500.0) / np.sum(frame.fate >= 1)
    assert float(explain(computed, number)) == pytest.approx(expected)


def test_chaotic_orbits_are_counted_over_all_energies(computed: ComputedNumbers) -> None:
    number = replace(NUMBER, energies=(0.13, 0.15), quantity=Quantity.CHAOTIC, remark="{chaotic_escapes} of {chaotic_orbits}")
    searches = [computed.cache.late_escapes("I", energy) for energy in number.energies]
    left, chaotic = (sum(sizes) for sizes in zip(*((s.escapers.size, s.fate.size) for s in searches), strict=True))
    assert explain(computed, number) == f"{left} of {chaotic}"


def test_the_end_of_the_islands_is_that_of_the_energy_plane(computed: ComputedNumbers) -> None:
    number = StatedNumber("III", Plane.X_H, (0.25, 1.0), "", Quantity.LAST_BOUNDED_ENERGY, Relation.ABOUT, 0.3)
    frame = compute_map(MapSpec(CASES["III"], Plane.X_H, (0.25, 1.0), (22, 22), t_max=6e3))
    rows, _ = np.nonzero(frame.fate == Fate.BOUNDED)
    expected = f"{np.sum(frame.ordinate[rows] > 0.3)}, {frame.ordinate[rows.max()]:.3f}"
    assert explain(computed, replace(number, remark="{bounded_above}, {last_bounded:.3f}")) == expected


def test_the_stated_energy_is_compared_with_the_energy_of_the_largest_share(computed: ComputedNumbers) -> None:
    number = replace(
        NUMBER, energies=(0.15, 0.17, 0.5), quantity=Quantity.LARGEST_SHARE_ENERGY, value=0.17, channels=(2,),
        remark="{below_largest}",
    )  # fmt: skip
    shares = [100.0 * computed.cache.map("I", Plane.X_PX, energy).fractions()[2] for energy in number.energies]
    assert float(explain(computed, number)) == pytest.approx(max(shares) - shares[1])
