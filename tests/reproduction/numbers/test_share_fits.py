"""Fits of shares recover curves, and their intervals cover the true parameters."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import binom

from engine.systems.catalogue.published_fits import HyperbolicTangent, Polynomial
from reproduction.numbers.share_fits import ShareFit, fit_direct_shares, fit_escape_shares, measure_deviation

ENERGIES = np.linspace(0.26, 0.6, 25)
TANGENT = HyperbolicTangent(15.85, 4.93)
PARABOLA = Polynomial((-1.496, 7.585, -5.938))


def drawn(shares: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return shares of 9000 random starts."""
    return rng.binomial(9000, shares) / 9000


# Fits.


def test_a_hyperbolic_tangent_is_recovered() -> None:
    fit = fit_escape_shares(ENERGIES, TANGENT(ENERGIES))
    assert fit.curve.parameters == pytest.approx({"a": 15.85, "b": 4.93}, rel=1e-6)
    assert abs(fit.deviation.largest) < 1e-8


def test_a_polynomial_fit_agrees_with_numpy() -> None:
    direct = drawn(PARABOLA(ENERGIES), np.random.default_rng(1))
    fit = fit_direct_shares(ENERGIES, direct, 3)
    expected = np.polynomial.polynomial.polyfit(ENERGIES, direct, 3)
    assert list(fit.curve.parameters.values()) == pytest.approx(expected.tolist(), rel=1e-7)


def test_the_interval_of_a_line_is_the_sandwich_formula() -> None:
    direct = drawn(np.linspace(0.2, 0.8, 12), np.random.default_rng(2))
    h = np.linspace(0.2, 0.5, 12) ** 1.5
    fit = fit_direct_shares(h, direct, 1)
    design = np.column_stack([np.ones(12), h])
    bread = np.linalg.inv(design.T @ design)
    leverage = np.diag(design @ bread @ design.T)
    residuals = direct - design @ list(fit.curve.parameters.values())
    covariance = bread @ design.T @ np.diag((residuals / (1.0 - leverage)) ** 2) @ design @ bread
    # Student's t with 10 degrees of freedom: 2.228 (tables).
    expected = 2.2281388 * np.sqrt(np.diag(covariance))
    np.testing.assert_allclose([(high - low) / 2.0 for low, high in fit.intervals.values()], expected, rtol=1e-6)


def in_sample(share: float, count: int, low: float, high: float) -> bool:
    """Return whether a sample with a true share from `low` to `high` may have this share, with a risk of 1e-7 on each side."""
    return bool(binom.ppf(1e-7, count, low) <= share * count <= binom.isf(1e-7, count, high))


def coverage(fits: list[ShareFit], truth: dict[str, float]) -> dict[str, float]:
    return {
        name: float(np.mean([fit.intervals[name][0] <= value <= fit.intervals[name][1] for fit in fits]))
        for name, value in truth.items()
    }


def test_intervals_of_a_tangent_have_about_95_percent_coverage() -> None:
    rng = np.random.default_rng(3)
    held = coverage([fit_escape_shares(ENERGIES, drawn(TANGENT(ENERGIES), rng)) for _ in range(400)], TANGENT.parameters)
    # Of very many draws, 94 to 95 % of the intervals contain the true value.
    assert all(in_sample(share, 400, 0.94, 0.95) for share in held.values()), held


def test_saturated_shares_determine_no_tangent() -> None:
    assert not fit_escape_shares(ENERGIES, np.where(ENERGIES > 0.4, 1.0, 0.0)).determined


def test_a_steep_step_has_very_wide_intervals() -> None:
    escaped = np.where(ENERGIES > 0.4, 1.0, 0.0)
    escaped[[8, 9, 10]] = 1e-9, 0.5, 1.0 - 1e-9
    fit = fit_escape_shares(ENERGIES, escaped)
    assert fit.determined
    assert all(high - low > abs(fit.curve.parameters[name]) for name, (low, high) in fit.intervals.items())


# Deviations.


def test_the_largest_deviation_has_its_energy_and_sign() -> None:
    shares = PARABOLA(ENERGIES)
    shares[7] += 0.05
    found = measure_deviation(PARABOLA, ENERGIES, shares)
    assert found.largest == pytest.approx(-0.05, abs=1e-8)
    assert found.energy == ENERGIES[7]
    assert found.rms == pytest.approx(0.05 / 5.0, abs=1e-8)
