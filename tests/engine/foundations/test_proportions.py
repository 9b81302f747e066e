"""Confidence intervals of shares agree with SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binomtest

from engine.foundations.proportions import wilson_interval


@pytest.mark.parametrize(("count", "total"), [(0, 1), (0, 50), (1, 50), (25, 50), (50, 50), (12_345, 39_000)])
def test_limits_are_those_of_scipy(count: int, total: int) -> None:
    reference = binomtest(count, total).proportion_ci(method="wilson")
    assert wilson_interval(count, total) == pytest.approx((reference.low, reference.high), abs=1e-12)


def test_without_draws_any_share_is_possible() -> None:
    low, high = wilson_interval([0, 3], [0, 6])
    assert (low[0], high[0]) == (0.0, 1.0)
    np.testing.assert_allclose(low[1] + high[1], 1.0)
