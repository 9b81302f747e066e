"""Fit the forms of Zotos (2014) to shares of escapes against energy, with intervals, and measure deviations from shares."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize, special

from engine.results import Sweep
from engine.systems.catalogue.published_fits import PAPER_FITS, HyperbolicTangent, Polynomial, ShareCurve

# Confidence level of the intervals.
_CONFIDENCE = 0.95
# Smallest distance of shares from 0 and 1 in the initial guess, because the inverse of the curve diverges at 0 and 1.
_SATURATION = 0.01
# Smallest number of shares strictly between 0 and 1 that determine the slope of the curve.
_MIN_UNSATURATED = 3
# Tolerance of the least-squares solver, at the level of rounding.
_TOLERANCE = 1e-14
# Largest leverage of an energy. With a larger leverage, the energy alone determines a parameter, and has no residual.
_MAX_LEVERAGE = 1.0 - 1e-9


@dataclass(frozen=True)
class Deviation:
    """Deviation of a curve from shares, dimensionless.

    Attributes
    ----------
    largest
        Curve minus data at the energy of the largest difference. A value of 0.01 is one percentage point.
    energy
        h of the largest difference.
    rms
        Root mean square of the differences.
    """

    largest: float
    energy: float
    rms: float

    def describe(self) -> str:
        """Return the deviation as part of a sentence."""
        if np.isnan(self.largest):
            return "at no defined distance from the data"
        side = "above" if self.largest >= 0.0 else "below"
        return (
            f"at most {100 * abs(self.largest):.1f} percentage points {side} the data, at h = {self.energy:g}, "
            f"with a root mean square of {100 * self.rms:.1f}"
        )


@dataclass(frozen=True, eq=False)
class ShareFit:
    """A curve fitted to shares against energy.

    Attributes
    ----------
    curve
        The fitted curve, with NaN for parameters that the data do not determine.
    intervals
        Lower and upper end of the 95 % interval of each parameter, by name; infinite if a single energy determines the parameter.
    deviation
        Deviation of the curve from the data.
    """

    curve: ShareCurve
    intervals: Mapping[str, tuple[float, float]]
    deviation: Deviation

    @property
    def determined(self) -> bool:
        """Whether the data determine the curve."""
        return all(np.isfinite(value) for value in self.curve.parameters.values())


@dataclass(frozen=True, eq=False)
class CaseFit:
    """Computed shares of a case on (x, px), with the published and the new curve.

    Attributes
    ----------
    name
        Name of the share.
    h, shares
        Energies, and the share at each energy, each of shape (m,).
    published
        The curve of the paper.
    fitted
        The new fit.
    """

    name: str
    h: np.ndarray
    shares: np.ndarray
    published: ShareCurve
    fitted: ShareFit


def fit_case(case: str, curves: Sweep) -> tuple[CaseFit, CaseFit]:
    """Return the fits of Ne/N0 and of Nde/N0 to the shares of a case."""
    h, paper = curves.values, PAPER_FITS[case]
    escaped, direct = curves["share"][:, 1:].sum(axis=1), curves["direct_share"]
    return (
        CaseFit("Ne/N0", h, escaped, paper.escaped, fit_escape_shares(h, escaped)),
        CaseFit("Nde/N0", h, direct, paper.direct, fit_direct_shares(h, direct, paper.direct.degree)),
    )


def fit_escape_shares(h: np.ndarray, shares: np.ndarray) -> ShareFit:
    """Fit Ne/N0 = ½[1 + tanh(a h − b)], the form of Zotos (2014), by least squares with equal weights.

    The intervals are not binomial. Counts of starts on a grid scatter less than random draws, and the data deviate from the curve
    systematically, because the form is only a convention and islands appear and vanish with h. Larger maps would not reduce this
    deviation. An interval states how much a parameter would change for other energies, drawn at random from the same range with
    the same density. Intervals use the sandwich covariance of White (1980, Econometrica 48, 817), with residuals divided by one
    minus their leverage (HC3; MacKinnon & White 1985, J. Econometrics 29, 305), and Student's t. In trials in which the form was
    true, at least 92 % of the intervals contained the true parameters. In trials with another form and 25 random energies, 80 to
    94 % contained the parameters of the best curve through all energies. With evenly spaced energies, where fits scatter much
    less, all did. For another density of energies the best curve differs, and its parameters can lie outside the intervals.

    Parameters
    ----------
    h
        At least 4 different energies (dimensionless), of shape (m,).
    shares
        Ne/N0 at each energy, of shape (m,).

    Returns
    -------
    The `ShareFit`. Its parameters are NaN if fewer than 3 shares are strictly between 0 and 1, because fewer do not determine the
    slope.
    """
    if np.count_nonzero((shares > 0.0) & (shares < 1.0)) < _MIN_UNSATURATED:
        return _build_fit(HyperbolicTangent(np.nan, np.nan), np.full(2, np.nan), h, shares)
    guess = np.arctanh(2.0 * np.clip(shares, _SATURATION, 1.0 - _SATURATION) - 1.0)
    (constant, slope), half_widths = _fit(lambda line: 0.5 * (1.0 + np.tanh(line)), guess, 1, h, shares)
    return _build_fit(HyperbolicTangent(slope, -constant), half_widths[::-1], h, shares)


def fit_direct_shares(h: np.ndarray, shares: np.ndarray, degree: int) -> ShareFit:
    """Fit Nde/N0 = c0 + c1 h + … by least squares, as Zotos (2014) does with degree 3 (I, II) and 2 (III).

    Weights and intervals are those of `fit_escape_shares`. At least `degree` + 3 energies are needed. Outside the range of the
    data, the polynomial can be below 0 or above 1.
    """
    coefficients, half_widths = _fit(lambda polynomial: polynomial, shares, degree, h, shares)
    return _build_fit(Polynomial(tuple(coefficients)), half_widths, h, shares)


def measure_deviation(curve: Callable[[Any], Any], h: np.ndarray, shares: np.ndarray) -> Deviation:
    """Measure the deviation of a curve, such as one of `PAPER_FITS`, from the shares (m,) at energies (m,)."""
    difference = np.asarray(curve(h) - shares, dtype=float)
    largest = int(np.argmax(np.abs(difference)))
    return Deviation(float(difference[largest]), float(h[largest]), float(np.sqrt(np.mean(difference**2))))


def _fit(
    curve: Callable[[np.ndarray], np.ndarray], guess: np.ndarray, degree: int, h: np.ndarray, shares: np.ndarray
) -> tuple[list[float], np.ndarray]:
    """Fit `curve`, a function of the values of a polynomial in h, to shares.

    The fit begins with the polynomial closest to `guess`, of shape (m,). Return the coefficients, lowest power first, and the
    half widths of their intervals.
    """
    powers = np.vander(h, degree + 1, increasing=True)
    solution = optimize.least_squares(
        lambda parameters: curve(powers @ parameters) - shares, np.linalg.lstsq(powers, guess)[0], "3-point", method="lm",
        x_scale="jac", xtol=_TOLERANCE, ftol=_TOLERANCE, gtol=_TOLERANCE,
    )  # fmt: skip
    return solution.x.tolist(), _find_half_widths(solution.jac, solution.fun)


def _find_half_widths(jacobian: np.ndarray, residuals: np.ndarray) -> np.ndarray:
    """Return the half widths of the intervals of p parameters, given the Jacobian J of shape (m, p).

    The covariance of the parameters is the sandwich (JᵀJ)⁻¹ Jᵀ diag(r² / (1 − leverage)²) J (JᵀJ)⁻¹.
    """
    energy_count, parameter_count = jacobian.shape
    inverse = np.linalg.pinv(jacobian)
    leverage = np.sum(jacobian.T * inverse, axis=0)
    if leverage.max() > _MAX_LEVERAGE or np.linalg.matrix_rank(jacobian) < parameter_count:
        return np.full(parameter_count, np.inf)
    quantile = special.stdtrit(energy_count - parameter_count, 0.5 * (1.0 + _CONFIDENCE))
    return quantile * np.linalg.norm(inverse * (residuals / (1.0 - leverage)), axis=1)


def _build_fit(curve: ShareCurve, half_widths: np.ndarray, h: np.ndarray, shares: np.ndarray) -> ShareFit:
    values = zip(curve.parameters.items(), half_widths.tolist(), strict=True)
    intervals = {name: (value - half, value + half) for (name, value), half in values}
    return ShareFit(curve, intervals, measure_deviation(curve, h, shares))
