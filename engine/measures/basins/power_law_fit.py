"""Power-law fit to the shares of uncertain pairs: the uncertainty exponent, its interval, and whether a power law holds."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from engine.foundations.result import RecordedResult
from engine.foundations.validation import checked_array, checked_integers, short_repr
from engine.foundations.wording import format_count, format_decimals
from engine.measures.basins.starts import wilson_interval
from engine.systems.well_units import LENGTH, TIME

MIN_EXPECTED_PAIRS = 5.0
"""Smallest expected number of uncertain pairs, and of certain pairs, for a separation to count; χ² requires it (Cochran 1954).

The expected number is used, because the observed number would select separations with many uncertain pairs by chance.
"""

MIN_SEPARATIONS = 5
"""Smallest number of separations for an exponent."""

MIN_DECADES = 1.9
"""Smallest range of separations for an exponent, in decades."""

MAX_BEND = 2.0
"""Largest quadratic term of log f in log ε, in standard errors, at which the curve counts as a straight line."""

TRANSITION_FACTOR = 10.0
"""Ratio of the largest separation of the straight range to that of the fit, because noise hides where a bend ends.

In trials with shares that saturate at some ε, the 95 % interval contained the exponent in 63 to 76 % of the cases without this
factor, and in 94 to 97 % with it.
"""

MIN_PROBABILITY = 1e-4
"""Smallest p value of the χ² test at which a power law is claimed."""

# Probability that the interval of an exponent contains it.
_CONFIDENCE = 0.95
# Relative tolerance for rounding errors of separations.
_ROUNDING = 1e-9
# Slope of the log-likelihood per pair at which its maximisation stops.
_TOLERANCE = 1e-12


def _empty_counts() -> np.ndarray:
    return np.zeros(0, np.int64)


@dataclass(frozen=True, eq=False, repr=False)
class UncertaintyExponent(RecordedResult):
    """Share of uncertain pairs against their separation, and the fitted power law; dimensionless, arrays are read-only.

    Attributes
    ----------
    separations
        (m,) ε, in units of the plane of initial conditions.
    pairs, uncertain
        (m,) int64, number of pairs of starts at each separation, and of pairs with two different fates.
    used
        (m,) bool, the separations in the fit; if there is no exponent, the separations of the last attempt.
    exponent
        α of f(ε) = A ε^α; NaN if the shares follow no power law or are too few.
    low, high
        95 % interval of α; NaN without an exponent.
    amplitude
        A; NaN without an exponent.
    misfit
        χ² per degree of freedom of the used shares about the fitted line; NaN if the shares are too few for a fit.
    one_inside, both_inside
        (m,) int64, numbers of pairs of which one orbit is, or both orbits are, still inside at the horizon. A longer integration
        could change only these pairs. The pairs of `one_inside` are part of `uncertain`. Empty if not known.
    horizon
        Integration time of the orbits, dimensionless; NaN if not known.
    """

    separations: np.ndarray = field(metadata=LENGTH)
    pairs: np.ndarray
    uncertain: np.ndarray
    used: np.ndarray
    exponent: float
    low: float
    high: float
    amplitude: float
    misfit: float
    one_inside: np.ndarray = field(default_factory=_empty_counts, repr=False)
    both_inside: np.ndarray = field(default_factory=_empty_counts, repr=False)
    horizon: float = field(default=float("nan"), metadata=TIME)

    @property
    def shares(self) -> np.ndarray:
        """(m,) f, the share of uncertain pairs at each separation; NaN without pairs."""
        return np.where(self.pairs > 0, self.uncertain / np.maximum(self.pairs, 1), np.nan)

    @property
    def share_intervals(self) -> tuple[np.ndarray, np.ndarray]:
        """(m,) lower and upper limits of the 95 % Wilson intervals of the shares."""
        return wilson_interval(self.uncertain, self.pairs)

    @property
    def dimension(self) -> float:
        """2 − α, the dimension of the basin boundary in the plane of initial conditions; NaN without an exponent."""
        return 2.0 - self.exponent

    def numbers(self) -> dict[str, Any]:
        """Return the scalar attributes, and the dimension of the boundary."""
        return {**super().numbers(), "dimension": self.dimension}

    def describe(self) -> str:
        """Describe the result, or the reason why there is none, in one sentence."""
        if np.isnan(self.exponent):
            return f"No uncertainty exponent: {self._describe_obstacle()}."
        decimals = int(np.clip(np.ceil(-np.log10((self.high - self.low) / 2.0)), 1, 4))
        values = (self.exponent, self.low, self.high, self.dimension)
        alpha, low, high, dimension = (format_decimals(value, decimals) for value in values)
        used = self.separations[self.used]
        return (
            f"α = {alpha} ({low} to {high}), so the boundary has dimension {dimension}, "
            f"at separations from {used.min():.0e} to {used.max():.0e}{self._describe_limit()}."
        )

    def _describe_limit(self) -> str:
        """Return the end of a sentence on an extreme α, 0 or 1, in the interval; empty if the interval contains neither."""
        if self.high >= 1.0:
            return "; a smooth boundary, α = 1, is also possible"
        return "; a boundary that fills the plane, α = 0, is also possible" if self.low <= 0.0 else ""

    def _describe_obstacle(self) -> str:
        """Return the reason why there is no exponent."""
        pairs, uncertain = int(self.pairs.sum()), int(self.uncertain.sum())
        if not pairs:
            return "no pair of starts lies inside"
        if not uncertain:
            return f"both orbits have the same fate in all {format_count(pairs, 'pair')}"
        if np.isnan(self.misfit):
            return f"{uncertain} uncertain pairs of {pairs} are too few, or cover too short a range of separations"
        return f"no power law describes the shares of uncertain pairs (χ² = {self.misfit:.1f} per degree of freedom)"


def fit_uncertainty(separations: Any, pairs: Any, uncertain: Any) -> UncertaintyExponent:
    """Fit f(ε) = A ε^α to counts of uncertain pairs of starts.

    A and α maximise the binomial likelihood of k uncertain pairs out of n at each ε (for the law see Grebogi, McDonald, Ott &
    Yorke 1983, Phys. Lett. A 99, 415). The law holds for small ε. The largest separation is therefore left out repeatedly, until
    the shares neither bend (`MAX_BEND`) nor scatter too much (`MIN_PROBABILITY`), as they do where they saturate. Of this
    straight range, the separations within a factor of `TRANSITION_FACTOR` of the largest are also left out. Separations with too
    few pairs (`MIN_EXPECTED_PAIRS`) never count. There is no exponent if too few separations remain (`MIN_SEPARATIONS`,
    `MIN_DECADES`).

    The 95 % interval is the wider of two: a normal interval from the binomial errors alone, and a Student t interval with these
    errors times √(χ² per degree of freedom). The latter includes the scatter of a boundary that differs slightly from scale to
    scale. In trials the interval contained the exponent in 94 to 97 % of the cases, and in 93 % if each of 17 shares, known to
    7 %, was wrong by a further 8 %. With 15 % instead of 8 %, half of the trials gave no exponent; in the other half, the
    interval contained the exponent in 89 % of the cases.

    Parameters
    ----------
    separations
        (m,) ε > 0, all different, in any order.
    pairs, uncertain
        (m,) integers, 0 ≤ uncertain ≤ pairs.

    Returns
    -------
    The `UncertaintyExponent`; exponent, interval and amplitude are NaN if no power law can be claimed.

    Raises
    ------
    ValueError
        If a parameter is out of range.
    """
    epsilon, n, k = _checked_counts(separations, pairs, uncertain)
    law = _find_law(epsilon, n, k)
    used = np.isin(np.arange(epsilon.size), law.indices)
    if not law.holds:
        return UncertaintyExponent(epsilon, n, k, used, np.nan, np.nan, np.nan, np.nan, law.misfit)
    low, high = law.exponent - law.half_width, law.exponent + law.half_width
    return UncertaintyExponent(epsilon, n, k, used, law.exponent, low, high, law.amplitude, law.misfit)


def _checked_counts(separations: Any, pairs: Any, uncertain: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ε, n and k as arrays (m,); ValueError if they are not as `fit_uncertainty` takes them."""
    epsilon = checked_array("separations", separations).copy()
    if epsilon.ndim != 1 or not np.all((epsilon > 0.0) & np.isfinite(epsilon)) or np.unique(epsilon).size < epsilon.size:
        raise ValueError(f"separations={short_repr(separations)}: must be a sequence of different finite numbers above 0")
    counts = [checked_integers("pairs", pairs), checked_integers("uncertain", uncertain)]
    for name, count in zip(("pairs", "uncertain"), counts, strict=True):
        if count.shape != epsilon.shape:
            raise ValueError(f"{name}={short_repr(count)}: must be one integer per separation, {epsilon.size}")
    n, k = (count.astype(np.int64) for count in counts)
    if np.any((k < 0) | (k > n)):
        raise ValueError(f"uncertain={short_repr(uncertain)}: must be from 0 to pairs={short_repr(pairs)}")
    return epsilon, n, k


@dataclass(frozen=True, eq=False)
class _Law:
    """The most likely power law for the shares at the separations with these `indices`, and its goodness of fit.

    `half_width` is that of the 95 % interval of the exponent, `bend` the quadratic term in standard errors, and `misfit` χ² per
    degree of freedom. The law is `plausible` if the shares do not scatter too much about it. It `holds` if an exponent can be
    claimed.
    """

    indices: np.ndarray
    exponent: float = np.nan
    half_width: float = np.nan
    amplitude: float = np.nan
    misfit: float = np.nan
    bend: float = np.nan
    plausible: bool = False
    holds: bool = False


def _find_law(epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> _Law:
    """Find the power law that holds from the largest possible ε downwards; if there is none, return the last attempt."""
    by_decreasing_epsilon = np.argsort(-epsilon, kind="stable")
    last_attempt = _Law(by_decreasing_epsilon[:0])
    for begin in range(by_decreasing_epsilon.size):
        tail = by_decreasing_epsilon[begin:]
        line = _fit_law(_select_by_expected_pairs(tail, epsilon, n, k), epsilon, n, k)
        if line is None:
            break
        last_attempt = line
        if line.plausible and abs(line.bend) <= MAX_BEND:
            # Leave out the transition from a bend to the straight range.
            inner = tail[epsilon[tail] * TRANSITION_FACTOR <= epsilon[tail[0]] * (1.0 + _ROUNDING)]
            law = _fit_law(_select_by_expected_pairs(inner, epsilon, n, k), epsilon, n, k)
            if law is None:
                return _Law(last_attempt.indices)
            if law.plausible:
                return replace(law, holds=True)
            last_attempt = law
    return last_attempt


def _select_by_expected_pairs(indices: np.ndarray, epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Return the indices at which the law fitted to all of them expects `MIN_EXPECTED_PAIRS` uncertain and certain pairs."""
    # The likelihood requires certain pairs at each separation.
    indices = indices[k[indices] < n[indices]]
    if np.count_nonzero(k[indices]) < MIN_SEPARATIONS:
        return indices[:0]
    share = predict_shares(epsilon[indices], n[indices], k[indices])
    return indices[n[indices] * np.minimum(share, 1.0 - share) >= MIN_EXPECTED_PAIRS]


def predict_shares(epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Return f of the most likely power law at each separation; at least two of the k must be above 0, and all k below n."""
    design = _scaled_powers(np.log(epsilon), 1)
    return np.exp(design @ _maximise_likelihood(design, n, k)[0])


def _fit_law(indices: np.ndarray, epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> _Law | None:
    """Fit a power law to the separations with these indices; return None if they are too few or cover too short a range."""
    from scipy import special

    if indices.size < MIN_SEPARATIONS or np.ptp(np.log10(epsilon[indices])) < MIN_DECADES:
        return None
    x, n, k = np.log(epsilon[indices]), n[indices], k[indices]
    design = _scaled_powers(x, 1)
    (level, slope), covariance = _maximise_likelihood(design, n, k)
    share = np.exp(design @ [level, slope])
    degrees_of_freedom = x.size - 2
    chi2 = float(np.sum((k - n * share) ** 2 / (n * share * (1.0 - share))))
    exponent = float(slope / np.ptp(x))
    probability = 0.5 * (1.0 + _CONFIDENCE)
    misfit = chi2 / degrees_of_freedom
    # Half-width of the interval in units of the binomial standard error.
    factor = max(special.ndtri(probability), special.stdtrit(degrees_of_freedom, probability) * np.sqrt(misfit))
    return _Law(
        indices=indices,
        exponent=exponent,
        half_width=float(factor * np.sqrt(covariance[1, 1]) / np.ptp(x)),
        amplitude=float(np.exp(level - exponent * x.mean())),
        misfit=misfit,
        bend=_measure_bend(x, n, k),
        plausible=bool(special.chdtrc(degrees_of_freedom, chi2) >= MIN_PROBABILITY),
    )


def _measure_bend(x: np.ndarray, n: np.ndarray, k: np.ndarray) -> float:
    """Return the quadratic term of log f in x, in standard errors that include the scatter about the fitted parabola."""
    design = _scaled_powers(x, 2)
    coefficients, covariance = _maximise_likelihood(design, n, k)
    share = np.exp(design @ coefficients)
    scatter = np.sum((k - n * share) ** 2 / (n * share * (1.0 - share))) / (x.size - 3)
    return float(coefficients[2] / np.sqrt(covariance[2, 2] * max(scatter, 1.0)))


def _scaled_powers(x: np.ndarray, degree: int) -> np.ndarray:
    """Return powers of x, shifted to mean 0 and scaled to a range of length 1, of shape (m, degree + 1)."""
    return np.vander((x - x.mean()) / np.ptp(x), degree + 1, increasing=True)


def _maximise_likelihood(design: np.ndarray, n: np.ndarray, k: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the most likely coefficients (d,) of log f = design @ coefficients, and their covariance (d, d).

    The log-likelihood is concave in the coefficients, so it has only one maximum.
    """
    from scipy import optimize

    def loss(coefficients: np.ndarray) -> float:
        log_share = design @ coefficients
        return float(-k @ log_share - (n - k) @ np.log(-np.expm1(log_share))) / n.sum() if np.all(log_share < 0.0) else np.inf

    def gradient(coefficients: np.ndarray) -> Any:
        share = np.exp(design @ coefficients)
        return design.T @ ((n * share - k) / (1.0 - share)) / n.sum()

    def information(coefficients: np.ndarray) -> Any:
        share = np.exp(design @ coefficients)
        return design.T @ (design * (n * share / (1.0 - share))[:, None]) / n.sum()

    # The search starts from a constant share.
    guess = np.zeros(design.shape[1])
    guess[0] = np.log(k.sum() / n.sum())
    options = {"gtol": _TOLERANCE}
    coefficients = optimize.minimize(loss, guess, method="trust-exact", jac=gradient, hess=information, options=options).x
    return coefficients, np.linalg.inv(information(coefficients)) / n.sum()
