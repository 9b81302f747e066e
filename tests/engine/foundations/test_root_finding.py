"""Roots are those of SciPy, and invalid brackets are refused."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy import optimize

from engine.foundations.root_finding import bisect, find_root

FUNCTIONS: dict[str, tuple[Callable[[float], float], float, float]] = {
    "line": (lambda x: 2.0 * x - 0.3, -1.0, 5.0),
    "cosine": (lambda x: math.cos(x) - x, 0.0, 1.0),
    "steep": (lambda x: math.tanh(50.0 * (x - 0.123)) - 0.5, -2.0, 3.0),
    "root at an end": (lambda x: x, 0.0, 1.0),
    "downward": (lambda x: 1.0 - math.exp(x - 2.0), -5.0, 40.0),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_roots_agree_with_scipy_to_the_bit(name: str) -> None:
    function, low, high = FUNCTIONS[name]
    assert find_root(function, low, high, xtol=1e-17, rtol=1e-15) == optimize.brentq(function, low, high, xtol=1e-17, rtol=1e-15)


def test_equal_signs_at_the_ends_are_refused() -> None:
    with pytest.raises(ValueError, match="different signs"):
        find_root(lambda x: x * x + 1.0, -1.0, 1.0, xtol=1e-12, rtol=1e-12)


def test_bisection_encloses_each_boundary_from_either_side() -> None:
    boundaries = np.array([[0.3, 0.7], [0.1, 0.9]])
    signs = np.array([[1.0, -1.0], [1.0, -1.0]])
    within, beyond = np.where(signs > 0.0, 0.0, 1.0), np.where(signs > 0.0, 1.0, 0.0)
    low, high = bisect(lambda points: signs * (points - boundaries) > 0.0, within, beyond, 20)
    np.testing.assert_allclose(np.abs(high - low), 2.0**-20)
    assert np.all(signs * (low - boundaries) <= 0.0)
    assert np.all(signs * (high - boundaries) > 0.0)


@pytest.mark.parametrize("undefined", [(1.0, 1.1), (1.9, 2.0), (1.4, 1.7)])
def test_a_function_that_is_nan_is_refused(undefined: tuple[float, float]) -> None:
    def function(x: float) -> float:
        return math.nan if undefined[0] <= x <= undefined[1] else x - 1.6

    with pytest.raises(ValueError, match="the function is NaN at "):
        find_root(function, 1.0, 2.0, xtol=1e-12, rtol=1e-12)
