"""Comparisons with the paper, on maps of a few hundred starts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Fate, MapSpec, Plane, Regularity, RegularityMap, Window, compute_map
from engine.service import SuperStickySearch
from reproduction.comparisons import Comparison, compare_all
from reproduction.map_shelf import MapShelf
from reproduction.quality import Quality
from reproduction.stated_numbers import Counting, Quantity, Relation, StatedNumber
from reproduction.unknown_windows import fit_window

SMALL = Quality("small", resolution=21, t_max=300.0, curve_points=7, search_resolution=9, search_t_max=400.0)


def make_search(fate: list[int], times: list[float]) -> SuperStickySearch:
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.26, (9, 9))
    n = len(fate)
    zeros = np.zeros(n)
    return SuperStickySearch(
        spec, 40, zeros, zeros, np.zeros((n, 4)), np.array(fate, np.int8), np.array(times), np.arange(n), images=2, t_max=4e6
    )


SEARCH = make_search([0, 2, 1, 2], [np.nan, 1.2e6, 9e5, 8e5])
DIRECT = StatedNumber("I", Plane.X_PX, (0.5,), "0.5", Quantity.DIRECT, Relation.MORE_THAN, 90.0)


def measure(number: StatedNumber) -> Comparison:
    return compare_all(MapShelf(SMALL), SEARCH, (number,))[0]


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
    maps = [compute_map(MapSpec(CASES["I"], Plane.X_PX, h, (21, 21), t_max=300.0)) for h in (0.3, 0.5)]
    assert ours == pytest.approx([100.0 * np.sum(m.fate == 1) / np.sum(m.fate >= 0) for m in maps])


def test_direct_escapes_have_no_crossing() -> None:
    whole = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.5, (21, 21), t_max=300.0))
    direct = np.sum((whole.fate >= 1) & (whole.crossings == 0)) / np.sum(whole.fate >= 0)
    assert measure(DIRECT).computed == pytest.approx((100.0 * direct,))


def test_the_search_gives_the_last_escape_and_the_nearest_to_the_stated_one() -> None:
    last = StatedNumber("III", Plane.X_PX, (0.26,), "", Quantity.LAST_ESCAPE, Relation.ABOUT, 3.5e6)
    nearest = replace(last, quantity=Quantity.NEAREST_ESCAPE, value=851e3, channels=(2,))
    chaotic = replace(last, quantity=Quantity.CHAOTIC, value=10.0)
    rows = compare_all(MapShelf(SMALL), SEARCH, (last, nearest, chaotic))
    assert [row.computed for row in rows] == [(1.2e6,), (8e5,), (10.0,)]


def test_without_escapes_there_is_no_last_escape() -> None:
    last = StatedNumber("III", Plane.X_PX, (0.26,), "", Quantity.LAST_ESCAPE, Relation.ABOUT, 3.5e6)
    assert not compare_all(MapShelf(SMALL), make_search([0], [np.nan]), (last,))[0].agrees


def test_chaotic_shares_of_other_cases_use_the_classification() -> None:
    number = StatedNumber("II", Plane.X_PX, (0.17,), "", Quantity.CHAOTIC, Relation.ABOUT, 0.0)
    shelf = MapShelf(SMALL)
    frame = shelf.map("II", Plane.X_PX, 0.17)
    regularity: RegularityMap = shelf.regularity(frame)
    expected = 100.0 * np.sum(regularity.character == Regularity.CHAOTIC) / np.sum(frame.fate == Fate.BOUNDED)
    assert measure(number).computed == pytest.approx((expected,))


def test_escape_energy_and_lyapunov_orbits_are_computed() -> None:
    escape = StatedNumber("II", None, (), "", Quantity.ESCAPE_ENERGY, Relation.EXACTLY, 1 / 6)
    r2 = StatedNumber("III", Plane.X_Y, (0.26,), "", Quantity.LYAPUNOV_R2, Relation.ABOUT, 1.26)
    assert measure(escape).agrees
    # Known from an independent computation of these orbits.
    assert measure(r2).computed == pytest.approx((1.004, 1.016), abs=5e-4)


def test_the_orbit_along_the_y_axis_is_not_an_island() -> None:
    number = StatedNumber("III", Plane.X_H, (0.25, 1.0), "", Quantity.LAST_BOUNDED_ENERGY, Relation.ABOUT, 0.6)
    assert measure(number).computed[0] < 0.75


def counted(window: Window) -> dict[tuple[int, ...], float]:
    """Percentages with starts outside counted, from a finer independent map."""
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (90, 90), window, t_max=300.0))
    return {(k,): 100.0 * share for k, share in whole.fractions(count_outside=True).items() if k >= 1}


@pytest.mark.parametrize("window", [Window(-1.6, 1.6, -1.6, 1.6), Window(-1.2, 2.4, -1.2, 1.2)], ids=str)
def test_a_window_is_recovered_from_its_percentages(window: Window) -> None:
    shelf = MapShelf(replace(SMALL, resolution=60))
    found = fit_window(shelf, "II", shelf.map("II", Plane.X_PX, 0.5), counted(window), enough=1.0)
    whole = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.5, (90, 90), window, t_max=1e-9, certify=False))
    outside = np.sum(whole.fate == Fate.OUTSIDE) / np.sum(whole.fate != Fate.FORBIDDEN)
    assert found.outside_share == pytest.approx(outside, abs=0.03)
    assert found.share((1,)) == pytest.approx(counted(window)[1,], abs=2.0)


def test_percentages_in_a_window_are_reported_beside_those_inside() -> None:
    number = replace(
        share_of((1,)), case="II", plane=Plane.X_PX, counting=Counting.WINDOW, value=70.0, quantity=Quantity.ESCAPED_BY
    )
    row = measure(number)
    assert len(row.windows) == len(row.counted) == 1
    assert row.counted[0] == row.windows[0].share((1,)) > row.computed[0]
    assert abs(row.counted_difference) < abs(row.difference)
