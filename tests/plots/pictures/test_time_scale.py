"""The colour scale of escape times fits the map."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import Fate
from plots.pictures.time_scale import TimeScale, common_scale, fitted_scale


def frame_of(times: Sequence[float]) -> Any:
    shown = np.array([*np.repeat(times, 200), np.nan])
    return SimpleNamespace(escape_time=shown, fate=np.where(np.isnan(shown), Fate.BOUNDED, 1))


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        ([3.3, 470.0], TimeScale(2.0, 500.0)),
        ([41.2, 43.1], TimeScale(41.0, 44.0)),
        ([0.0, 0.0], TimeScale(0.1, 0.11)),
    ],
)
def test_the_scale_begins_and_ends_at_round_numbers(times: Sequence[float], expected: TimeScale) -> None:
    assert fitted_scale(frame_of(times)) == expected


def test_one_percent_of_the_times_is_left_out_at_both_ends() -> None:
    assert fitted_scale(frame_of([0.5] + [3.0] * 100 + [60.0] * 100 + [9000.0])) == TimeScale(2.0, 100.0)


@given(st.lists(st.floats(0.0, 1e7), min_size=1, max_size=30))
def test_the_scale_contains_the_percentiles(times: Sequence[float]) -> None:
    scale = fitted_scale(frame_of(times))
    low, high = np.maximum(np.quantile(times, (0.01, 0.99)), 0.1)
    assert scale.low <= low <= high <= scale.high


def test_the_common_scale_contains_all() -> None:
    assert common_scale([frame_of([3.3, 470.0]), frame_of([41.2, 43.1])]) == TimeScale(2.0, 500.0)


def test_the_classes_are_equal_shares_of_the_logarithm() -> None:
    times = np.array([0.5, 1.0, 1.9, 2.1, 7.9, 8.1, 16.0, 99.0])
    assert TimeScale(1.0, 16.0).classes(times, 4).tolist() == [0, 0, 0, 1, 2, 3, 3, 3]


@pytest.mark.parametrize(("low", "high"), [(0.0, 1.0), (2.0, 2.0), (1.0, np.inf)])
def test_invalid_ends_are_refused(low: float, high: float) -> None:
    with pytest.raises(ValueError, match="low="):
        TimeScale(low, high)
