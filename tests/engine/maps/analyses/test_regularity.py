"""Bounded pixels are judged in the same way as single orbits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import (
    CASES,
    Coordinate,
    Direction,
    EscapeMap,
    Evidence,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    Slice,
    compute_map,
    compute_regularity,
    integrate_orbit,
    start_states,
)
from engine.propagation.fates import CHAOS_THRESHOLD, is_chaotic
from engine.results import RegularityMap


def map_and_regularity(name: str, energy: float, side: int = 9, t_max: float = 1e4) -> tuple[EscapeMap, RegularityMap]:
    whole = compute_map(MapSpec(CASES[name], Plane.X_PX, energy, (side, side), t_max=t_max))
    return whole, compute_regularity(whole)


@pytest.mark.parametrize(
    ("name", "energy", "side", "t_max"),
    [
        ("I", 0.12, 5, 3e3),
        pytest.param("III", 0.27, 9, 1e4, marks=pytest.mark.slow),
    ],
)
def test_characters_agree_with_the_sali_of_single_orbits(name: str, energy: float, side: int, t_max: float) -> None:
    whole, regularity = map_and_regularity(name, energy, side, t_max)
    rows, columns = np.nonzero(whole.fate == Fate.BOUNDED)
    states = start_states(CASES[name], Plane.X_PX, energy, whole.x[columns], whole.ordinate[rows])
    chaotic = is_chaotic(np.array([integrate_orbit(CASES[name], state, t_max).sali[-1] for state in states]))
    found = regularity.character[rows, columns] == Regularity.CHAOTIC
    # The SALI of an orbit may reach the threshold just before or just after t_max.
    assert np.mean(found != chaotic) <= 0.04
    assert chaotic.any()
    assert not chaotic.all()


def test_the_scale_of_a_direction_does_not_matter() -> None:
    found = []
    for scale in (1.0, 4.0):
        plane = Slice(Direction("u", x=scale, y=0.5 * scale), Coordinate.PX)
        window = (-0.4 / scale, 0.4 / scale, -0.4, 0.4)
        found.append(compute_regularity(compute_map(MapSpec(CASES["III"], plane, 0.3, (16, 16), window, t_max=300.0))))
    np.testing.assert_array_equal(found[0].sali, found[1].sali)


def test_sali_is_the_smallest_of_the_orbit_and_decides_the_character() -> None:
    # The time is too short for a test for tori, so each orbit is followed to t_max.
    whole, regularity = map_and_regularity("I", 0.12, 6, 1500.0)
    judged = np.isfinite(regularity.sali)
    np.testing.assert_array_equal(judged, (whole.fate == Fate.BOUNDED) & (whole.evidence != Evidence.QUASI_PERIODIC))
    np.testing.assert_array_equal(regularity.sali[judged] <= CHAOS_THRESHOLD, regularity.character[judged] == Regularity.CHAOTIC)
    rows, columns = np.nonzero(regularity.sali > 1e-3)
    assert rows.size > 5
    for row, column in zip(rows, columns, strict=True):
        state = start_states(CASES["I"], Plane.X_PX, 0.12, whole.x[[column]], whole.ordinate[[row]])[0]
        smallest = integrate_orbit(CASES["I"], state, 1500.0).sali.min()
        # SALI is computed only every few units of time.
        assert 0.99 * smallest <= regularity.sali[row, column] <= 1.3 * smallest
    assert not regularity.sali.flags.writeable
    assert regularity.to_xarray()["sali"].attrs == {"units": "1"}


def test_exactly_the_bounded_pixels_are_judged() -> None:
    whole, regularity = map_and_regularity("III", 0.28)
    assert regularity.complete
    np.testing.assert_array_equal(regularity.character != Regularity.NOT_APPLICABLE, whole.fate == Fate.BOUNDED)
    assert Regularity.NOT_JUDGED not in regularity.character


def test_chaotic_share_is_nan_without_bounded_orbits() -> None:
    _, regularity = map_and_regularity("II", 0.3)
    assert regularity.complete
    assert np.isnan(regularity.chaotic_share)


@pytest.mark.slow
def test_orbits_called_regular_show_no_chaos_ten_times_as_long() -> None:
    _, shorter = map_and_regularity("III", 0.26, 24, 1e4)
    _, longer = map_and_regularity("III", 0.26, 24, 1e5)
    regular = shorter.character == Regularity.REGULAR
    assert np.count_nonzero(regular) > 100
    assert np.mean(longer.character[regular] == Regularity.CHAOTIC) <= 0.01
