"""Fits of decay laws to escape times: choice of the window, rates with standard errors, and comparison of the laws."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from engine.foundations.root_finding import find_root
from engine.foundations.validation import checked_array, checked_t_max, short_repr
from engine.measures.basins.decay_laws import (
    MIN_ESCAPES,
    MIN_P_VALUE,
    DecayLaw,
    DecayLaws,
    LawFit,
    cumulative_share,
    to_unit_time,
    window_length,
)
from engine.measures.basins.escape_statistics import EscapeStatistics, compute_statistics, compute_survival
from engine.measures.basins.starts import Measurable, Starts, read_starts

# Half-width of the 95 % interval of a normal distribution, in standard deviations.
_HALF_WIDTH_95 = 1.96
# Number of escapes in the next window to be tried, as a share of the number in the present window.
_WINDOW_RATIO = 0.9
# The fit uses only the latest escapes, this share of those in the first window in which a law appears to hold. With all of them,
# an undetectable remainder of the transient would bias the rate.
_SETTLED_SHARE = 0.5
# Degrees of the Legendre polynomials in the test of a law. Degree 1 is left out: it is almost the score, which the fit makes 0.
_DEGREES = (2, 3, 4)
# Factors that normalise these polynomials.
_NORMS = np.sqrt(2.0 * np.array(_DEGREES) + 1.0)
# Steepness up to which the variance is that of the uniform distribution, because of rounding in the general formula.
_FLAT_STEEPNESS = 1e-2


def fit_decay_laws(
    statistics: EscapeStatistics | Measurable | Starts,
    t_max: float | None = None,
    *,
    window: tuple[float, float] | None = None,
) -> DecayLaws:
    """Fit an exponential law and a power law to the escape times in a window, and decide which one holds, if any.

    Rates maximise the likelihood of the escape times inside the window, given that these times lie inside. Therefore neither
    regular orbits, which never escape, nor the cutoff at t_max cause a bias. Bit-identical escape times belong to mirror images
    and count once. All times count as independent draws although the starts form a grid: in a given window, rates from shifted
    grids scattered 0.8 to 1.1 times as much as the interval implies. A law is ruled out by Neyman's smooth
    test, with the fitted rate taken into account (Thomas & Pierce 1979, J. Am. Stat. Assoc. 74, 441).

    A window chosen automatically ends at t_max. Decreasing numbers of the latest escapes are tried until a law is ruled out
    neither for these escapes nor for their later half, which is then the window: the rule of Deluca & Corral (2013, Acta Geophys.
    61, 1351) with an additional margin. If there is no such window, there is no fit. The laws are compared by their
    log-likelihood ratio (Vuong 1989, Econometrica 57, 307).

    Parameters
    ----------
    statistics
        The escapes. The escapes of a map, or of the outcomes of `classify_orbits`, are counted first.
    t_max
        Integration time of the orbits that did not escape, 0 < t_max ≤ 1e8, dimensionless; at most that of the statistics, which
        is the default. Later escapes are left out.
    window
        (t_low, t_high), 0 < t_low < t_high ≤ t_max; None to choose it automatically.

    Raises
    ------
    ValueError
        If a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_statistics, fit_decay_laws
    >>> escapes = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (80, 80), t_max=1e3))
    >>> laws = fit_decay_laws(compute_statistics(escapes))
    >>> assert laws.exponential is not None
    >>> laws.preferred, round(laws.exponential.rate, 3)
    (<DecayLaw.EXPONENTIAL: 'exponential'>, 0.024)
    """
    if not isinstance(statistics, EscapeStatistics):
        statistics = compute_statistics(read_starts("statistics", statistics))
    t_max = _checked_horizon(statistics, t_max)
    t_low, t_high = (math.nan, t_max) if window is None else _checked_window(window, t_max)
    all_times = np.unique(statistics.escape_times)
    times = all_times[(all_times > 0.0) & (all_times <= t_high)]
    if window is None:
        t_low = _choose_t_low(times, t_high)
    # Without a window, t_low is NaN, and all escapes are counted.
    sample = _Sample(t_low, t_high, times[times > (t_low if np.isfinite(t_low) else 0.0)])
    counts = (sample.times.size, all_times.size, statistics.undecided)
    laws = DecayLaws(*compute_survival(statistics), t_low, t_high, *counts, made_by=statistics.made_by)
    if sample.times.size < MIN_ESCAPES or statistics.undecided or not np.isfinite(t_low):
        return laws
    return _fit_and_compare(laws, sample, statistics)


def _checked_horizon(statistics: EscapeStatistics, t_max: float | None) -> float:
    """Return the time up to which escapes are used; ValueError if it is not legal, or after `statistics.t_max`."""
    horizon = checked_t_max(statistics.t_max if t_max is None else t_max)
    if horizon > statistics.t_max:
        raise ValueError(f"t_max={t_max:g}: must be at most {statistics.t_max:g}, the integration time of the statistics")
    return horizon


def _checked_window(window: tuple[float, float], t_max: float) -> tuple[float, float]:
    """Return a window as floats; ValueError unless 0 < t_low < t_high ≤ t_max."""
    limits = checked_array("window", window)
    if limits.shape != (2,) or not 0.0 < limits[0] < limits[1] <= t_max:
        raise ValueError(f"window={short_repr(window)}: must be (t_low, t_high) with 0 < t_low < t_high ≤ t_max={t_max:g}")
    return float(window[0]), float(window[1])


@dataclass(frozen=True, eq=False)
class _Sample:
    """The distinct escape times in a window, in increasing order."""

    t_low: float
    t_high: float
    times: np.ndarray

    def unit_times(self, law: DecayLaw) -> np.ndarray:
        """Return the unit times u of a law, shaped like `times`."""
        return to_unit_time(law, self.t_low, self.t_high, self.times)

    def p_value(self, law: DecayLaw) -> float:
        """Return the probability that a sample of the law deviates at least as much from its own fit, by Neyman's smooth test.

        Under the law, the means of the Legendre polynomials of the cumulative shares are normally distributed around 0. The fit
        reduces the covariance of these means by the part along the score u − ⟨u⟩.
        """
        from scipy import special

        u = self.unit_times(law)
        shares = cumulative_share(_fit_steepness(u), u)
        polynomials = np.polynomial.legendre.legvander(2.0 * shares - 1.0, _DEGREES[-1])[:, _DEGREES] * _NORMS
        score = u - u.mean()
        score_part = score @ polynomials
        covariance = np.eye(len(_DEGREES)) - np.outer(score_part, score_part) / (u.size * (score @ score))
        means = polynomials.mean(axis=0)
        return float(special.chdtrc(len(_DEGREES), u.size * means @ np.linalg.solve(covariance, means)))

    def log_likelihoods(self, law: DecayLaw) -> np.ndarray:
        """Return the log-likelihood of each escape time under the fitted law, up to a constant common to both laws."""
        from scipy import special

        u = self.unit_times(law)
        steepness = _fit_steepness(u)
        # A rising density is a falling density of 1 − u.
        k = abs(steepness)
        falling_u = u if steepness > 0.0 else 1.0 - u
        # du/dt is 1/length if u is linear in t, and 1/(t · length) if u is linear in ln t.
        log_t = 0.0 if law is DecayLaw.EXPONENTIAL else np.log(self.times)
        return -np.log(special.exprel(-k)) - k * falling_u - np.log(window_length(law, self.t_low, self.t_high)) - log_t


def _choose_t_low(times: np.ndarray, t_high: float) -> float:
    """Return the beginning of the window for increasing `times`; NaN if no law holds, or if there are too few escapes."""
    remaining = times.size - 1
    while (later_count := int(remaining * _SETTLED_SHARE)) >= MIN_ESCAPES:
        sample, later = _latest_sample(times, t_high, remaining), _latest_sample(times, t_high, later_count)
        if any(sample.p_value(law) >= MIN_P_VALUE and later.p_value(law) >= MIN_P_VALUE for law in DecayLaw):
            return later.t_low
        remaining = int(remaining * _WINDOW_RATIO)
    return float("nan")


def _latest_sample(times: np.ndarray, t_high: float, count: int) -> _Sample:
    """Return the sample of the latest `count` escapes; its window begins at the escape before them."""
    return _Sample(float(times[-count - 1]), t_high, times[-count:])


def _fit_and_compare(laws: DecayLaws, sample: _Sample, statistics: EscapeStatistics) -> DecayLaws:
    """Return the laws with both fits to a sample, and with the law that holds and is significantly more likely."""
    escaped_counts = [int(np.count_nonzero(statistics.escape_times <= t)) for t in (sample.t_low, sample.t_high)]
    survival = [1.0 - count / statistics.decided for count in escaped_counts]
    exponential, power_law = (_fit_law(law, sample, *survival) for law in DecayLaw)
    differences = sample.log_likelihoods(DecayLaw.EXPONENTIAL) - sample.log_likelihoods(DecayLaw.POWER_LAW)
    ratio = float(differences.mean())
    half_width = _HALF_WIDTH_95 * float(differences.std()) / math.sqrt(differences.size)
    preferred = None
    if exponential.plausible and ratio > half_width:
        preferred = DecayLaw.EXPONENTIAL
    elif power_law.plausible and ratio < -half_width:
        preferred = DecayLaw.POWER_LAW
    return replace(
        laws, exponential=exponential, power_law=power_law, preferred=preferred,
        ratio=ratio, ratio_low=ratio - half_width, ratio_high=ratio + half_width,
    )  # fmt: skip


def _fit_law(law: DecayLaw, sample: _Sample, survival_low: float, survival_high: float) -> LawFit:
    """Fit one law. The standard error of the rate is valid even if the law does not hold (White 1982, Econometrica 50, 1)."""
    u, length = sample.unit_times(law), window_length(law, sample.t_low, sample.t_high)
    steepness = _fit_steepness(u)
    half_width = _HALF_WIDTH_95 * float(u.std()) / (np.sqrt(u.size) * _variance_of_u(steepness)) / length
    rate = steepness / length
    window = (sample.t_low, sample.t_high)
    return LawFit(law, rate, rate - half_width, rate + half_width, sample.p_value(law), *window, survival_low, survival_high)


def _fit_steepness(u: np.ndarray) -> float:
    """Return the maximum-likelihood steepness k, of either sign, of a density ∝ exp(−k u) on 0 ≤ u ≤ 1.

    k solves ½ ₁F₁(2; 3; −k) / ₁F₁(1; 2; −k) = 1/k − 1/(exp k − 1) = mean of u; the first expression is also accurate for small
    k. Replacing u by 1 − u changes only the sign of k.
    """
    from scipy import special

    mean = float(u.mean())
    falling_mean = min(mean, 1.0 - mean)

    def excess(k: float) -> float:
        return float(0.5 * special.hyp1f1(2.0, 3.0, -k) / special.exprel(-k)) - falling_mean

    # The mean is below 1/k, so k is below the upper end of this bracket.
    steepness = find_root(excess, 0.0, 2.0 / falling_mean, xtol=2e-12)
    return float(np.copysign(steepness, 0.5 - mean))


def _variance_of_u(steepness: float) -> float:
    """Return the variance of u for a density of this steepness."""
    k = abs(steepness)
    return 1.0 / k**2 - float(np.exp(-k) / np.expm1(-k) ** 2) if k > _FLAT_STEEPNESS else 1.0 / 12.0
