"""Truncated exponential distribution with density ∝ exp(−k u) on 0 ≤ u ≤ 1: maximum-likelihood fit and goodness of fit.

The steepness k can have either sign; k = 0 is the uniform distribution. Samples u have increasing values along their last axis.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_NEWTON_STEPS = 12
# Below this steepness the mean is computed from its series, which avoids cancellation.
_SMALL_STEEPNESS = 1e-2
# Smallest steepness in the formulas that divide by it; the difference from 0 is below their rounding.
_MIN_STEEPNESS = 1e-9


def fit_steepness_and_distance(u: np.ndarray) -> tuple[float, float]:
    """Maximum-likelihood steepness for a sample u (n,), and the Kolmogorov–Smirnov distance of the fit from the sample."""
    steepness = solve_steepness(u.mean(keepdims=True))
    return float(steepness[0]), float(kolmogorov_smirnov_distance(steepness, u))


def solve_steepness(means: np.ndarray) -> np.ndarray:
    """Steepness k of the truncated exponentials with these means in (0, 1); negative for means above 1/2.

    This is the maximum-likelihood estimate. Newton's method solves 1/k − 1/(exp k − 1) = mean from below; for k > 0 the left side
    is convex and decreases from 1/2. Means m and 1 − m have opposite k.
    """
    lower = np.minimum(means, 1.0 - means)
    k = 1.0 / lower - 2.0
    with np.errstate(over="ignore"):
        for _ in range(_NEWTON_STEPS):
            small = k < _SMALL_STEEPNESS
            large = np.where(small, 1.0, k)
            power = np.expm1(large)
            mean = np.where(small, 0.5 - k / 12.0 + k**3 / 720.0, 1.0 / large - 1.0 / power)
            slope = np.where(small, -1.0 / 12.0 + k**2 / 240.0, (1.0 / power) * (1.0 + 1.0 / power) - 1.0 / large**2)
            k = k - (mean - lower) / slope
    signed: np.ndarray = np.where(means < 0.5, k, -k)
    return signed


def cumulative_share(steepness: Any, u: np.ndarray) -> np.ndarray:
    """Cumulative distribution function at u; arguments broadcast."""
    k = np.maximum(np.abs(steepness), _MIN_STEEPNESS)
    mirrored = steepness < 0.0
    share = np.expm1(-k * np.where(mirrored, 1.0 - u, u)) / np.expm1(-k)
    cumulative: np.ndarray = np.where(mirrored, 1.0 - share, share)
    return cumulative


def quantile(steepness: float, share: np.ndarray) -> np.ndarray:
    """Inverse of `cumulative_share`."""
    k = max(abs(steepness), _MIN_STEEPNESS)
    u: np.ndarray = -np.log1p(share * np.expm1(-k)) / k
    return 1.0 - u if steepness < 0.0 else u


def kolmogorov_smirnov_distance(steepness: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Kolmogorov–Smirnov distance of increasing samples u, along the last axis, from the truncated exponential."""
    count = u.shape[-1]
    above = np.arange(1, count + 1) / count - cumulative_share(steepness, u)
    largest: np.ndarray = np.maximum(above.max(axis=-1), 1.0 / count - above.min(axis=-1))
    return largest


def scaled_distance(distance: Any, count: int) -> Any:
    """Kolmogorov–Smirnov distance in units of its typical size in a sample of `count` (Stephens 1974)."""
    root = np.sqrt(count)
    return (distance - 0.2 / count) * (root + 0.26 + 0.5 / root)


def max_log_likelihood(means: np.ndarray) -> np.ndarray:
    """Largest log-likelihood per sample point of a truncated exponential, for samples with these means."""
    k = np.maximum(np.abs(solve_steepness(means)), _MIN_STEEPNESS)
    likelihood: np.ndarray = np.log(-k / np.expm1(-k)) - k * np.minimum(means, 1.0 - means)
    return likelihood
