"""A family that goes on from its ends is the family that would have been found at once."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Execution, OrbitFamily, SpecialKind, continue_family, find_periodic_orbit

III, HH, HILL = CASES["III"], POTENTIALS["HH"], POTENTIALS["Hill"]
STRAIGHT = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1)


def assert_same(resumed: OrbitFamily, at_once: OrbitFamily) -> None:
    assert [point.name for point in resumed.special] == [point.name for point in at_once.special]
    values = [[point.value for point in family.special] for family in (resumed, at_once)]
    np.testing.assert_allclose(*values, rtol=0, atol=1e-11)
    assert resumed.ends == at_once.ends
    np.testing.assert_array_equal(resumed.value[[0, -1]], at_once.value[[0, -1]])
    np.testing.assert_allclose(resumed.states[[0, -1]], at_once.states[[0, -1]], rtol=0, atol=1e-9)
    for point in resumed.special:
        assert (resumed.value[point.member], resumed.period[point.member]) == (point.value, point.period)


@pytest.mark.parametrize(
    ("first", "then", "at_once"),
    [
        (0.45, [0.7], 0.7),
        ((0.15, 0.45), [(0.1, 0.7)], (0.1, 0.7)),
        ((0.15, 0.45), [0.7, 0.1], (0.1, 0.7)),
        (0.45, [(0.1, 0.7)], (0.1, 0.7)),
    ],
    ids=["upward", "both ways", "one way after the other", "then both ways"],
)
def test_a_family_goes_on_to_further_energies(first: object, then: list[object], at_once: object) -> None:
    family = continue_family(STRAIGHT, first)
    for until in then:
        family = continue_family(family, until)
    assert_same(family, continue_family(STRAIGHT, at_once))


def test_a_family_in_a_rotating_frame_goes_on() -> None:
    orbit = find_periodic_orbit(HILL, [0.28, 0.0, 0.0, 1.5], 1)
    assert_same(continue_family(continue_family(orbit, -2.3), -2.1), continue_family(orbit, -2.1))


def test_a_family_along_a_parameter_goes_on_along_it() -> None:
    at_once = continue_family(STRAIGHT, 3.0, along="epsilon")
    assert_same(continue_family(continue_family(STRAIGHT, 2.0, along="epsilon"), 3.0), at_once)


@pytest.fixture(scope="module")
def folded() -> OrbitFamily:
    straight = continue_family(STRAIGHT, 0.65)
    branch = straight.switch([point.kind for point in straight.special].index(SpecialKind.BRANCHING))[0]
    return continue_family(branch, (0.5, 0.7))


@pytest.mark.parametrize("members", [4, 12])
def test_a_family_goes_on_in_its_direction_also_after_a_fold(folded: OrbitFamily, members: int) -> None:
    begun = continue_family(folded[len(folded) // 2], (0.5, 0.7), most_members=members)
    assert_same(continue_family(begun, (0.5, 0.7)), folded)


def test_a_cancelled_family_is_completed() -> None:
    cancel = threading.Event()
    begun = continue_family(STRAIGHT, 0.7, execution=Execution(cancel=cancel), on_frame=lambda frame: cancel.set())
    assert not begun.complete
    family = continue_family(begun, 0.7)
    assert family.complete
    assert_same(family, continue_family(STRAIGHT, 0.7))


def test_a_family_that_has_ended_is_returned_unchanged() -> None:
    family = continue_family(STRAIGHT, (0.1, 0.7))
    assert_same(again := continue_family(family, (0.1, 0.7)), family)
    assert len(again) == len(family)


def test_frames_have_the_whole_family() -> None:
    family, sizes = continue_family(STRAIGHT, 0.45), list[int]()
    continue_family(family, 0.7, on_frame=lambda frame: sizes.append(len(frame)))
    assert sizes[0] > len(family)
    assert sizes == sorted(sizes)


@pytest.mark.parametrize(
    ("until", "along", "sentence"),
    [
        (0.3, None, r"until=0\.3: must be a value of h below 0\.2 or above 0\.4, or \(low, high\) around all values"),
        ((0.1, 0.3), None, "must be a value of h below"),
        (2.0, "epsilon", "along='epsilon': the family was continued along h"),
    ],
)
def test_a_family_that_cannot_go_on_is_refused(until: object, along: str | None, sentence: str) -> None:
    family = continue_family(STRAIGHT, 0.4)
    with pytest.raises(ValueError, match=sentence):
        continue_family(family, until, along=along)
