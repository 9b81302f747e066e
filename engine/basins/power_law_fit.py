"""The power law behind shares of uncertain pairs: its exponent, how sure that is, and whether there is one at all."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy import stats

from engine.validation import read_array, read_integers, shown

LEAST_EXPECTED = 5.0
"""A separation counts when the law expects this many uncertain pairs, and as many certain ones: χ² asks for it (Cochran 1954).

The expected number decides, not the one found: that would keep the rare separations that happened to have many.
"""

LEAST_SEPARATIONS, LEAST_DECADES = 5, 1.9
"""A power law is claimed from no fewer separations, and over no shorter range of them."""

LARGEST_BEND = 2.0
"""The shares bend when the quadratic term of log f in log ε is this many of its standard errors away from zero."""

TRANSITION = 10.0
"""Below where the shares look straight the law begins this factor further down: a bend's end hides in the noise.

In trials of shares that bend over at some ε, the 95 % interval held the exponent in 63 to 76 % without this, in 94 to 97 %
with it.
"""

LEAST_PROBABILITY = 1e-4
"""No power law is claimed when scatter about it as large as that found has a smaller probability."""

_CONFIDENCE = 0.95
_ROUNDING = 1e-9
_MOST_STEPS, _MOST_HALVINGS = 60, 40
# The square of how far the likelihood's summit still is, in standard errors.
_CONVERGED = 1e-8


def _nothing() -> np.ndarray:
    return np.zeros(0, np.int64)


@dataclass(frozen=True, eq=False)
class UncertaintyExponent:
    """How the share of uncertain pairs falls with their separation; all dimensionless, arrays are read-only.

    Attributes
    ----------
    separations
        (m,) ε, in units of the plane of starts.
    pairs, uncertain
        (m,) int64, pairs of starts that far apart, and how many of these have two fates.
    used
        (m,) bool, the separations that the exponent rests on; without one, those last tried.
    exponent
        α of f(ε) = A ε^α; NaN when no power law describes the shares, or when they are too few to tell.
    low, high
        The 95 % interval of α; NaN without one.
    amplitude
        A; NaN without an exponent.
    misfit
        χ² per degree of freedom of the used shares about the line; NaN when there were too few to fit one.
    one_inside, both_inside
        (m,) int64, pairs of which one orbit or both were still inside at the horizon: all that a later one could change. The
        former are among the uncertain. Empty where it is not known.
    horizon
        Time to which orbits were followed; NaN where it is not known.
    """

    separations: np.ndarray
    pairs: np.ndarray
    uncertain: np.ndarray
    used: np.ndarray
    exponent: float
    low: float
    high: float
    amplitude: float
    misfit: float
    one_inside: np.ndarray = field(default_factory=_nothing, repr=False)
    both_inside: np.ndarray = field(default_factory=_nothing, repr=False)
    horizon: float = float("nan")

    @property
    def shares(self) -> np.ndarray:
        """(m,) f, the share of uncertain pairs at each separation; NaN where there are no pairs."""
        return np.where(self.pairs > 0, self.uncertain / np.maximum(self.pairs, 1), np.nan)

    @property
    def dimension(self) -> float:
        """2 − α, the dimension of the basin boundary in the plane of starts; NaN without an exponent."""
        return 2.0 - self.exponent

    @property
    def probability(self) -> float:
        """That of a scatter about the line at least as large, were it chance alone; NaN when there were too few to fit one."""
        freedom = int(np.count_nonzero(self.used)) - 2
        return float(stats.chi2.sf(self.misfit * freedom, freedom)) if np.isfinite(self.misfit) else float("nan")

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        arrays = (self.separations, self.pairs, self.uncertain, self.used, self.one_inside, self.both_inside)
        return sum(array.nbytes for array in arrays)

    def describe(self) -> str:
        """The result in a sentence, or what stands in its way."""
        if np.isnan(self.exponent):
            return f"No uncertainty exponent: {self._obstacle()}."
        digits = int(np.clip(np.ceil(-np.log10((self.high - self.low) / 2.0)), 1, 4))
        alpha, low, high, dimension = (_written(n, digits) for n in (self.exponent, self.low, self.high, self.dimension))
        used = self.separations[self.used]
        return (
            f"α = {alpha} ({low} to {high}), so the boundary has dimension {dimension}, "
            f"at separations from {used.min():.0e} to {used.max():.0e}{self._caution()}."
        )

    def _caution(self) -> str:
        if self.high >= 1.0:
            return "; a smooth boundary, α = 1, would do as well"
        return "; one that fills the plane, α = 0, would do as well" if self.low <= 0.0 else ""

    def _obstacle(self) -> str:
        pairs, uncertain = int(self.pairs.sum()), int(self.uncertain.sum())
        if not pairs:
            return "no pair of starts lies inside"
        if not uncertain:
            return f"both orbits of every one of the {pairs} pairs have the same fate"
        if np.isnan(self.misfit):
            return f"{uncertain} uncertain pairs of {pairs} are too few, or over too short a range of separations"
        return f"no power law describes the shares of uncertain pairs (χ² = {self.misfit:.1f} per degree of freedom)"


def _written(number: float, digits: int) -> str:
    return f"{round(number, digits) + 0.0:.{digits}f}".replace("-", "−")


def fit_uncertainty(separations: Any, pairs: Any, uncertain: Any) -> UncertaintyExponent:
    """Fit f(ε) = A ε^α to how many pairs of starts are uncertain.

    The likelihood is that of binomial counts, k of n at each ε, and the largest one gives A and α (Grebogi, McDonald, Ott & Yorke
    1983, Phys. Lett. A 99, 415, for the law). The law is one of small ε: while the shares bend (`LARGEST_BEND`) or scatter beyond
    chance (`LEAST_PROBABILITY`), as where they saturate, the largest separation is left out; once they are straight, so are
    those within a factor of `TRANSITION` of the largest one left. Separations with too few pairs (`LEAST_EXPECTED`) never count.
    Nothing is claimed when that leaves too little (`LEAST_SEPARATIONS`, `LEAST_DECADES`).

    The 95 % interval is the wider one of two: normal, from the binomial errors alone, and Student's t with these errors times
    √(χ² per degree of freedom), which also holds the scatter of a boundary that looks a little different at each scale. In
    trials it held the exponent in 94 to 97 %, and in 93 % when each of 17 shares, known to 7 %, was off by a further 8 %; with
    15 %, half of all trials had no exponent, and 89 % of the others held it.

    Parameters
    ----------
    separations
        (m,) ε > 0, all different, in any order.
    pairs, uncertain
        (m,) integers, 0 ≤ uncertain ≤ pairs.

    Returns
    -------
    The `UncertaintyExponent`; its exponent, interval and amplitude are NaN when nothing can be claimed.

    Raises
    ------
    ValueError
        When a parameter is out of its range.
    """
    epsilon, n, k = _checked_counts(separations, pairs, uncertain)
    law = _find_law(epsilon, n, k)
    used = np.isin(np.arange(epsilon.size), law.used)
    for array in (epsilon, n, k, used):
        array.flags.writeable = False
    if not law.holds:
        return UncertaintyExponent(epsilon, n, k, used, np.nan, np.nan, np.nan, np.nan, law.misfit)
    low, high = law.exponent - law.half_width, law.exponent + law.half_width
    return UncertaintyExponent(epsilon, n, k, used, law.exponent, low, high, law.amplitude, law.misfit)


def _checked_counts(separations: Any, pairs: Any, uncertain: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    epsilon = read_array("separations", separations).copy()
    if epsilon.ndim != 1 or not np.all((epsilon > 0.0) & np.isfinite(epsilon)) or np.unique(epsilon).size < epsilon.size:
        raise ValueError(f"separations={shown(separations)}: must be different finite numbers above 0 in a row")
    counts = [read_integers("pairs", pairs), read_integers("uncertain", uncertain)]
    for name, count in zip(("pairs", "uncertain"), counts, strict=True):
        if count.shape != epsilon.shape:
            raise ValueError(f"{name}={shown(count)}: must be integers, as many as separations, {epsilon.size}")
    n, k = (count.astype(np.int64) for count in counts)
    if np.any((k < 0) | (k > n)):
        raise ValueError(f"uncertain={shown(uncertain)}: must be from 0 to pairs={shown(pairs)}")
    return epsilon, n, k


@dataclass(frozen=True, eq=False)
class _Law:
    """The most likely power law through the shares at the separations `used`, and how well it describes them."""

    used: np.ndarray
    exponent: float = np.nan
    half_width: float = np.nan
    amplitude: float = np.nan
    misfit: float = np.nan
    bend: float = np.nan
    likely: bool = False
    holds: bool = False


def _find_law(epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> _Law:
    """The law that holds from the largest ε on that it can; the last one tried, which does not hold, when there is none."""
    falling = np.argsort(-epsilon, kind="stable")
    last = _Law(falling[:0])
    for begin in range(falling.size):
        tail = falling[begin:]
        whole = _fit_law(_with_enough(tail, epsilon, n, k), epsilon, n, k)
        if whole is None:
            break
        last = whole
        if whole.likely and abs(whole.bend) <= LARGEST_BEND:
            inner = tail[epsilon[tail] * TRANSITION <= epsilon[tail[0]] * (1.0 + _ROUNDING)]
            law = _fit_law(_with_enough(inner, epsilon, n, k), epsilon, n, k)
            if law is None:
                return _Law(last.used)
            if law.likely:
                return replace(law, holds=True)
            last = law
    return last


def _with_enough(which: np.ndarray, epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Those of the separations `which` where the law through all of them expects enough pairs of either kind."""
    which = which[k[which] < n[which]]
    if np.count_nonzero(k[which]) < LEAST_SEPARATIONS:
        return which[:0]
    share = predict_shares(epsilon[which], n[which], k[which])
    enough: np.ndarray = which[n[which] * np.minimum(share, 1.0 - share) >= LEAST_EXPECTED]
    return enough


def predict_shares(epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> np.ndarray:
    """f at each separation by the most likely power law; two of the k or more must not be 0, and no k must be n."""
    design = _powers(np.log(epsilon), 1)
    shares: np.ndarray = np.exp(design @ _maximise_likelihood(design, n, k)[0])
    return shares


def _fit_law(used: np.ndarray, epsilon: np.ndarray, n: np.ndarray, k: np.ndarray) -> _Law | None:
    """The law through the separations `used`; None when they are too few, or over too short a range."""
    if used.size < LEAST_SEPARATIONS or np.ptp(np.log10(epsilon[used])) < LEAST_DECADES:
        return None
    x, n, k = np.log(epsilon[used]), n[used], k[used]
    design = _powers(x, 1)
    (level, slope), covariance = _maximise_likelihood(design, n, k)
    share = np.exp(design @ [level, slope])
    freedom = x.size - 2
    chi2 = float(np.sum((k - n * share) ** 2 / (n * share * (1.0 - share))))
    exponent = float(slope / np.ptp(x))
    tail = 0.5 * (1.0 + _CONFIDENCE)
    errors = max(stats.norm.ppf(tail), stats.t.ppf(tail, freedom) * np.sqrt(chi2 / freedom))
    return _Law(
        used=used,
        exponent=exponent,
        half_width=float(errors * np.sqrt(covariance[1, 1]) / np.ptp(x)),
        amplitude=float(np.exp(level - exponent * x.mean())),
        misfit=chi2 / freedom,
        bend=_measure_bend(x, n, k),
        likely=bool(stats.chi2.sf(chi2, freedom) >= LEAST_PROBABILITY),
    )


def _measure_bend(x: np.ndarray, n: np.ndarray, k: np.ndarray) -> float:
    """The quadratic term of log f in x, in standard errors; these are widened by what scatter a parabola leaves."""
    design = _powers(x, 2)
    coefficients, covariance = _maximise_likelihood(design, n, k)
    share = np.exp(design @ coefficients)
    scatter = np.sum((k - n * share) ** 2 / (n * share * (1.0 - share))) / (x.size - 3)
    return float(coefficients[2] / np.sqrt(covariance[2, 2] * max(scatter, 1.0)))


def _powers(x: np.ndarray, degree: int) -> np.ndarray:
    """(m, degree + 1) powers of x, moved and scaled to a range of length 1 about 0."""
    return np.vander((x - x.mean()) / np.ptp(x), degree + 1, increasing=True)


def _maximise_likelihood(design: np.ndarray, n: np.ndarray, k: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients of log f, and their covariance, by Fisher's scoring; the log-likelihood is concave in them."""

    def likelihood(coefficients: np.ndarray) -> float:
        log_share = design @ coefficients
        return float(k @ log_share + (n - k) @ np.log(-np.expm1(log_share))) if np.all(log_share < 0.0) else -np.inf

    coefficients = np.zeros(design.shape[1])
    coefficients[0] = np.log(k.sum() / n.sum())
    for _ in range(_MOST_STEPS):
        share = np.exp(design @ coefficients)
        information = design.T @ (design * (n * share / (1.0 - share))[:, None])
        slope = design.T @ ((k - n * share) / (1.0 - share))
        step = np.linalg.solve(information, slope)
        if slope @ step < _CONVERGED:
            break
        reached = likelihood(coefficients)
        halvings = next((j for j in range(_MOST_HALVINGS) if likelihood(coefficients + 0.5**j * step) >= reached), _MOST_HALVINGS)
        coefficients = coefficients + 0.5**halvings * step
    return coefficients, np.linalg.inv(information)
