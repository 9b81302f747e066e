"""Decay laws of the escapes of a map, exponential, power law or neither, as numbers, curves and sentences.

Both laws are truncated exponentials in a unit time u from 0 at t_low to 1 at t_high. The unit time is linear in t for the
exponential law and in ln t for the power law. Both laws therefore share one estimator and one test.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from engine.foundations.result import RecordedResult
from engine.foundations.wording import format_count, format_number, format_whole

MIN_ESCAPES = 100
"""Smallest number of escapes for a fit. They give the rate to about 20 %. Choosing a window takes twice as many."""

MIN_P_VALUE = 0.1
"""Laws with a smaller p value are ruled out (Clauset, Shalizi & Newman 2009, SIAM Rev. 51, 661, section 4.1)."""


class DecayLaw(StrEnum):
    """A decay law; the value is its name in texts."""

    EXPONENTIAL = "exponential"
    POWER_LAW = "power law"


@dataclass(frozen=True)
class LawFit:
    """A decay law fitted to the escapes between t_low and t_high.

    Attributes
    ----------
    law
        The law.
    rate
        κ of exp(−κ (t − t_low)) per unit of time, or γ of (t / t_low)^(−γ), dimensionless; negative if escapes become more
        frequent.
    low, high
        95 % interval of the rate at fixed t_low.
    p_value
        Probability that a sample of the law deviates at least as much from its own fit, 0 to 1.
    t_low, t_high
        Window of time, dimensionless.
    survival_low, survival_high
        S(t_low) and S(t_high), the shares of the decided starts that are still inside at these times.
    """

    law: DecayLaw
    rate: float
    low: float
    high: float
    p_value: float
    t_low: float
    t_high: float
    survival_low: float
    survival_high: float

    @property
    def plausible(self) -> bool:
        """Whether the escapes decay and do not rule out this law."""
        return self.p_value >= MIN_P_VALUE and self.low > 0.0

    def curve(self, t: Any) -> np.ndarray:
        """Return the fitted S(t), which equals the survival at both ends of the window; NaN outside the window."""
        t_array = np.asarray(t, dtype=float)
        inside = (t_array >= self.t_low) & (t_array <= self.t_high)
        u = to_unit_time(self.law, self.t_low, self.t_high, np.where(inside, t_array, self.t_low))
        escaped = cumulative_share(self.rate * window_length(self.law, self.t_low, self.t_high), u)
        fitted: np.ndarray = self.survival_low - (self.survival_low - self.survival_high) * escaped
        return np.where(inside, fitted, np.nan)


@dataclass(frozen=True, eq=False, repr=False)
class DecayLaws(RecordedResult):
    """Decay laws fitted to the escapes of a map, of a part of it, or of any orbits; arrays are read-only.

    Attributes
    ----------
    times, survival
        (m,) increasing escape times, and S, the share of the decided starts that are still inside just after each time.
    t_low, t_high
        Window of the fits; t_low is NaN if no law holds in any window that could be chosen.
    escapes
        Number of distinct escape times in the window, or in (0, t_high] if t_low is NaN.
    escapes_in_all
        Number of distinct escape times.
    undecided
        Number of starts not decided yet; if it is not 0, there is no fit.
    exponential, power_law
        The fits; None if there is no fit.
    preferred
        The law that is not ruled out and significantly more likely than the other law; None if there is none.
    ratio, ratio_low, ratio_high
        Log-likelihood per escape of the exponential law minus that of the power law, and its 95 % interval;
        NaN without fits.
    """

    times: np.ndarray = field(repr=False)
    survival: np.ndarray = field(repr=False)
    t_low: float
    t_high: float
    escapes: int
    escapes_in_all: int
    undecided: int
    exponential: LawFit | None = None
    power_law: LawFit | None = None
    preferred: DecayLaw | None = None
    ratio: float = float("nan")
    ratio_low: float = float("nan")
    ratio_high: float = float("nan")

    def describe(self) -> str:
        """Describe the law with its interval, or the reason why there is none, in one or two sentences."""
        if self.exponential is None or self.power_law is None:
            return self._describe_missing_fit()
        kappa, gamma = _describe_fit("κ", self.exponential), _describe_fit("γ", self.power_law)
        escapes = f"{format_whole(self.escapes)} of {format_count(self.escapes_in_all, 'escape')}"
        data = f"{escapes}, t = {format_number(self.t_low)} to {format_number(self.t_high)}"
        if self.preferred is DecayLaw.EXPONENTIAL:
            return f"Exponential: {kappa}; {data}. A power law is less likely{_describe_exclusion(self.power_law)}."
        if self.preferred is DecayLaw.POWER_LAW:
            decades = np.log10(min(self.times[-1], self.t_high) / self.t_low)
            return (
                f"Power law over {decades:.1f} decades: {gamma}; {data}. "
                f"An exponential is less likely{_describe_exclusion(self.exponential)}."
            )
        return f"{self._describe_doubt(self.exponential, self.power_law)} ({data}): exponential {kappa}; power law {gamma}."

    def _describe_missing_fit(self) -> str:
        """Return the reason why there is no fit, in a sentence."""
        if self.undecided:
            return f"No fit: {format_count(self.undecided, 'orbit is', 'orbits are')} undecided, so late escapes are missing."
        if self.escapes > 2 * MIN_ESCAPES:
            return f"No fit: neither law holds for the latest of {format_count(self.escapes, 'escape')}, however few of them."
        return (
            f"No fit: {format_count(self.escapes, 'escape')}, but a fit needs {MIN_ESCAPES} in a given window "
            f"and {2 * MIN_ESCAPES} to choose one."
        )

    def _describe_doubt(self, exponential: LawFit, power_law: LawFit) -> str:
        """Return the reason why neither law is preferred, as the beginning of a sentence."""
        possible = [fit.law for fit in (exponential, power_law) if fit.plausible]
        if len(possible) == 2:
            return "The data do not decide between the two laws"
        if possible:
            return f"The {possible[0]} may hold, but is not clearly more likely"
        are_both_ruled_out = max(exponential.p_value, power_law.p_value) < MIN_P_VALUE
        return "Neither law holds" if are_both_ruled_out else "These escapes do not show a decay"


def _describe_fit(symbol: str, fit: LawFit) -> str:
    rate, low, high = (format_number(value, 3) for value in (fit.rate, fit.low, fit.high))
    return f"{symbol} = {rate} ({low} to {high}), {_describe_p_value(fit)}"


def _describe_p_value(fit: LawFit) -> str:
    return f"p = {fit.p_value:.2f}" if fit.p_value >= 0.01 else "p < 0.01"


def _describe_exclusion(fit: LawFit) -> str:
    return "" if fit.plausible else f" and ruled out ({_describe_p_value(fit)})"


def window_length(law: DecayLaw, t_low: float, t_high: float) -> float:
    """Return the length of the window, in t for the exponential law and in ln t for the power law.

    The steepness of a law is its rate times this length.
    """
    return t_high - t_low if law is DecayLaw.EXPONENTIAL else float(np.log(t_high / t_low))


def to_unit_time(law: DecayLaw, t_low: float, t_high: float, t: np.ndarray) -> np.ndarray:
    """Return the unit time u of a law at times t, 0 at t_low and 1 at t_high."""
    elapsed: np.ndarray = t - t_low if law is DecayLaw.EXPONENTIAL else np.log(t / t_low)
    return elapsed / window_length(law, t_low, t_high)


def cumulative_share(steepness: float, u: np.ndarray) -> np.ndarray:
    """Return the cumulative distribution function, 0 to 1, at u of a density ∝ exp(−k u) on 0 ≤ u ≤ 1.

    The steepness k may have either sign.
    """
    from scipy import special

    k = abs(steepness)
    share: np.ndarray = u * special.exprel(-k * u) / special.exprel(-k)
    # For a rising density, the factor exp k is divided out, because it can overflow.
    return np.exp(-k * (1.0 - u)) * share if steepness < 0.0 else share
