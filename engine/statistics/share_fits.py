"""Our own fits to the shares of those that escape, of the paper's form, with intervals; and how far off a curve is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy import optimize, stats

from engine.statistics.published_fits import HyperbolicTangent, Polynomial, ShareCurve, written
from engine.validation import read_array, read_count, read_integers, shown

LARGEST_DEGREE = 6
"""Highest degree of a polynomial: beyond it one fits the scatter."""

_CONFIDENCE = 0.95
# With fewer energies more than there are parameters, nothing can be said of the intervals.
_SPARE_ENERGIES = 2
# For a first guess shares are held this far from 0 and 1, where the inverse of the curve is infinite.
_SATURATED = 0.01
# Shares strictly between 0 and 1 that it takes to say how steep a curve is.
_FEWEST_BETWEEN = 3
# The least squares are solved to rounding.
_EXACT = 1e-14
# An energy with this leverage fixes a parameter alone: there is no residual to judge it by.
_WHOLE_LEVERAGE = 1.0 - 1e-9


@dataclass(frozen=True)
class Deviation:
    """How far a curve is from data.

    Attributes
    ----------
    largest
        Curve less data where they differ most; 0.01 is one point of percentage.
    energy
        h there.
    rms
        Root of the mean square over all energies.
    """

    largest: float
    energy: float
    rms: float

    def describe(self) -> str:
        """In words."""
        if np.isnan(self.largest):
            return "there is no curve to compare with the data"
        side = "above" if self.largest >= 0.0 else "below"
        return (
            f"at most {100 * abs(self.largest):.1f} points {side} the data, at h = {self.energy:g}; "
            f"{100 * self.rms:.1f} points root mean square"
        )


@dataclass(frozen=True, eq=False)
class ShareFit:
    """A curve fitted to shares against energy; arrays are read-only.

    Attributes
    ----------
    curve
        The curve; its parameters are NaN where the data do not determine them.
    intervals
        For each parameter, by name, the lower and upper end of its 95 % interval; infinite where one energy alone decides.
    deviation
        Of the curve from the data it is fitted to.
    energies, shares
        (m,) the data.
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
        """The fit in two sentences, or what stands in its way."""
        if not self.determined:
            return f"No fit: {self.energies.size} energies with shares from {self.shares.min():.3g} to {self.shares.max():.3g}."
        values = (
            f"{name} = {written(value)} ({written(self.intervals[name][0])} to {written(self.intervals[name][1])})"
            for name, value in self.curve.parameters.items()
        )
        return f"{self.curve.formula} with {', '.join(values)}. It lies {self.deviation.describe()}."


def fit_escape_shares(h: Any, escaped: Any, starts: Any) -> ShareFit:
    """Fit Ne/N0 = ½[1 + tanh(a h − b)], the form of Zotos (2014), by least squares; every energy weighs the same.

    The intervals are not binomial. Starts stand on a grid, so that their counts scatter less than draws would, and what parts the
    data from the curve is that the form is only a convention: islands come and go with h. Residuals are therefore systematic, and
    larger maps would not shrink them. The interval says how much a parameter would change had other energies been drawn at random
    from the same range with the same density: the sandwich of White (1980, Econometrica 48, 817), with residuals divided by one
    less their leverage (HC3; MacKinnon & White 1985, J. Econometrics 29, 305) and Student's t. In trials it held the true
    parameters in 92 % or more where the form was true, and those of the best curve through all energies in 80 to 94 %
    where it was not and 25 energies were random; evenly spaced ones scatter far less, and it always did. Energies spread
    otherwise have another best curve, maybe beyond the interval.

    Parameters
    ----------
    h
        (m,) energies, dimensionless, all different, finite, 4 or more.
    escaped
        (m,) integers, Ne at each, from 0 to N0.
    starts
        (m,) integers, N0 at each, 1 or more.

    Returns
    -------
    The `ShareFit`; parameters are NaN when fewer than 3 shares lie between 0 and 1, so that any steep curve would do.

    Raises
    ------
    ValueError
        When a parameter is out of its range.
    """
    energies, shares = _checked_shares(h, "escaped", escaped, starts, parameters=2)
    if np.count_nonzero((shares > 0.0) & (shares < 1.0)) < _FEWEST_BETWEEN:
        return _gather(HyperbolicTangent(np.nan, np.nan), np.full(2, np.nan), energies, shares)
    middle, width = energies.mean(), np.ptp(energies)
    lever = np.column_stack([(energies - middle) / width, np.full(energies.size, -1.0)])

    def residuals(parameters: np.ndarray) -> Any:
        return 0.5 * (1.0 + np.tanh(lever @ parameters)) - shares

    def slopes(parameters: np.ndarray) -> Any:
        return 0.5 * (1.0 - np.tanh(lever @ parameters)[:, None] ** 2) * lever

    guess = np.linalg.lstsq(lever, np.arctanh(2.0 * np.clip(shares, _SATURATED, 1.0 - _SATURATED) - 1.0))[0]
    found = optimize.least_squares(residuals, guess, slopes, method="lm", xtol=_EXACT, ftol=_EXACT, gtol=_EXACT).x
    # From (h − middle) / width back to h.
    back = np.array([[1.0 / width, 0.0], [middle / width, 1.0]])
    half_widths = _find_half_widths(slopes(found), residuals(found), back)
    return _gather(HyperbolicTangent(*(back @ found).tolist()), half_widths, energies, shares)


def fit_direct_shares(h: Any, direct: Any, starts: Any, degree: int = 3) -> ShareFit:
    """Fit Nde/N0 = c0 + c1 h + … by least squares, as Zotos (2014) does with degree 3 (I, II) and 2 (III).

    Weights and intervals as of `fit_escape_shares`; nothing holds the polynomial between 0 and 1 outside the data.

    Parameters
    ----------
    h
        (m,) energies, dimensionless, all different, finite, `degree` + 3 or more.
    direct
        (m,) integers, Nde at each, from 0 to N0.
    starts
        (m,) integers, N0 at each, 1 or more.
    degree
        Of the polynomial, 1 to 6.

    Returns
    -------
    The `ShareFit`, of a `Polynomial`.

    Raises
    ------
    ValueError
        When a parameter is out of its range.
    """
    degree = read_count("degree", degree, 1, LARGEST_DEGREE)
    energies, shares = _checked_shares(h, "direct", direct, starts, parameters=degree + 1)
    middle, width = energies.mean(), np.ptp(energies)
    powers = np.vander((energies - middle) / width, degree + 1, increasing=True)
    found = np.linalg.lstsq(powers, shares)[0]
    back = _shifted_powers(middle, width, degree)
    half_widths = _find_half_widths(powers, shares - powers @ found, back)
    return _gather(Polynomial(tuple((back @ found).tolist())), half_widths, energies, shares)


def measure_deviation(curve: Callable[[Any], Any], h: Any, counts: Any, starts: Any) -> Deviation:
    """How far a curve, such as one of `PAPER_FITS`, is from counts out of N0 at energies h; all (m,), m of 1 or more.

    Raises
    ------
    ValueError
        When a parameter is out of the range given at `fit_escape_shares`.
    """
    energies, shares = _checked_shares(h, "counts", counts, starts, parameters=None)
    return _find_deviation(curve, energies, shares)


def _find_deviation(curve: Callable[[Any], Any], energies: np.ndarray, shares: np.ndarray) -> Deviation:
    apart = np.asarray(curve(energies) - shares, dtype=float)
    place = int(np.argmax(np.abs(apart)))
    return Deviation(float(apart[place]), float(energies[place]), float(np.sqrt(np.mean(apart**2))))


def _find_half_widths(slopes: np.ndarray, residuals: np.ndarray, back: np.ndarray) -> np.ndarray:
    """(p,) of the intervals of the parameters `back` @ those with slopes J (m, p).

    The covariance is the sandwich (JᵀJ)⁻¹ Jᵀ diag(r² / (1 − leverage)²) J (JᵀJ)⁻¹.
    """
    (count, parameters), (q, r) = slopes.shape, np.linalg.qr(slopes)
    leverage = np.sum(q * q, axis=1)
    if leverage.max() > _WHOLE_LEVERAGE or np.linalg.matrix_rank(slopes) < parameters:
        return np.full(parameters, np.inf)
    half = back @ np.linalg.inv(r) @ (q * (residuals / (1.0 - leverage))[:, None]).T
    quantile = stats.t.ppf(0.5 * (1.0 + _CONFIDENCE), count - parameters)
    half_widths: np.ndarray = quantile * np.sqrt(np.sum(half * half, axis=1))
    return half_widths


def _shifted_powers(middle: float, width: float, degree: int) -> np.ndarray:
    """The matrix that takes coefficients in (h − middle) / width to those in h."""
    columns = np.zeros((degree + 1, degree + 1))
    power = np.ones(1)
    for place in range(degree + 1):
        columns[: place + 1, place] = power
        power = np.convolve(power, [-middle / width, 1.0 / width])
    return columns


def _gather(curve: ShareCurve, half_widths: np.ndarray, energies: np.ndarray, shares: np.ndarray) -> ShareFit:
    values = zip(curve.parameters.items(), half_widths.tolist(), strict=True)
    intervals = {name: (value - half, value + half) for (name, value), half in values}
    return ShareFit(curve, MappingProxyType(intervals), _find_deviation(curve, energies, shares), energies, shares)


def _checked_shares(h: Any, name: str, counts: Any, starts: Any, *, parameters: int | None) -> tuple[np.ndarray, np.ndarray]:
    """Energies and shares (m,); enough of them to fit so many parameters, or at least one."""
    energies = read_array("h", h).copy()
    fewest = 1 if parameters is None else parameters + _SPARE_ENERGIES
    usable = energies.ndim == 1 and energies.size >= fewest and np.isfinite(energies).all()
    if not usable or np.unique(energies).size < energies.size:
        raise ValueError(f"h={shown(h)}: must be {fewest} or more different finite numbers in a row")
    part, whole = read_integers(name, counts), read_integers("starts", starts)
    for label, array in ((name, part), ("starts", whole)):
        if array.shape != energies.shape:
            raise ValueError(f"{label}={shown(array)}: must be integers, as many as energies, {energies.size}")
    if np.any(whole < 1):
        raise ValueError(f"starts={shown(starts)}: must be 1 or more")
    if np.any((part < 0) | (part > whole)):
        raise ValueError(f"{name}={shown(counts)}: must be from 0 to starts={shown(starts)}")
    shares = part / whole
    for array in (energies, shares):
        array.flags.writeable = False
    return energies, shares
