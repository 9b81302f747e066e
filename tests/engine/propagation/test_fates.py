"""Fates have names and sentences, and SALI has its threshold."""

from __future__ import annotations

import math

import pytest

from engine.propagation.fates import describe_fate, is_chaotic, name_fate
from tests.disc import DISC, LABELS


def test_an_unknown_code_is_an_error() -> None:
    with pytest.raises(ValueError, match="-9"):
        describe_fate(-9)


@pytest.mark.parametrize(("sali", "chaotic"), [(1.4, False), (1.01e-7, False), (1e-7, True), (1e-16, True), (math.nan, False)])
def test_sali_at_or_below_the_threshold_is_chaotic(sali: float, chaotic: bool) -> None:
    assert bool(is_chaotic(sali)) is chaotic


def test_a_fate_has_the_name_and_the_sentence_of_its_outcome() -> None:
    assert [name_fate(fate, DISC.outcomes) for fate in (1, 2, 3)] == LABELS
    assert describe_fate(3, DISC.outcomes) == "Collided with a disc."
