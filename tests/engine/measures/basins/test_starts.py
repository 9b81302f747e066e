"""Measures count the right starts of a map, and Wilson's intervals are those of SciPy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.stats import binomtest

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, compute_basin_entropy, compute_map, compute_wada_test
from engine.measures.basins.starts import exit_labels, wilson_interval


@pytest.fixture(scope="module")
def whole() -> EscapeMap:
    """Return a map with forbidden, outside, escaping and bounded starts."""
    frame = compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.3, (40, 40), t_max=300.0))
    assert set(np.unique(frame.fate)) == {Fate.FORBIDDEN, Fate.OUTSIDE, Fate.BOUNDED, 1, 2, 3, 4}
    return frame


def with_fate(frame: EscapeMap, fate: Fate) -> EscapeMap:
    """Return the map with one escaping pixel changed."""
    codes = frame.fate.copy()
    codes[np.unravel_index(np.argmax(codes), codes.shape)] = fate
    return replace(frame, fate=codes)


def test_all_interior_starts_count_if_bounded_starts_do(whole: EscapeMap) -> None:
    labels, valid = exit_labels(whole.fate, bounded=True)
    assert np.array_equal(valid, whole.interior)
    assert np.array_equal(labels[valid], whole.fate[whole.interior])


def test_only_escaping_starts_count_if_bounded_starts_do_not(whole: EscapeMap) -> None:
    labels, valid = exit_labels(whole.fate, bounded=False)
    assert np.array_equal(valid, whole.fate >= 1)
    assert set(labels[valid]) == {1, 2, 3, 4}


@pytest.mark.parametrize("bounded", [True, False])
@pytest.mark.parametrize("fate", [Fate.NOT_COMPUTED, Fate.FAILED])
def test_undecided_and_failed_starts_do_not_count(whole: EscapeMap, fate: Fate, bounded: bool) -> None:
    before = exit_labels(whole.fate, bounded=bounded)[1]
    after = exit_labels(with_fate(whole, fate).fate, bounded=bounded)[1]
    assert np.count_nonzero(before) - np.count_nonzero(after) == 1


@pytest.mark.parametrize("measure", [compute_basin_entropy, compute_wada_test])
def test_negative_codes_without_a_mask_are_no_basin(measure: Callable[..., Any]) -> None:
    fate = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.3, (30, 30), t_max=100.0)).fate
    with pytest.raises(ValueError, match=rf"labels: {np.count_nonzero(fate < 0)} are negative, .*valid=\(labels >= 0\)"):
        measure(fate)
    assert measure(fate, fate >= 0).describe() == measure(np.where(fate < 0, 7, fate), fate >= 0).describe()


@pytest.mark.parametrize(("count", "total"), [(0, 1), (0, 50), (1, 50), (25, 50), (50, 50), (12_345, 39_000)])
def test_limits_agree_with_scipy(count: int, total: int) -> None:
    reference = binomtest(count, total).proportion_ci(method="wilson")
    assert wilson_interval(count, total) == pytest.approx((reference.low, reference.high), abs=1e-12)


def test_without_draws_any_share_is_possible() -> None:
    low, high = wilson_interval([0, 3], [0, 6])
    assert (low[0], high[0]) == (0.0, 1.0)
    np.testing.assert_allclose(low[1] + high[1], 1.0)
