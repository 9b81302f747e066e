"""Exits followed along a parameter are those of each potential, and keep their numbers."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, ParameterAxis, Potential, System
from engine.slices.parameter_family import ManyExitsError, ParameterFamily
from engine.systems.known_potentials import POTENTIALS

EPSILON = ParameterAxis("epsilon", 0.5, 2.0, System("III"))
# The saddles at x = 1/2 are exits everywhere; for b < 0 there is a third one at the left, at x = 1 / (3 b), V = 1 / (54 b²).
THIRD_EXIT = ParameterAxis("b", -0.6, 0.2, System("typed", "½(x² + y²) − x y² − b x³", {"b": 0.1}))


@pytest.mark.parametrize("value", [0.61803, 3.7])
def test_continued_saddles_are_those_of_the_potential(value: float) -> None:
    member, found = ParameterFamily(EPSILON).member(value), CASES["III"].with_parameters(epsilon=value)
    np.testing.assert_allclose(member.potential.saddles, found.saddles, rtol=1e-14)
    assert member.potential.terms == found.terms
    assert member.numbers.tolist() == [0, 1, 2, 3, 4]


def test_continued_maxima_merge_the_same_channels() -> None:
    axis = ParameterAxis("epsilon", 0.8, 1.2, System("C5"))
    member, found = ParameterFamily(axis).member(0.93), POTENTIALS["C5"].with_parameters(epsilon=0.93)
    continued, expected = member.potential.well.channel_mergers, found.well.channel_mergers
    assert [merger.channels for merger in continued] == [merger.channels for merger in expected]
    np.testing.assert_allclose([merger[:3] for merger in continued], [merger[:3] for merger in expected], rtol=1e-12)


@pytest.mark.parametrize(("value", "expected"), [(0.05, (1, 2)), (-0.43, (1, 3, 2))])
def test_exits_keep_their_numbers_and_a_new_exit_gets_the_next(value: float, expected: tuple[int, ...]) -> None:
    family = ParameterFamily(THIRD_EXIT)
    member = family.member(value)
    # Counterclockwise: above, at the left, below.
    assert tuple(member.numbers[1:].tolist()) == expected
    assert len(family.outcomes) == 3


def test_a_value_that_the_parameter_cannot_have_is_refused() -> None:
    with pytest.raises(ValueError, match=r"epsilon=-1\.0: must be from"):
        ParameterFamily(EPSILON).member(-1.0)


def test_a_continued_potential_is_kept_apart_from_an_equal_one() -> None:
    continued = ParameterFamily(EPSILON).member(0.7).potential
    assert continued != Potential(continued.name, continued.terms)
    assert continued.in_well_units != Potential(continued.name, continued.terms).in_well_units


def test_an_axis_along_which_exits_change_too_often_is_refused() -> None:
    with pytest.raises(ManyExitsError, match="choose a smaller range"):
        ParameterFamily(THIRD_EXIT, most_searches=3)
