"""Comparisons with the paper have the right differences, on maps of a few hundred starts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    Window,
    compute_map,
    compute_regularity,
    compute_uncertainty_exponent,
)
from reproduction.map_cache import MapCache
from reproduction.numbers.comparisons import Comparison, compare_all
from reproduction.numbers.stated_numbers import Counting, Quantity, Relation, StatedNumber
from reproduction.numbers.unknown_windows import fit_window
from reproduction.quality import Quality
from reproduction.super_sticky import SuperStickySearch

SMALL = Quality(
    "small", resolution=22, t_max=300.0, curve_points=7, search_resolution=9,
    search_t_max=400.0, classified_resolution=10, exponent_work=1e4,
)  # fmt: skip


def make_search(fate: list[int], times: list[float]) -> SuperStickySearch:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.26, (9, 9))
    n = len(fate)
    zeros = np.zeros(n)
    return SuperStickySearch(
        spec, 40, zeros, zeros, np.zeros((n, 4)), np.array(fate, np.int8), np.array(times), np.arange(n), True, t_max=4e6
    )


SEARCH = make_search([0, 2, 1, 2], [np.nan, 1.2e6, 9e5, 8e5])
DIRECT = StatedNumber("I", Plane.X_PX, (0.5,), "0.5", Quantity.DIRECT, Relation.MORE_THAN, 90.0)


def measure(number: StatedNumber) -> Comparison:
    return compare_all(MapCache(SMALL), SEARCH, (number,))[0]


def share_of(channels: tuple[int, ...], energies: tuple[float, ...] = (0.5,)) -> StatedNumber:
    return StatedNumber("I", Plane.X_PX, energies, "", Quantity.ESCAPED_BY, Relation.ABOUT, 60.0, channels)


@pytest.mark.parametrize(
    ("relation", "ours", "difference", "agrees"),
    [
        (Relation.ABOUT, (61.9,), 1.9, True),
        (Relation.ABOUT, (61.0, 57.5), -2.5, False),
        (Relation.MORE_THAN, (75.0, 60.5), 0.0, True),
        (Relation.MORE_THAN, (75.0, 57.0), -3.0, False),
        (Relation.LESS_THAN, (12.0,), 0.0, True),
        (Relation.LESS_THAN, (12.0, 63.0), 3.0, False),
    ],
)
def test_the_difference_is_the_largest_one_and_zero_if_a_bound_holds(
    relation: Relation, ours: tuple[float, ...], difference: float, agrees: bool
) -> None:
    comparison = Comparison(replace(share_of((1,)), relation=relation), ours)
    assert comparison.difference == pytest.approx(difference)
    assert comparison.agrees is agrees


def test_missing_values_do_not_agree() -> None:
    comparison = Comparison(share_of((1,)), (float("nan"),))
    assert np.isnan(comparison.difference)
    assert not comparison.agrees


def test_times_agree_to_two_percent() -> None:
    number = StatedNumber("III", Plane.X_PX, (0.26,), "", Quantity.LAST_ESCAPE, Relation.ABOUT, 3.5e6)
    assert Comparison(number, (3.44e6,)).agrees
    assert not Comparison(number, (3.4e6,)).agrees


def test_shares_are_computed_from_the_map_at_each_energy() -> None:
    ours = measure(share_of((1,), (0.3, 0.5))).computed
    maps = [compute_map(MapSpec(CASES["I"], Plane.X_PX, h, (22, 22), t_max=300.0)) for h in (0.3, 0.5)]
    assert ours == pytest.approx([100.0 * np.sum(m.fate == 1) / np.sum(m.fate >= 0) for m in maps])


def test_direct_escapes_have_no_crossing() -> None:
    whole = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.5, (22, 22), t_max=300.0))
    direct = np.sum((whole.fate >= 1) & (whole.crossings == 0)) / np.sum(whole.fate >= 0)
    assert measure(DIRECT).computed == pytest.approx((100.0 * direct,))


def test_the_search_gives_the_last_escape_and_the_escape_nearest_to_the_stated_time() -> None:
    last = StatedNumber("III", Plane.X_PX, (0.26,), "", Quantity.LAST_ESCAPE, Relation.ABOUT, 3.5e6)
    nearest = replace(last, quantity=Quantity.NEAREST_ESCAPE, value=851e3, channels=(2,))
    chaotic = replace(last, quantity=Quantity.CHAOTIC, value=10.0)
    rows = compare_all(MapCache(SMALL), SEARCH, (last, nearest, chaotic))
    assert [row.computed for row in rows] == [(1.2e6,), (8e5,), (10.0,)]


def test_without_escapes_there_is_no_last_escape() -> None:
    last = StatedNumber("III", Plane.X_PX, (0.26,), "", Quantity.LAST_ESCAPE, Relation.ABOUT, 3.5e6)
    assert not compare_all(MapCache(SMALL), make_search([0], [np.nan]), (last,))[0].agrees


def test_chaotic_shares_of_other_cases_are_those_of_the_coarser_maps() -> None:
    number = StatedNumber("II", Plane.X_PX, (0.17, 0.3), "", Quantity.CHAOTIC, Relation.ABOUT, 0.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.17, (10, 10), t_max=300.0))
    chaotic = np.sum(compute_regularity(frame).character == Regularity.CHAOTIC)
    assert measure(number).computed == pytest.approx((100.0 * chaotic / np.sum(frame.fate == Fate.BOUNDED), np.nan), nan_ok=True)


def test_energies_without_a_value_do_not_count() -> None:
    assert Comparison(share_of((1,)), (61.0, float("nan"))).difference == pytest.approx(1.0)


def test_a_rising_number_is_compared_at_the_highest_energy() -> None:
    number = StatedNumber("I", Plane.X_Y, (0.2, 0.5), "", Quantity.EXPONENT, Relation.RISES_TO, 1.0)
    assert Comparison(number, (0.1, 0.99)).agrees
    assert not Comparison(number, (1.0, 0.5)).agrees
    assert not Comparison(number, (1.0, float("nan"))).agrees


def test_accurate_orbits_are_counted_inside() -> None:
    number = StatedNumber("II", Plane.X_PX, (0.3,), "", Quantity.ACCURATE, Relation.MORE_THAN, 50.0)
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.3, (22, 22), t_max=300.0))
    assert measure(number).computed == (100.0 * np.mean(frame.energy_error[frame.fate >= 0] < 1e-11),)


def test_the_energy_of_the_largest_share_is_found() -> None:
    number = replace(share_of((2,), (0.13, 0.17, 0.5)), plane=Plane.X_Y, quantity=Quantity.LARGEST_SHARE_ENERGY, value=0.17)
    shares = measure(replace(number, quantity=Quantity.ESCAPED_BY)).computed
    assert measure(number).computed == (number.energies[int(np.argmax(shares))],)


def test_exponents_are_those_of_the_engine() -> None:
    number = StatedNumber("I", Plane.X_Y, (0.5,), "", Quantity.EXPONENT, Relation.RISES_TO, 1.0)
    spec = MapSpec(CASES["I"], Plane.X_Y, 0.5, (22, 22), t_max=300.0)
    assert measure(number).computed == pytest.approx((compute_uncertainty_exponent(spec, work=1e4, rng=0).exponent,), nan_ok=True)


def test_a_reason_is_given_for_a_difference_only() -> None:
    number = replace(share_of((1,), (0.3, 0.5)), remark="At last {share_at_last:.1f}.")
    last = measure(number).computed[-1]
    assert measure(replace(number, value=0.0)).reason == f"At last {last:.1f}."
    assert measure(replace(number, relation=Relation.LESS_THAN, value=100.0)).reason == ""


def test_escape_energy_and_lyapunov_orbits_are_computed() -> None:
    escape = StatedNumber("II", None, (), "", Quantity.ESCAPE_ENERGY, Relation.EXACTLY, 1 / 6)
    r2 = StatedNumber("III", Plane.X_Y, (0.26,), "", Quantity.LYAPUNOV_R2, Relation.ABOUT, 1.26)
    assert measure(escape).agrees
    # The numbers are known from an independent computation of the orbits.
    assert measure(r2).computed == pytest.approx((1.004, 1.016), abs=5e-4)


def test_the_orbit_along_the_y_axis_is_not_an_island() -> None:
    number = StatedNumber("III", Plane.X_H, (0.25, 1.0), "", Quantity.LAST_BOUNDED_ENERGY, Relation.ABOUT, 0.6)
    assert measure(number).computed[0] < 0.75


def counted(window: Window) -> dict[tuple[int, ...], float]:
    """Return percentages with starts outside counted, from a finer independent map."""
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (90, 90), window, t_max=300.0))
    return {(k,): 100.0 * share for k, share in whole.fractions(count_outside=True).items() if k >= 1}


@pytest.mark.parametrize("window", [Window(-1.6, 1.6, -1.6, 1.6), Window(-1.2, 2.4, -1.2, 1.2)], ids=str)
def test_a_window_is_recovered_from_its_percentages(window: Window) -> None:
    cache = MapCache(replace(SMALL, resolution=60))
    found = fit_window(cache, "II", cache.map("II", Plane.X_PX, 0.5), counted(window), tolerance=1.0)
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (90, 90), window, t_max=1e-9, use_evidence=False))
    outside = np.sum(whole.fate == Fate.OUTSIDE) / np.sum(whole.fate != Fate.FORBIDDEN)
    assert found.outside_share == pytest.approx(outside, abs=0.03)
    assert found.percentage((1,)) == pytest.approx(counted(window)[1,], abs=2.0)


def test_percentages_in_a_window_are_reported_in_addition_to_those_inside() -> None:
    number = replace(
        share_of((1,)), case="II", plane=Plane.X_PX, counting=Counting.WINDOW, value=70.0, quantity=Quantity.ESCAPED_BY
    )
    row = measure(number)
    assert len(row.windows) == len(row.counted_shares) == 1
    assert row.counted_shares[0] == row.windows[0].percentage((1,)) > row.computed[0]
    assert abs(row.counted_difference) < abs(row.difference)
