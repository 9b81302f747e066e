"""Fits of decay laws to escape times: choice of the window, rates with bootstrap intervals, comparison of the laws."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from engine.dynamics.classification import Outcomes
from engine.execution import DEFAULT_EXECUTION, Execution
from engine.maps.stored_maps import MapLike, as_map
from engine.measures.decay_laws import MIN_ESCAPES, MIN_P_VALUE, DecayLaw, DecayLaws, LawFit, to_unit_time, window_length
from engine.measures.escape_statistics import EscapeStatistics, compute_statistics, compute_survival
from engine.measures.truncated_exponential import (
    fit_steepness_and_distance,
    kolmogorov_smirnov_distance,
    max_log_likelihood,
    quantile,
    scaled_distance,
    solve_steepness,
)
from engine.validation import checked_array, checked_count, checked_t_max, checks_types, short_repr

MIN_RESAMPLES = 500
"""Fewest bootstrap resamples, which leave 12 beyond each end of a 95 % interval."""

MAX_RESAMPLES = 100_000
"""Most bootstrap resamples: beyond that the model limits the accuracy of an interval, not the resampling."""

_INTERVAL_PERCENTILES = (2.5, 97.5)
# Number of escapes in the next window tried, relative to the current one.
_WINDOW_RATIO = 0.9
# Where a law first seems to hold, an undetectable rest of the transient still biases the rate, so the fit uses this share of
# the escapes, the latest ones. In trials the interval then held the true rate in 94 % of the cases, otherwise in 75 to 90 %.
_SETTLED_SHARE = 0.5
# Scaled distances above this are not tested: a p value of 0.1 corresponds to 0.99, or less where the truncation is near.
_MAX_TESTED_DISTANCE = 1.1
# Sample size for the distribution of the scaled distance, which hardly depends on it.
_MAX_SAMPLE_SIZE = 250
# The latest escapes are resampled individually, earlier ones in groups of this share of the escapes after them.
_SINGLES, _GROUP_SHARE = 128, 0.02


@checks_types(execution=Execution)
def fit_decay_laws(
    statistics: EscapeStatistics | MapLike | Outcomes,
    t_max: float | None = None,
    *,
    window: tuple[float, float] | None = None,
    resamples: int = 1000,
    seed: int = 0,
    execution: Execution = DEFAULT_EXECUTION,
) -> DecayLaws:
    """Fit an exponential law and a power law to the escape times in a window, and decide which one holds, if any.

    Rates are maximum-likelihood estimates from the escape times inside the window, given that they lie in it, so neither regular
    orbits, which never escape, nor the cutoff at t_max cause a bias. Bit-identical escape times belong to mirror images and count
    once. The others are treated as independent draws although the starts form a grid: where a law held, rates from shifted grids
    scattered 0.8 to 1.1 times as much as the interval says (docs/escape-laws.md).

    A window chosen automatically ends at t_max. Decreasing numbers of the latest escapes are tried until one law is ruled out
    neither for them nor for their later half, and this half is the window: the rule of Deluca & Corral (2013, Acta Geophys. 61,
    1351) with an additional margin, and the p value of Clauset, Shalizi & Newman (2009, SIAM Rev. 51, 661). If there is no such
    window, the one with the smallest Kolmogorov–Smirnov distance is used, as by Clauset et al., and no law is preferred. The laws
    are compared by their log-likelihood ratio (Vuong 1989, Econometrica 57, 307) with a bootstrap interval instead of a normal
    one.

    Parameters
    ----------
    statistics
        The escapes, or the map or the outcomes of `classify_orbits` in which they are counted.
    t_max
        Integration time of the orbits that did not escape, 0 < t_max ≤ 1e8, dimensionless; None for that of the statistics, the
        largest one that is legal. Later escapes are left out.
    window
        (t_low, t_high), 0 < t_low < t_high ≤ t_max; None to choose it automatically.
    resamples
        Number of bootstrap resamples, 500 to 100 000.
    seed
        Seed of the random numbers, an integer, 0 or more. The same seed gives the same result.
    execution
        How the computation runs.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_statistics, fit_decay_laws
    >>> escapes = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.2, (80, 80), t_max=1e3))
    >>> laws = fit_decay_laws(compute_statistics(escapes), resamples=500)
    >>> laws.preferred, round(laws.exponential.rate, 3)
    (<DecayLaw.EXPONENTIAL: 'exponential'>, 0.024)
    """
    if not isinstance(statistics, EscapeStatistics):
        chosen = statistics if isinstance(statistics, Outcomes) else as_map("statistics", statistics)
        statistics = compute_statistics(chosen)
    t_max = _checked_horizon(statistics, t_max)
    resamples = checked_count("resamples", resamples, MIN_RESAMPLES, MAX_RESAMPLES)
    seed = checked_count("seed", seed, 0, 2**63 - 1)
    if window is not None:
        ends = checked_array("window", window)
        if ends.shape != (2,) or not 0.0 < ends[0] < ends[1] <= t_max:
            raise ValueError(f"window={short_repr(window)}: must be (t_low, t_high) with 0 < t_low < t_high ≤ t_max={t_max:g}")
    t_high = t_max if window is None else float(window[1])
    fitter = _Fitter(statistics, t_high, resamples, seed, execution)
    t_low, settled = fitter.choose_t_low() if window is None else (float(window[0]), True)
    return fitter.fit(t_low, settled)


def _checked_horizon(statistics: EscapeStatistics, t_max: float | None) -> float:
    """Time up to which the escapes are known."""
    checked = checked_t_max(statistics.t_max if t_max is None else t_max)
    if checked > statistics.t_max:
        raise ValueError(f"t_max={t_max:g}: must be at most {statistics.t_max:g}, the integration time of the statistics")
    return checked


@dataclass(frozen=True, eq=False)
class _Sample:
    """The different escape times in a window, in increasing order."""

    t_low: float
    t_high: float
    times: np.ndarray

    def unit_times(self, law: DecayLaw) -> np.ndarray:
        """Unit times u of a law."""
        return to_unit_time(law, self.t_low, self.t_high, self.times)

    def mean_unit_times(self) -> np.ndarray:
        """(2,) means of the unit times, exponential law first."""
        return np.array([self.unit_times(law).mean() for law in DecayLaw])


class _Fitter:
    """Fits to the escapes between any t_low and a fixed t_high."""

    def __init__(self, statistics: EscapeStatistics, t_high: float, resamples: int, seed: int, execution: Execution) -> None:
        self.statistics, self.t_high, self.resamples, self.seed, self.execution = statistics, t_high, resamples, seed, execution
        self.all_times = np.unique(statistics.escape_times)
        self.times = self.all_times[(self.all_times > 0.0) & (self.all_times <= t_high)]

    def choose_t_low(self) -> tuple[float, bool]:
        """Start of the window, and whether a law holds from there on; (NaN, False) if there are too few escapes."""
        smallest, t_low = np.inf, float("nan")
        remaining = 0 if self.statistics.undecided else self.times.size - 1
        while int(remaining * _SETTLED_SHARE) >= MIN_ESCAPES:
            sample, later = self.latest(remaining), self.latest(int(remaining * _SETTLED_SHARE))
            for law in DecayLaw:
                fit = fit_steepness_and_distance(sample.unit_times(law))
                if self.may_hold(fit, sample) and self.may_hold(fit_steepness_and_distance(later.unit_times(law)), later):
                    return later.t_low, True
                if fit[1] < smallest:
                    smallest, t_low = fit[1], sample.t_low
            remaining = int(remaining * _WINDOW_RATIO)
        return t_low, False

    def may_hold(self, fit: tuple[float, float], sample: _Sample) -> bool:
        """Whether the sample does not rule out the law with this steepness and distance."""
        tested = scaled_distance(fit[1], sample.times.size) <= _MAX_TESTED_DISTANCE
        return tested and self.find_p_value(*fit, sample.times.size) >= MIN_P_VALUE

    def latest(self, count: int) -> _Sample:
        """The latest `count` escapes; the window begins at the escape before them."""
        return self.after(float(self.times[-count - 1]))

    def after(self, t_low: float) -> _Sample:
        """The escapes after `t_low`."""
        return _Sample(t_low, self.t_high, self.times[np.searchsorted(self.times, t_low, side="right") :])

    def fit(self, t_low: float, settled: bool) -> DecayLaws:
        """Both laws fitted to the escapes after `t_low`; no fits if there are too few."""
        sample = self.after(t_low if np.isfinite(t_low) else 0.0)
        counts = (sample.times.size, self.all_times.size, self.statistics.undecided)
        laws = DecayLaws(*compute_survival(self.statistics), t_low, self.t_high, *counts, settled)
        if counts[0] < MIN_ESCAPES or self.statistics.undecided or not np.isfinite(t_low):
            return laws
        means = self.resample(sample)
        exponential, power_law = (self.fit_law(law, sample, means[:, column]) for column, law in enumerate(DecayLaw))
        ratio = float(_log_likelihood_ratio(sample, sample.mean_unit_times()[None])[0])
        ratio_low, ratio_high = np.percentile(_log_likelihood_ratio(sample, means), _INTERVAL_PERCENTILES).tolist()
        preferred = None
        if settled and exponential.plausible and ratio_low > 0.0:
            preferred = DecayLaw.EXPONENTIAL
        elif settled and power_law.plausible and ratio_high < 0.0:
            preferred = DecayLaw.POWER_LAW
        return replace(
            laws, exponential=exponential, power_law=power_law, preferred=preferred,
            ratio=ratio, ratio_low=ratio_low, ratio_high=ratio_high,
        )  # fmt: skip

    def fit_law(self, law: DecayLaw, sample: _Sample, means: np.ndarray) -> LawFit:
        """One law, with the interval from the mean unit times (resamples,) of resampled escapes."""
        u, length = sample.unit_times(law), window_length(law, sample.t_low, sample.t_high)
        steepness, distance = fit_steepness_and_distance(u)
        low, high = (np.percentile(solve_steepness(means), _INTERVAL_PERCENTILES) / length).tolist()
        p_value = self.find_p_value(steepness, distance, u.size)
        window = (sample.t_low, sample.t_high)
        escaped = [int(np.count_nonzero(self.statistics.escape_times <= t)) for t in window]
        survival = (1.0 - count / self.statistics.decided for count in escaped)
        return LawFit(law, steepness / length, low, high, distance, p_value, *window, *survival)

    def find_p_value(self, steepness: float, distance: float, count: int) -> float:
        """Share of random samples of the law that are as far from their own fit (parametric bootstrap).

        The size of these samples is limited: the distance is scaled as by Stephens (1974, J. Am. Stat. Assoc. 69, 730) for the
        exponential distribution, which makes its distribution almost independent of the sample size.
        """
        self.execution.raise_if_cancelled()
        size = min(count, _MAX_SAMPLE_SIZE)
        shares = np.random.default_rng(self.seed).random((self.resamples, size))
        samples = np.sort(quantile(abs(steepness), shares), axis=1)
        fitted = solve_steepness(samples.mean(axis=1))
        scaled = scaled_distance(kolmogorov_smirnov_distance(fitted[:, None], samples), size)
        return float(np.mean(scaled >= scaled_distance(distance, count)))

    def resample(self, sample: _Sample) -> np.ndarray:
        """(resamples, 2) mean unit times of both laws for bootstrap resamples of the escapes.

        Escapes close in time are resampled in groups, except the latest ones, on which the means depend most. Multinomial counts
        of about a hundred groups replace one count per escape, with the same spread to a few parts in ten thousand.
        """
        starts = _group_starts(sample.times.size)
        sizes = np.diff(starts, append=sample.times.size)
        group_means = [np.add.reduceat(sample.unit_times(law), starts) / sizes for law in DecayLaw]
        counts = np.random.default_rng(self.seed).multinomial(sample.times.size, sizes / sample.times.size, self.resamples)
        means: np.ndarray = counts @ np.column_stack(group_means) / sample.times.size
        return means


def _group_starts(count: int) -> np.ndarray:
    """Start indices of groups of `count` increasing times: single times at the end, larger groups towards the beginning."""
    ends = [count]
    while ends[-1] > 0:
        ends.append(ends[-1] - max(1, int(_GROUP_SHARE * (count - ends[-1] - _SINGLES))))
    starts: np.ndarray = np.maximum(np.array(ends[:0:-1]), 0)
    return starts


def _log_likelihood_ratio(sample: _Sample, means: np.ndarray) -> np.ndarray:
    """(n,) maximum log-likelihood per escape, exponential minus power law, for (n, 2) mean unit times."""
    length, log_length = (window_length(law, sample.t_low, sample.t_high) for law in DecayLaw)
    exponential = max_log_likelihood(means[:, 0]) - np.log(length)
    # The Jacobian du/dt of the unit time linear in ln t is 1 / (t · log_length).
    power_law = max_log_likelihood(means[:, 1]) - np.log(log_length) - np.log(sample.t_low) - log_length * means[:, 1]
    ratio: np.ndarray = exponential - power_law
    return ratio
