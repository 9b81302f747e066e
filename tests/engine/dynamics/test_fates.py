from __future__ import annotations

import pytest

from engine import CHAOS_THRESHOLD, Fate, Regularity
from engine.service import describe_fate, judge_regularity


def test_fates_are_not_channel_numbers() -> None:
    assert all(fate <= 0 for fate in Fate)


def test_codes_are_unique() -> None:
    assert len({int(fate) for fate in Fate}) == len(list(Fate)) == 5


@pytest.mark.parametrize("fate", list(Fate))
def test_descriptions_are_unique(fate: Fate) -> None:
    assert [describe_fate(other) for other in Fate].count(describe_fate(fate)) == 1


def test_description_of_an_escape_has_the_channel() -> None:
    assert describe_fate(3) == "Escaped through channel 3."


def test_an_unknown_code_is_an_error() -> None:
    with pytest.raises(ValueError, match="-9"):
        describe_fate(-9)


@pytest.mark.parametrize(("sali", "expected"), [(1.4, "regular"), (1.01e-7, "regular"), (1e-7, "chaotic"), (1e-16, "chaotic")])
def test_sali_at_or_below_the_threshold_is_chaotic(sali: float, expected: str) -> None:
    assert judge_regularity(sali) is Regularity[expected.upper()]


def test_chaos_threshold_matches_the_paper() -> None:
    assert CHAOS_THRESHOLD == 1e-7
