"""The search continues exactly the chaotic bounded orbits of a map."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from engine import CASES, EscapeMap, MapSpec, Plane, Regularity, classify_orbits, compute_map, compute_regularity
from engine.foundations.execution import Execution
from engine.results import RegularityMap
from reproduction.super_sticky import SuperStickySearch, find_super_sticky_orbits

LONG = 2e4


@cache
def map_and_regularity(name: str = "III", energy: float = 0.35, side: int = 17) -> tuple[EscapeMap, RegularityMap]:
    """Return a map with so short a t_max that many chaotic orbits have not escaped yet."""
    whole = compute_map(MapSpec(CASES[name], Plane.X_PX, energy, (side, side), t_max=400.0))
    return whole, compute_regularity(whole)


@cache
def search(name: str = "III", energy: float = 0.35) -> SuperStickySearch:
    return find_super_sticky_orbits(*map_and_regularity(name, energy), LONG)


def test_exactly_the_chaotic_bounded_starts_are_integrated() -> None:
    whole, regularity = map_and_regularity()
    rows, columns = np.nonzero(regularity.character == Regularity.CHAOTIC)
    found = search()
    assert found.fate.size > 5
    np.testing.assert_array_equal(found.x, whole.x[columns])
    np.testing.assert_array_equal(found.ordinate, whole.ordinate[rows])
    assert found.chaotic_share == pytest.approx(regularity.chaotic_share)


@pytest.mark.parametrize(("name", "energy"), [("III", 0.35), ("II", 0.17)])
def test_all_starts_including_mirror_images_have_the_outcome_of_their_orbits(name: str, energy: float) -> None:
    found = search(name, energy)
    expected = classify_orbits(CASES[name], energy, found.states, LONG)
    for field in ("fate", "escape_time", "crossings"):
        np.testing.assert_array_equal(getattr(found, field), getattr(expected, field))


def test_escapers_are_sorted_by_escape_time_and_escape_after_the_map() -> None:
    found = search()
    times = found.escape_time[found.escapers]
    assert times.size == np.count_nonzero(found.fate >= 1)
    assert times[0] > found.spec.t_max
    assert np.all(np.diff(times) >= 0.0)


def test_description_gives_escapes_by_channel_and_their_times() -> None:
    found = replace(
        search("II", 0.17),
        bounded_count=50,
        fate=np.array([2, 0, 1, 2, 0], np.int8),
        escape_time=np.array([5e5, np.nan, 2e5, 851000.0, np.nan]),
        t_max=4e6,
    )
    assert found.describe() == (
        "5 of the 50 bounded starts are chaotic (10.0 %). 3 of them escape by t = 4e+06 (1 through exit 1, 2 through exit "
        "2): the first at t = 200000, half of these by 500000, the last at 851000."
    )


def test_cancelling_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find_super_sticky_orbits(*map_and_regularity(), LONG, execution=Execution(cancel=cancel))
