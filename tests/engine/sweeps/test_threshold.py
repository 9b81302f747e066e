"""The place where a measure reaches a value is between maps whose intervals exclude this value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Execution, ParameterAxis, Plane, SweepSpec, compute_sweep, find_where

SPEC = SweepSpec(CASES["I"], Plane.X_PX, (0.15, 0.2), (30, 30), t_max=300.0)


@pytest.mark.parametrize(("quantity", "wanted"), [("share_bounded", 0.1), ("share_exit_1", 0.45), ("s_bb", 0.7)])
def test_the_ends_are_on_opposite_sides_with_their_intervals(quantity: str, wanted: float) -> None:
    found = find_where(SPEC, quantity, wanted)
    low, high = (int(np.flatnonzero(found.value == end)[0]) for end in (found.low, found.high))
    below, above = (low, high) if found.measured[low] < wanted else (high, low)
    assert found.measured_high[below] < wanted < found.measured_low[above]
    assert found.low < found.estimate < found.high
    # No map between the ends is on a side.
    between = slice(low + 1, high)
    assert np.all((found.measured_low[between] <= wanted) & (found.measured_high[between] >= wanted))
    assert found.starts == found.value.size * 900


def test_the_measures_are_those_of_a_sweep() -> None:
    found = find_where(SPEC, "s_bb", 0.7, most_maps=5)
    sweep = compute_sweep(replace(SPEC, values=found.value, measures=("basin_entropy",)))
    np.testing.assert_array_equal(found.measured, sweep["s_bb"])
    np.testing.assert_allclose(found.measured_high - found.measured, 1.96 * sweep["s_bb_error"])
    assert found.value.size == 5


def test_more_starts_make_the_interval_narrower() -> None:
    coarse, fine = (find_where(replace(SPEC, resolution=(side, side)), "share_bounded", 0.2) for side in (20, 60))
    assert fine.high - fine.low < 0.6 * (coarse.high - coarse.low)
    assert coarse.low < fine.estimate < coarse.high


def test_a_number_without_an_error_is_bisected_to_the_tolerance() -> None:
    found = find_where(SPEC, "flux", 0.4, tolerance=1e-4)
    assert found.high - found.low <= 1e-4
    assert found.measured[found.value == found.low] < 0.4 < found.measured[found.value == found.high]


def test_a_letter_is_found_at_one_energy() -> None:
    axis = ParameterAxis("epsilon", 0.8, 1.2, CASES["I"])
    found = find_where(replace(SPEC, values=(0.8, 1.2), measures=("shares",), along=axis, energy=0.2), "share_bounded", 0.1)
    assert found.axis == "epsilon"
    assert 0.8 < found.low < found.high < 1.2


def test_the_first_and_the_last_crossing_are_found() -> None:
    # The island in the middle is gone at the resonance 1:3 near h = 0.262, and stands again from there to 0.31.
    spec = replace(SPEC, values=(0.24, 0.262, 0.29, 0.33), resolution=(101, 101), t_max=1e3)
    first, last = (find_where(spec, "islands", 0.5, tolerance=2e-3, last=last) for last in (False, True))
    assert 0.24 < first.low < first.high <= 0.262
    assert 0.29 <= last.low < last.high < 0.33


def test_progress_ends_at_1() -> None:
    shares: list[float] = []
    find_where(SPEC, "share_bounded", 0.1, most_maps=4, execution=Execution(on_progress=shares.append))
    assert shares[-1] == 1.0
    assert shares == sorted(shares)


@pytest.mark.parametrize(
    ("changes", "quantity", "wanted", "message"),
    [
        ({}, "share_bounded", 0.9, r"^value=0\.9: is not reached between two values of h, where the measure is 0\.0"),
        ({}, "share", 0.1, r"^quantity='share': must be one of .*s_b.*share_bounded, share_exit_1, share_exit_2$"),
        ({}, "s_b", float("nan"), r"^value=nan: must be a finite number"),
        ({"values": (0.2,)}, "s_b", 0.4, r"^spec: has 1 value; must have from 2 to most_maps=40"),
    ],
)
def test_what_cannot_be_found_is_refused(changes: dict[str, object], quantity: str, wanted: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        find_where(replace(SPEC, **changes), quantity, wanted)  # type: ignore[arg-type]
