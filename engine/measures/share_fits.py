"""Fits of the forms of Zotos (2014) to shares of escapes against energy, with intervals; deviation of a curve from shares."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from engine.measures.published_fits import HyperbolicTangent, Polynomial, ShareCurve
from engine.results.arrays import read_only
from engine.results.result import Result
from engine.results.wording import format_number
from engine.validation import checked_array, checked_count, checked_integers, checks_types, short_repr

MAX_DEGREE = 6
"""Highest degree of a polynomial fit; higher degrees fit the scatter."""

_CONFIDENCE = 0.95
# Intervals take at least this many energies more than there are parameters.
_SPARE_ENERGIES = 2
# Shares are limited to this distance from 0 and 1 for the initial guess, where the inverse of the curve diverges.
_SATURATED = 0.01
# Fewest shares strictly between 0 and 1 that determine the slope of the curve.
_MIN_UNSATURATED = 3
# Tolerance of the least-squares solver, at the level of rounding.
_TOLERANCE = 1e-14
# An energy with a leverage above this determines a parameter alone and leaves no residual.
_MAX_LEVERAGE = 1.0 - 1e-9


@dataclass(frozen=True)
class Deviation:
    """Deviation of a curve from shares, dimensionless.

    Attributes
    ----------
    largest
        Curve minus data at the energy of the largest difference; 0.01 is one percentage point.
    energy
        h of the largest difference.
    rms
        Root mean square of the differences.
    """

    largest: float
    energy: float
    rms: float

    def describe(self) -> str:
        """The deviation as part of a sentence."""
        if np.isnan(self.largest):
            return "at no defined distance from the data"
        side = "above" if self.largest >= 0.0 else "below"
        return (
            f"at most {100 * abs(self.largest):.1f} percentage points {side} the data, at h = {self.energy:g}, "
            f"with a root mean square of {100 * self.rms:.1f}"
        )


@dataclass(frozen=True, eq=False, repr=False)
class ShareFit(Result):
    """A curve fitted to shares against energy; arrays are read-only.

    Attributes
    ----------
    curve
        The fitted curve; its parameters are NaN if the data do not determine them.
    intervals
        Lower and upper end of the 95 % interval of each parameter, by name; infinite if a single energy determines it.
    deviation
        Deviation of the curve from the data.
    energies, shares
        (m,) the data, dimensionless.
    """

    curve: ShareCurve
    intervals: Mapping[str, tuple[float, float]]
    deviation: Deviation
    energies: np.ndarray = field(repr=False)
    shares: np.ndarray = field(repr=False)

    @property
    def determined(self) -> bool:
        """Whether the data determine the curve."""
        return all(np.isfinite(value) for value in self.curve.parameters.values())

    def describe(self) -> str:
        """The fit, or why there is none, in one or two sentences."""
        if not self.determined:
            low, high = self.shares.min(), self.shares.max()
            return f"No fit: the shares, from {low:.3g} to {high:.3g} at {self.energies.size} energies, determine no curve."
        values = (
            f"{name} = {format_number(value)} ({' to '.join(map(format_number, self.intervals[name]))})"
            for name, value in self.curve.parameters.items()
        )
        return f"{self.curve.formula} with {', '.join(values)}. It lies {self.deviation.describe()}."


def fit_escape_shares(h: Any, escaped: Any, starts: Any) -> ShareFit:
    """Fit Ne/N0 = ½[1 + tanh(a h − b)], the form of Zotos (2014), by least squares with equal weights.

    The intervals are not binomial: counts of starts on a grid scatter less than random draws, and the deviation of the data from
    the curve is systematic, since the form is only a convention and islands appear and vanish with h. Larger maps would not
    reduce it. An interval states how much a parameter would change for other energies drawn at random from the same range with
    the same density: the sandwich covariance of White (1980, Econometrica 48, 817), with residuals divided by one minus their
    leverage (HC3; MacKinnon & White 1985, J. Econometrics 29, 305), and Student's t. In trials the intervals held the true
    parameters in 92 % or more of the cases where the form was true, and those of the best curve through all energies in 80 to
    94 % where it was not and 25 energies were random. They always held for evenly spaced energies, which scatter much less. For
    a different density of energies the best curve differs and can lie outside the interval.

    Parameters
    ----------
    h
        (m,) energies, dimensionless, all different, finite, 4 or more.
    escaped
        (m,) integers, Ne at each energy, from 0 to N0.
    starts
        (m,) integers, N0 at each energy, 1 or more.

    Returns
    -------
    The `ShareFit`; its parameters are NaN if fewer than 3 shares lie strictly between 0 and 1, which leaves the slope
    undetermined.

    Raises
    ------
    ValueError
        If a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import fit_escape_shares
    >>> fit = fit_escape_shares((0.30, 0.35, 0.40, 0.45), (26, 73, 95, 99), (100, 100, 100, 100))
    >>> fit.curve.formula
    '½[1 + tanh(20.27 h − 6.601)]'
    >>> [round(end, 1) for end in fit.intervals["a"]]
    [15.8, 24.7]
    """
    energies, shares = _checked_shares(h, "escaped", escaped, starts, parameters=2)
    if np.count_nonzero((shares > 0.0) & (shares < 1.0)) < _MIN_UNSATURATED:
        return _build_fit(HyperbolicTangent(np.nan, np.nan), np.full(2, np.nan), energies, shares)
    guess = np.arctanh(2.0 * np.clip(shares, _SATURATED, 1.0 - _SATURATED) - 1.0)
    (constant, slope), half_widths = _fit(lambda line: 0.5 * (1.0 + np.tanh(line)), guess, 1, energies, shares)
    return _build_fit(HyperbolicTangent(slope, -constant), half_widths[::-1], energies, shares)


def fit_direct_shares(h: Any, direct: Any, starts: Any, *, degree: int = 3) -> ShareFit:
    """Fit Nde/N0 = c0 + c1 h + … by least squares, as Zotos (2014) does with degree 3 (I, II) and 2 (III).

    Weights and intervals are those of `fit_escape_shares`. Outside the data the polynomial can leave the range 0 to 1.

    Parameters
    ----------
    h
        (m,) energies, dimensionless, all different, finite, `degree` + 3 or more.
    direct
        (m,) integers, Nde at each energy, from 0 to N0.
    starts
        (m,) integers, N0 at each energy, 1 or more.
    degree
        Degree of the polynomial, 1 to 6.

    Returns
    -------
    The `ShareFit` with a `Polynomial`.

    Raises
    ------
    ValueError
        If a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import fit_direct_shares
    >>> fit = fit_direct_shares((0.3, 0.4, 0.5, 0.6), (20, 41, 58, 81), (100, 100, 100, 100), degree=1)
    >>> fit.curve.formula
    '−0.4 + 2 h'
    >>> [round(end, 2) for end in fit.intervals["c1"]]
    [1.55, 2.45]
    """
    degree = checked_count("degree", degree, 1, MAX_DEGREE)
    energies, shares = _checked_shares(h, "direct", direct, starts, parameters=degree + 1)
    coefficients, half_widths = _fit(lambda polynomial: polynomial, shares, degree, energies, shares)
    return _build_fit(Polynomial(tuple(coefficients)), half_widths, energies, shares)


@checks_types(curve=Callable)
def measure_deviation(curve: Callable[[Any], Any], h: Any, counts: Any, starts: Any) -> Deviation:
    """Measure the deviation of a curve, such as one of `PAPER_FITS`, from observed shares.

    Parameters
    ----------
    curve
        Function from energies (m,) to shares (m,).
    h
        (m,) energies, dimensionless, all different, finite, 1 or more.
    counts
        (m,) integers, number of starts with the property at each energy, from 0 to N0.
    starts
        (m,) integers, N0 at each energy, 1 or more.

    Raises
    ------
    ValueError
        If a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import PAPER_FITS, measure_deviation
    >>> deviation = measure_deviation(PAPER_FITS["III"].escaped, (0.3, 0.4, 0.5), (460, 850, 990), (1000, 1000, 1000))
    >>> print(deviation.describe())
    at most 9.4 percentage points above the data, at h = 0.4, with a root mean square of 6.1
    """
    energies, shares = _checked_shares(h, "counts", counts, starts, parameters=None)
    return _find_deviation(curve, energies, shares)


def _find_deviation(curve: Callable[[Any], Any], energies: np.ndarray, shares: np.ndarray) -> Deviation:
    difference = np.asarray(curve(energies) - shares, dtype=float)
    largest = int(np.argmax(np.abs(difference)))
    return Deviation(float(difference[largest]), float(energies[largest]), float(np.sqrt(np.mean(difference**2))))


def _fit(
    curve: Callable[[np.ndarray], np.ndarray], guess: np.ndarray, degree: int, energies: np.ndarray, shares: np.ndarray
) -> tuple[list[float], np.ndarray]:
    """Fit `curve` of a polynomial in h to the shares: coefficients, lowest power first, and half widths of their intervals.

    It starts from the polynomial closest to `guess` (m,).
    """
    from scipy import optimize

    # Powers of h itself are nearly dependent, so the parameters are those of powers of u, which runs from −1 to 1.
    domain = [energies.min(), energies.max()]
    u = np.polynomial.polyutils.mapdomain(energies, domain, (-1.0, 1.0))
    powers = np.vander(u, degree + 1, increasing=True)
    found = optimize.least_squares(
        lambda parameters: curve(powers @ parameters) - shares, np.linalg.lstsq(powers, guess)[0], "3-point", method="lm",
        xtol=_TOLERANCE, ftol=_TOLERANCE, gtol=_TOLERANCE,
    )  # fmt: skip
    to_energy = np.zeros((degree + 1, degree + 1))
    for power in range(degree + 1):
        to_energy[: power + 1, power] = np.polynomial.Polynomial.basis(power, domain).convert().coef
    return (to_energy @ found.x).tolist(), _find_half_widths(found.jac, found.fun, to_energy)


def _find_half_widths(jacobian: np.ndarray, residuals: np.ndarray, transform: np.ndarray) -> np.ndarray:
    """(p,) half widths of the intervals of `transform` @ the parameters with Jacobian J (m, p).

    The covariance of the latter is the sandwich (JᵀJ)⁻¹ Jᵀ diag(r² / (1 − leverage)²) J (JᵀJ)⁻¹.
    """
    from scipy import special

    count, parameters = jacobian.shape
    inverse = np.linalg.pinv(jacobian)
    leverage = np.sum(jacobian.T * inverse, axis=0)
    if leverage.max() > _MAX_LEVERAGE or np.linalg.matrix_rank(jacobian) < parameters:
        return np.full(parameters, np.inf)
    root = transform @ inverse * (residuals / (1.0 - leverage))
    quantile = special.stdtrit(count - parameters, 0.5 * (1.0 + _CONFIDENCE))
    half_widths: np.ndarray = quantile * np.linalg.norm(root, axis=1)
    return half_widths


def _build_fit(curve: ShareCurve, half_widths: np.ndarray, energies: np.ndarray, shares: np.ndarray) -> ShareFit:
    values = zip(curve.parameters.items(), half_widths.tolist(), strict=True)
    intervals = {name: (value - half, value + half) for (name, value), half in values}
    return ShareFit(curve, MappingProxyType(intervals), _find_deviation(curve, energies, shares), energies, shares)


def _checked_shares(h: Any, name: str, counts: Any, starts: Any, *, parameters: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Energies and shares (m,): enough to fit this many parameters, or at least one energy if None."""
    energies = checked_array("h", h).copy()
    min_size = 1 if parameters is None else parameters + _SPARE_ENERGIES
    usable = energies.ndim == 1 and energies.size >= min_size and np.isfinite(energies).all()
    if not usable or np.unique(energies).size < energies.size:
        raise ValueError(f"h={short_repr(h)}: must be a sequence of {min_size} or more different finite numbers")
    part, total = checked_integers(name, counts), checked_integers("starts", starts)
    for label, array in ((name, part), ("starts", total)):
        if array.shape != energies.shape:
            raise ValueError(f"{label}={short_repr(array)}: must be one integer per energy, {energies.size}")
    if np.any(total < 1):
        raise ValueError(f"starts={short_repr(starts)}: must be 1 or more")
    if np.any((part < 0) | (part > total)):
        raise ValueError(f"{name}={short_repr(counts)}: must be from 0 to starts={short_repr(starts)}")
    return read_only(energies), read_only(part / total)
