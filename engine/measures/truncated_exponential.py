"""Truncated exponential distribution with density ∝ exp(−k u) on 0 ≤ u ≤ 1: maximum-likelihood fit and goodness of fit.

The steepness k can have either sign; k = 0 is the uniform distribution. u ↔ 1 − u changes the sign of k and nothing else. SciPy's
`truncexpon` has only k > 0, and no estimate for many samples at once. Samples u have increasing values along their last axis.
"""

from __future__ import annotations

from typing import Any

import numpy as np


def fit_steepness_and_distance(u: np.ndarray) -> tuple[float, float]:
    """Maximum-likelihood steepness for a sample u (n,), and the Kolmogorov–Smirnov distance of the fit from the sample."""
    steepness = solve_steepness(u.mean(keepdims=True))
    return float(steepness[0]), float(kolmogorov_smirnov_distance(steepness, u))


def solve_steepness(means: np.ndarray) -> np.ndarray:
    """Steepness k of the truncated exponentials with these means in (0, 1), which is the maximum-likelihood estimate.

    It solves ½ ₁F₁(2; 3; −k) / ₁F₁(1; 2; −k) = 1/k − 1/(exp k − 1) = mean; the left form is accurate for small k too.
    """
    from scipy import special
    from scipy.optimize import elementwise

    lower = np.minimum(means, 1.0 - means)
    found = elementwise.find_root(
        lambda k, mean: 0.5 * special.hyp1f1(2.0, 3.0, -k) / special.exprel(-k) - mean,
        (np.zeros_like(lower), 2.0 / lower),
        args=(lower,),
    ).x
    steepness: np.ndarray = np.where(means < 0.5, found, -found)
    return steepness


def cumulative_share(steepness: Any, u: np.ndarray) -> np.ndarray:
    """Cumulative distribution function at u; arguments broadcast."""
    from scipy import special

    k = np.abs(steepness)
    share: np.ndarray = u * special.exprel(-k * u) / special.exprel(-k)
    # With exp k divided out, which overflows.
    return np.where(steepness < 0.0, np.exp(-k * (1.0 - u)) * share, share)


def quantile(steepness: float, share: np.ndarray) -> np.ndarray:
    """Inverse of `cumulative_share` for k ≥ 0."""
    u: np.ndarray = -np.log1p(share * np.expm1(-steepness)) / steepness if steepness > 0.0 else share
    return u


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
    from scipy import special

    k = np.abs(solve_steepness(means))
    likelihood: np.ndarray = -np.log(special.exprel(-k)) - k * np.minimum(means, 1.0 - means)
    return likelihood
