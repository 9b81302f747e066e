from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    RegularityMap,
    classify_orbits,
    compute_map,
    compute_regularity,
)
from engine.maps.super_sticky import SuperStickySearch, find_super_sticky_orbits

LONG = 2e4


@cache
def judged(name: str = "III", energy: float = 0.35, side: int = 17) -> tuple[EscapeMap, RegularityMap]:
    """A map that was followed for so short that much of what is chaotic has not left."""
    whole = compute_map(MapSpec(CASES[name], Plane.X_PX, energy, (side, side), t_max=400.0))
    return whole, compute_regularity(whole)


@cache
def hunted(name: str = "III", energy: float = 0.35) -> SuperStickySearch:
    return find_super_sticky_orbits(*judged(name, energy), LONG)


def test_all_chaotic_bounded_starts_are_followed_and_no_others() -> None:
    whole, regularity = judged()
    rows, columns = np.nonzero(regularity.character == Regularity.CHAOTIC)
    hunt = hunted()
    assert hunt.fate.size > 5
    np.testing.assert_array_equal(hunt.x, whole.x[columns])
    np.testing.assert_array_equal(hunt.ordinate, whole.ordinate[rows])
    assert hunt.chaotic_share == pytest.approx(regularity.chaotic_share)


@pytest.mark.parametrize(("name", "energy"), [("III", 0.35), ("II", 0.17)])
def test_each_start_mirror_images_included_has_the_outcome_of_its_own_orbit(name: str, energy: float) -> None:
    hunt = hunted(name, energy)
    alone = classify_orbits(CASES[name], energy, hunt.states, LONG)
    for field in ("fate", "escape_time", "crossings"):
        np.testing.assert_array_equal(getattr(hunt, field), getattr(alone, field))


def test_mirror_images_leave_together_through_opposite_channels() -> None:
    hunt = hunted()
    place = {(x, px): k for k, (x, px) in enumerate(zip(hunt.x.tolist(), hunt.ordinate.tolist(), strict=True))}
    image = [place[-x, -px] for x, px in place]
    np.testing.assert_array_equal(hunt.escape_time, hunt.escape_time[image])
    np.testing.assert_array_equal(np.array([0, 2, 1, 4, 3])[hunt.fate], hunt.fate[image])


def test_those_that_left_are_listed_in_order_of_time_and_all_left_after_the_map() -> None:
    hunt = hunted()
    times = hunt.escape_time[hunt.leavers]
    assert times.size == np.count_nonzero(hunt.fate >= 1)
    assert times[0] > hunt.spec.t_max
    assert np.all(np.diff(times) >= 0.0)


def test_it_is_told_how_many_left_by_which_channels_and_when() -> None:
    hunt = replace(
        hunted("II", 0.17),
        bounded=50,
        fate=np.array([2, 0, 1, 2, 0], np.int8),
        escape_time=np.array([5e5, np.nan, 2e5, 851000.0, np.nan]),
        t_max=4e6,
    )
    assert hunt.describe() == (
        "5 of the 50 bounded starts are chaotic (10.0 %). 3 of them leave by t = 4e+06 (1 through channel 1, 2 through channel "
        "2): the first at t = 200000, half of these by 500000, the last at 851000."
    )


def test_where_nothing_is_chaotic_there_is_nothing_to_follow() -> None:
    whole, regularity = judged("I", 0.01, 9)
    hunt = find_super_sticky_orbits(whole, regularity, LONG)
    assert hunt.describe() == f"None of the {np.count_nonzero(whole.fate == Fate.BOUNDED)} bounded starts is chaotic."


def test_progress_rises_to_the_whole() -> None:
    seen: list[float] = []
    find_super_sticky_orbits(*judged(), LONG, on_progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0


def test_when_cancelled_it_stops() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find_super_sticky_orbits(*judged(), LONG, cancel=cancel)


def test_the_judgement_of_another_map_is_refused() -> None:
    with pytest.raises(ValueError, match="regularity: must be"):
        find_super_sticky_orbits(judged()[0], judged("II", 0.17)[1], LONG)


def test_a_time_shorter_than_that_of_the_map_is_refused() -> None:
    with pytest.raises(ValueError, match="t_max=100"):
        find_super_sticky_orbits(*judged(), 100.0)


def test_a_map_with_many_energies_is_refused() -> None:
    whole = compute_map(MapSpec(CASES["III"], Plane.X_H, (0.26, 0.3), (5, 5), t_max=10.0))
    with pytest.raises(ValueError, match=r"\(x, h\)"):
        find_super_sticky_orbits(whole, compute_regularity(whole), LONG)
