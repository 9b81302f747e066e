"""Fits of uncertain pairs recover exact power laws and the dimension of the Cantor set."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import stats

from engine.measures.basins.power_law_fit import UncertaintyExponent, fit_uncertainty

SEPARATIONS = np.geomspace(1e-2, 1e-10, 17)
TRIALS = 100
FALSE_ALARM = 1e-7
"""Probability that a test of random counts fails though the fits are correct."""


def law(alpha: float, amplitude: float, bend_at: float = np.inf) -> np.ndarray:
    """Return shares A ε^α that saturate above `bend_at`."""
    return amplitude * SEPARATIONS**alpha / (1.0 + SEPARATIONS / bend_at) ** alpha


def counts(share: np.ndarray, random: np.random.Generator | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return random or expected counts of pairs, with about 200 uncertain pairs at each separation."""
    pairs = np.clip(200.0 / share, 200.0, 2e5).astype(int)
    return SEPARATIONS, pairs, np.rint(pairs * share).astype(int) if random is None else random.binomial(pairs, share)


def fit_set(label: Callable[[np.ndarray], np.ndarray], pairs: int, smallest: float = 1e-9) -> UncertaintyExponent:
    """Return the exponent of a labelled interval [0, 1], from random pairs of points."""
    random = np.random.default_rng(5)
    separations = np.geomspace(1e-2, smallest, 15)
    points = random.uniform(0.0, 1.0, (separations.size, pairs))
    uncertain = (label(points) != label(points + separations[:, None])).sum(axis=1)
    return fit_uncertainty(separations, np.full(separations.size, pairs), uncertain)


def is_near(fit: UncertaintyExponent, exponent: float) -> bool:
    """Return whether an exponent is within 5.5 standard errors. Correct fits are, with a probability of 1 − 4e-8."""
    return abs(fit.exponent - exponent) < 5.5 * (fit.high - fit.low) / 3.92


def gap_of_cantor_set(x: np.ndarray) -> np.ndarray:
    """Return, modulo 3, the step at which the middle-thirds construction removes each point of [0, 1], or 40 without one."""
    step = np.full(x.shape, 40)
    for number in range(40):
        x = 3.0 * x
        step[(x > 1.0) & (x < 2.0) & (step == 40)] = number
        x = x - np.floor(np.minimum(x, 2.0))
    return step % 3


def test_an_exact_power_law_is_recovered() -> None:
    fit = fit_uncertainty(SEPARATIONS, np.full(17, 10**12), np.rint(1e12 * law(0.3, 0.5)).astype(int))
    assert fit.exponent == pytest.approx(0.3, abs=1e-5)
    assert fit.amplitude == pytest.approx(0.5, rel=1e-4)
    assert fit.dimension == pytest.approx(1.7, abs=1e-5)


def test_the_cantor_set_has_its_known_dimension() -> None:
    fit = fit_set(gap_of_cantor_set, 20_000)
    known = 1.0 - np.log(2.0) / np.log(3.0)
    assert is_near(fit, known)
    assert fit.high - fit.low < 0.05


def test_the_interval_has_95_percent_coverage() -> None:
    alpha, random = 0.02, np.random.default_rng(3)
    fits = [fit_uncertainty(*counts(law(alpha, 0.6), random)) for _ in range(TRIALS)]
    held = [fit.low <= alpha <= fit.high for fit in fits if np.isfinite(fit.exponent)]
    assert len(held) > 0.85 * TRIALS
    assert stats.binomtest(sum(held), len(held), 0.95).pvalue > FALSE_ALARM


def test_saturated_separations_are_left_out() -> None:
    fit = fit_uncertainty(*counts(law(0.25, 2.0, 1e-4)))
    assert not fit.used[SEPARATIONS > 1e-4].any()
    assert fit.used[SEPARATIONS < 1e-6].all()


def test_separations_with_too_few_uncertain_pairs_are_left_out() -> None:
    share = law(0.3, 0.9)
    pairs = np.full(17, 2000)
    fit = fit_uncertainty(SEPARATIONS, pairs, np.rint(pairs * share).astype(int))
    assert not fit.used[pairs * share < 3.0].any()
    assert fit.used[(pairs * share > 8.0) & (SEPARATIONS < 1e-4)].all()


def test_shares_that_bend_everywhere_have_no_exponent() -> None:
    share = 0.3 * np.exp(-(np.log(SEPARATIONS / 1e-2) ** 2) / 60.0)
    fit = fit_uncertainty(SEPARATIONS, np.full(17, 10**7), np.rint(1e7 * share).astype(int))
    assert np.isnan([fit.exponent, fit.low, fit.high, fit.amplitude, fit.dimension]).all()
    assert fit.describe().startswith("No uncertainty exponent: no power law describes")


@pytest.mark.parametrize(
    ("pairs", "uncertain", "sentence"),
    [
        (np.full(17, 100), np.zeros(17, int), "both orbits have the same fate in all 1 700 pairs"),
        (np.zeros(17, int), np.zeros(17, int), "no pair of starts lies inside"),
        (np.full(17, 100), np.arange(17)[::-1] // 5, "are too few, or cover too short a range of separations"),
    ],
)
def test_the_description_gives_the_reason_without_an_exponent(pairs: np.ndarray, uncertain: np.ndarray, sentence: str) -> None:
    fit = fit_uncertainty(SEPARATIONS, pairs, uncertain)
    assert np.isnan(fit.exponent)
    assert sentence in fit.describe()


@pytest.mark.parametrize(
    ("separations", "pairs", "uncertain", "message"),
    [
        ([1e-2, 0.0], [1, 1], [0, 0], "separations=.* above 0"),
        ([1e-2, 1e-2], [1, 1], [0, 0], "separations=.* different"),
        ([1e-2, 1e-3], [1, 1, 1], [0, 0], "pairs=.* must be one integer per separation, 2"),
        ([1e-2, 1e-3], [1, 1], [0, 2], "uncertain=.* from 0 to pairs"),
    ],
)
def test_invalid_counts_raise(separations: Any, pairs: Any, uncertain: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        fit_uncertainty(separations, pairs, uncertain)
