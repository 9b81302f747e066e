"""The fitting of escape laws: where their window begins, rates with bootstrap intervals, and which law is the likelier."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace

import numpy as np

from engine.statistics.decay_laws import FEWEST_ESCAPES, LEAST_P_VALUE, DecayLaw, DecayLaws, LawFit, clock_length, read_clock
from engine.statistics.escape_statistics import EscapeStatistics, compute_survival
from engine.statistics.truncated_exponential import (
    find_distance,
    fit_truncated_exponential,
    largest_log_likelihood,
    scale_distance,
    solve_steepness,
    when_left,
)
from engine.validation import read_array, read_count, read_t_max, shown

FEWEST_RESAMPLES = 500
"""Fewest bootstrap resamples: 12 of them then lie beyond each end of a 95 % interval."""

MOST_RESAMPLES = 100_000
"""Most of them: beyond, an interval is drawn more sharply than its model is true."""

_ENDS = (2.5, 97.5)
# Of the escapes that remain, the share that the next window tried has.
_NEXT_WINDOW = 0.9
# Where a law first seems to hold, what is left of the transient cannot be seen but still bends the rate: so the fit begins
# later, with this share of the escapes. In trials the interval then held the true rate in 94 of 100 cases, without in 75 to 90.
_SETTLED_SHARE = 0.5
# A p value of 0.1 belongs to a scaled distance of 0.99, or less where the truncation is near: beyond this none is computed.
_HOPELESS_DISTANCE = 1.1
# Samples from which the law of the scaled distance is found; it hardly depends on their size.
_LARGEST_SAMPLE = 250
# The latest escapes are resampled one by one, earlier ones in groups of this share of those that leave after them.
_LATEST, _GROUP_SHARE = 128, 0.02


def fit_decay_laws(
    statistics: EscapeStatistics,
    t_max: float,
    *,
    window: tuple[float, float] | None = None,
    resamples: int = 1000,
    seed: int = 0,
    cancel: threading.Event | None = None,
) -> DecayLaws:
    """Fit an exponential law and a power law to the escape times in a window of time, and say which holds, if any.

    Rates are estimated by maximum likelihood from the times of the escapes inside the window, given that they lie in it: so
    neither the regular orbits that never leave nor those cut off at t_max bias them. Escapes at one and the same time, to the
    bit, are mirror images and count once. The others are taken for independent draws, though the starts form a grid: where a
    law held, rates from shifted grids scattered 0.8 to 1.1 times as much as the interval says (docs/escape-laws.md).

    Without a `window`, it ends at t_max. Ever fewer of the latest escapes are tried until one law is ruled out neither among
    them nor in their later half, and this half is the window: the rule of Deluca & Corral (2013, Acta Geophys. 61, 1351) with
    a margin of ours, and the p value of Clauset, Shalizi & Newman (2009, SIAM Rev. 51, 661). Where none is found, the window
    with the least Kolmogorov–Smirnov distance is taken, as Clauset et al. do, and no law is preferred. The laws are compared
    by their log-likelihood ratio (Vuong 1989, Econometrica 57, 307) with a bootstrap interval in place of the normal one.

    Parameters
    ----------
    statistics
        The escapes.
    t_max
        How long every orbit that has not left was followed, 0 < t_max ≤ 1e8; later escapes are left out.
    window
        (t_low, t_high), 0 < t_low < t_high ≤ t_max; None for the rule above.
    resamples
        How many bootstrap resamples, 500 or more.
    seed
        Of the random numbers: one seed, one answer. An integer, 0 or more.
    cancel
        When set, the work stops within about 0.1 s.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range.
    """
    t_max = read_t_max(t_max)
    resamples = read_count("resamples", resamples, FEWEST_RESAMPLES, MOST_RESAMPLES)
    seed = read_count("seed", seed, 0, 2**63 - 1)
    if window is not None:
        ends = read_array("window", window)
        if ends.shape != (2,) or not 0.0 < ends[0] < ends[1] <= t_max:
            raise ValueError(f"window={shown(window)}: must be (t_low, t_high) with 0 < t_low < t_high ≤ t_max={t_max:g}")
    fitter = _Fitter(statistics, t_max if window is None else float(window[1]), resamples, seed, cancel)
    t_low, settled = fitter.choose_t_low() if window is None else (float(window[0]), True)
    return fitter.fit(t_low, settled)


@dataclass(frozen=True, eq=False)
class _Sample:
    """The different escape times in a window, rising."""

    t_low: float
    t_high: float
    times: np.ndarray

    def clock_times(self, law: DecayLaw) -> np.ndarray:
        """What the clock of a law shows at these."""
        return read_clock(law, self.t_low, self.t_high, self.times)

    def clock_means(self) -> np.ndarray:
        """(2,) means over the escapes, exponential law first."""
        return np.array([self.clock_times(law).mean() for law in DecayLaw])


class _Fitter:
    """The escapes up to t_high, and the fits to those after any t_low."""

    def __init__(
        self, statistics: EscapeStatistics, t_high: float, resamples: int, seed: int, cancel: threading.Event | None
    ) -> None:
        self.statistics, self.t_high, self.resamples, self.seed, self.cancel = statistics, t_high, resamples, seed, cancel
        self.all_times = np.unique(statistics.escape_times)
        self.times = self.all_times[(self.all_times > 0.0) & (self.all_times <= t_high)]

    def choose_t_low(self) -> tuple[float, bool]:
        """Where the window begins, and whether a law holds from there on; (NaN, False) without enough escapes."""
        nearest, t_low = np.inf, float("nan")
        remaining = 0 if self.statistics.undecided else self.times.size - 1
        while int(remaining * _SETTLED_SHARE) >= FEWEST_ESCAPES:
            sample, later = self.latest(remaining), self.latest(int(remaining * _SETTLED_SHARE))
            for law in DecayLaw:
                distance = fit_truncated_exponential(sample.clock_times(law))[1]
                if self.may_hold(law, sample) and self.may_hold(law, later):
                    return later.t_low, True
                if distance < nearest:
                    nearest, t_low = distance, sample.t_low
            remaining = int(remaining * _NEXT_WINDOW)
        return t_low, False

    def may_hold(self, law: DecayLaw, sample: _Sample) -> bool:
        """Whether a law is not ruled out."""
        (steepness, distance), count = fit_truncated_exponential(sample.clock_times(law)), sample.times.size
        if scale_distance(distance, count) > _HOPELESS_DISTANCE:
            return False
        return self.find_p_value(steepness, distance, count) >= LEAST_P_VALUE

    def latest(self, count: int) -> _Sample:
        """The window that begins with the escape before the latest `count`."""
        return self.after(float(self.times[-count - 1]))

    def after(self, t_low: float) -> _Sample:
        """The escapes after t_low."""
        return _Sample(t_low, self.t_high, self.times[np.searchsorted(self.times, t_low, side="right") :])

    def fit(self, t_low: float, settled: bool) -> DecayLaws:
        """Both laws after t_low."""
        sample = self.after(t_low if np.isfinite(t_low) else 0.0)
        counts = (sample.times.size, self.all_times.size, self.statistics.undecided)
        laws = DecayLaws(*compute_survival(self.statistics), t_low, self.t_high, *counts, settled)
        if counts[0] < FEWEST_ESCAPES or self.statistics.undecided or not np.isfinite(t_low):
            return laws
        means = self.resample(sample)
        exponential, power_law = (self.fit_law(law, sample, means[:, column]) for column, law in enumerate(DecayLaw))
        ratio = float(_log_likelihood_ratio(sample, sample.clock_means()[None])[0])
        ratio_low, ratio_high = np.percentile(_log_likelihood_ratio(sample, means), _ENDS).tolist()
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
        """One law, with the interval that the means (resamples,) of its clock over resampled escapes give."""
        clock_times, length = sample.clock_times(law), clock_length(law, sample.t_low, sample.t_high)
        steepness, distance = fit_truncated_exponential(clock_times)
        low, high = (np.percentile(solve_steepness(means), _ENDS) / length).tolist()
        p_value = self.find_p_value(steepness, distance, clock_times.size)
        window = (sample.t_low, sample.t_high)
        left = [int(np.count_nonzero(self.statistics.escape_times <= t)) for t in window]
        ends = (1.0 - count / self.statistics.decided for count in left)
        return LawFit(law, steepness / length, low, high, distance, p_value, *window, *ends)

    def find_p_value(self, steepness: float, distance: float, count: int) -> float:
        """Parametric bootstrap: the share of samples of the law that lie as far from their own fit.

        Samples larger than some are not drawn: the distance is scaled as Stephens (1974, J. Am. Stat. Assoc. 69, 730) does
        for the exponential, whereupon its law hardly depends on their size.
        """
        if self.cancel is not None and self.cancel.is_set():
            raise CancelledError
        size = min(count, _LARGEST_SAMPLE)
        left = np.random.default_rng(self.seed).random((self.resamples, size))
        samples = np.sort(when_left(steepness, left), axis=1)
        own = solve_steepness(samples.mean(axis=1))
        scaled = scale_distance(find_distance(own[:, None], samples), size)
        return float(np.mean(scaled >= scale_distance(distance, count)))

    def resample(self, sample: _Sample) -> np.ndarray:
        """(resamples, 2) means of both clocks over escapes drawn anew, as many as there are.

        Neighbours in time are drawn in groups, except the latest, on which the means depend most: multinomial counts of some
        hundred groups in place of as many numbers as there are escapes, with the same spread to a few parts in ten thousand.
        """
        starts = _group_starts(sample.times.size)
        sizes = np.diff(starts, append=sample.times.size)
        group_means = [np.add.reduceat(sample.clock_times(law), starts) / sizes for law in DecayLaw]
        counts = np.random.default_rng(self.seed).multinomial(sample.times.size, sizes / sample.times.size, self.resamples)
        means: np.ndarray = counts @ np.column_stack(group_means) / sample.times.size
        return means


def _group_starts(count: int) -> np.ndarray:
    """Where groups of `count` rising times begin: single ones at the end, ever larger ones towards the beginning."""
    later = [count]
    while later[-1] > 0:
        later.append(later[-1] - max(1, int(_GROUP_SHARE * (count - later[-1] - _LATEST))))
    starts: np.ndarray = np.maximum(np.array(later[:0:-1]), 0)
    return starts


def _log_likelihood_ratio(sample: _Sample, means: np.ndarray) -> np.ndarray:
    """(n,) log-likelihood per escape, exponential less power law, each at its best, for (n, 2) means of the clocks."""
    even, logarithmic = (clock_length(law, sample.t_low, sample.t_high) for law in DecayLaw)
    exponential = largest_log_likelihood(means[:, 0]) - np.log(even)
    # A clock even in ln t runs at 1 / (t · length).
    power_law = largest_log_likelihood(means[:, 1]) - np.log(logarithmic) - np.log(sample.t_low) - logarithmic * means[:, 1]
    ratio: np.ndarray = exponential - power_law
    return ratio
