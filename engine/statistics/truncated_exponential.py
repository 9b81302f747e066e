"""The exponential distribution cut off at both ends, density ∝ exp(−k u) on 0 ≤ u ≤ 1: its fit, and how well it fits.

The steepness k may be of either sign; at 0 all times are equally likely.
"""

from __future__ import annotations

from typing import Any

import numpy as np

_NEWTON_STEPS = 12
_SMALL_STEEPNESS = 1e-2


def fit_truncated_exponential(clock_times: np.ndarray) -> tuple[float, float]:
    """Steepness of the likeliest truncated exponential, and its Kolmogorov–Smirnov distance from the rising times."""
    steepness = solve_steepness(clock_times.mean(keepdims=True))
    return float(steepness[0]), float(find_distance(steepness, clock_times))


def solve_steepness(means: np.ndarray) -> np.ndarray:
    """The steepness k at which a truncated exponential, density ∝ exp(−k u) on 0 ≤ u ≤ 1, has these means in (0, 1).

    It is the maximum-likelihood estimate, and below 0 for a mean beyond 1/2. Newton's method from below on
    1/k − 1/(exp k − 1), which is convex and falls from 1/2 for k > 0; means m and 1 − m have opposite k.
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


def share_left(steepness: Any, clock_times: np.ndarray) -> np.ndarray:
    """Distribution function of the truncated exponential; arguments broadcast."""
    k = np.maximum(np.abs(steepness), 1e-9)
    rising = steepness < 0.0
    share = np.expm1(-k * np.where(rising, 1.0 - clock_times, clock_times)) / np.expm1(-k)
    left: np.ndarray = np.where(rising, 1.0 - share, share)
    return left


def when_left(steepness: float, share: np.ndarray) -> np.ndarray:
    """Inverse of `share_left`."""
    k = max(abs(steepness), 1e-9)
    times: np.ndarray = -np.log1p(share * np.expm1(-k)) / k
    return 1.0 - times if steepness < 0.0 else times


def find_distance(steepness: np.ndarray, clock_times: np.ndarray) -> np.ndarray:
    """Kolmogorov–Smirnov distance of rising times, along the last axis, from the truncated exponential."""
    count = clock_times.shape[-1]
    above = np.arange(1, count + 1) / count - share_left(steepness, clock_times)
    largest: np.ndarray = np.maximum(above.max(axis=-1), 1.0 / count - above.min(axis=-1))
    return largest


def scale_distance(distance: Any, count: int) -> Any:
    """Distance over what chance leaves of it in a sample of this size."""
    root = np.sqrt(count)
    return (distance - 0.2 / count) * (root + 0.26 + 0.5 / root)


def largest_log_likelihood(means: np.ndarray) -> np.ndarray:
    """Largest log-likelihood per escape of a truncated exponential."""
    k = np.maximum(np.abs(solve_steepness(means)), 1e-9)
    likelihood: np.ndarray = np.log(-k / np.expm1(-k)) - k * np.minimum(means, 1.0 - means)
    return likelihood
