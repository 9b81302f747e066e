"""The law by which the starts of a map leave: exponential, power law, or neither; in numbers, curves and words.

Each law is a truncated exponential in a clock of its own, which runs from 0 at t_low to 1 at t_high: evenly in t for the
exponential law, evenly in ln t for the power law. So one estimator, one distance and one bootstrap serve both.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from engine.statistics.truncated_exponential import share_left

FEWEST_ESCAPES = 100
"""Fewest escapes in a window for a fit: the rate is then known to about a fifth. To choose a window takes twice as many."""

LEAST_P_VALUE = 0.1
"""A law with a smaller p value is ruled out (Clauset, Shalizi & Newman 2009, section 4.1)."""


class DecayLaw(StrEnum):
    """A law of escape; the value is its name on paper."""

    EXPONENTIAL = "exponential"
    POWER_LAW = "power law"


@dataclass(frozen=True)
class LawFit:
    """One law, fitted to the escapes between t_low and t_high.

    Attributes
    ----------
    law
        Which.
    rate
        κ of exp(−κ (t − t_low)), in 1/time, or γ of (t / t_low)^(−γ), dimensionless; below 0 where escapes grow more frequent.
    low, high
        Its 95 % bootstrap interval, t_low held fixed.
    distance
        Kolmogorov–Smirnov: largest difference of the distribution of the escape times from the fitted one, 0 to 1.
    p_value
        How often a sample of the fitted law lies as far from its own fit, 0 to 1.
    t_low, t_high
        The window.
    survival_low, survival_high
        S(t_low), S(t_high) of the starts.
    """

    law: DecayLaw
    rate: float
    low: float
    high: float
    distance: float
    p_value: float
    t_low: float
    t_high: float
    survival_low: float
    survival_high: float

    @property
    def plausible(self) -> bool:
        """Whether the escapes do decay, and do not rule this law out."""
        return self.p_value >= LEAST_P_VALUE and self.low > 0.0

    def curve(self, t: Any) -> np.ndarray:
        """The fitted S(t), to be drawn over the survival: it meets it at both ends of the window; NaN outside the window."""
        t_array = np.asarray(t, dtype=float)
        inside = (t_array >= self.t_low) & (t_array <= self.t_high)
        clock_times = read_clock(self.law, self.t_low, self.t_high, np.where(inside, t_array, self.t_low))
        left = share_left(self.rate * clock_length(self.law, self.t_low, self.t_high), clock_times)
        fitted: np.ndarray = self.survival_low - (self.survival_low - self.survival_high) * left
        return np.where(inside, fitted, np.nan)


@dataclass(frozen=True, eq=False)
class DecayLaws:
    """How the starts of a map, or of a part of it, leave; arrays are read-only.

    Attributes
    ----------
    times, survival
        (m,) S(t), as from `compute_survival`.
    t_low, t_high
        The window of the fits; t_low is NaN where none could be chosen.
    escapes
        How many different escape times lie in it (in (0, t_high] where t_low is NaN).
    escapes_in_all
        How many different escape times there are.
    undecided
        How many starts are still under way; with any there is no fit.
    settled
        Whether the window was given, or begins where the rule found a law to hold; without it no law is preferred.
    exponential, power_law
        The fits; None where there is no fit.
    preferred
        The law that describes these escapes: not ruled out itself and, of the two, surely the likelier; else None.
    ratio, ratio_low, ratio_high
        Log-likelihood per escape of the exponential law less that of the power law, and its 95 % bootstrap interval; NaN
        without fits.
    """

    times: np.ndarray = field(repr=False)
    survival: np.ndarray = field(repr=False)
    t_low: float
    t_high: float
    escapes: int
    escapes_in_all: int
    undecided: int
    settled: bool = False
    exponential: LawFit | None = None
    power_law: LawFit | None = None
    preferred: DecayLaw | None = None
    ratio: float = float("nan")
    ratio_low: float = float("nan")
    ratio_high: float = float("nan")

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return self.times.nbytes + self.survival.nbytes

    def describe(self) -> str:
        """One or two sentences: the law with its interval, or why there is none."""
        if self.exponential is None or self.power_law is None:
            return self._describe_absence()
        kappa, gamma = _describe_fit("κ", self.exponential), _describe_fit("γ", self.power_law)
        where = f"{self.escapes} of {self.escapes_in_all} escapes, t = {self.t_low:.4g} to {self.t_high:.4g}"
        if self.preferred is DecayLaw.EXPONENTIAL:
            return f"Exponential: {kappa}; {where}. A power law is less likely{_describe_end(self.power_law)}."
        if self.preferred is DecayLaw.POWER_LAW:
            decades = np.log10(min(self.times[-1], self.t_high) / self.t_low)
            return (
                f"Power law over {decades:.1f} decades: {gamma}; {where}. "
                f"An exponential is less likely{_describe_end(self.exponential)}."
            )
        return f"{self._describe_doubt(self.exponential, self.power_law)} ({where}): exponential {kappa}; power law {gamma}."

    def _describe_absence(self) -> str:
        if self.undecided:
            return f"No law is fitted while {self.undecided} orbits are under way: late escapes would be missing."
        return (
            f"No law is fitted to {self.escapes} escapes: {FEWEST_ESCAPES} are needed in a window, "
            f"{2 * FEWEST_ESCAPES} to choose one."
        )

    def _describe_doubt(self, exponential: LawFit, power_law: LawFit) -> str:
        if not self.settled:
            return "Neither law holds from any time on; they come nearest here"
        if exponential.plausible and power_law.plausible:
            return "Neither law is preferred, both may hold"
        if exponential.plausible or power_law.plausible:
            return "Neither law is preferred, the one that may hold is not surely the likelier"
        return "Neither law holds"


def _describe_fit(symbol: str, fit: LawFit) -> str:
    return f"{symbol} = {fit.rate:.3g} ({fit.low:.3g} to {fit.high:.3g}), {_describe_p_value(fit)}"


def _describe_p_value(fit: LawFit) -> str:
    return f"p = {fit.p_value:.2f}" if fit.p_value >= 0.01 else "p < 0.01"


def _describe_end(fit: LawFit) -> str:
    return "" if fit.plausible else f" and ruled out ({_describe_p_value(fit)})"


def clock_length(law: DecayLaw, t_low: float, t_high: float) -> float:
    """What a rate is multiplied by to give the steepness in the clock of its law."""
    return t_high - t_low if law is DecayLaw.EXPONENTIAL else float(np.log(t_high / t_low))


def read_clock(law: DecayLaw, t_low: float, t_high: float, t: np.ndarray) -> np.ndarray:
    """The clock of a law at times t, from 0 at t_low to 1 at t_high."""
    passed: np.ndarray = t - t_low if law is DecayLaw.EXPONENTIAL else np.log(t / t_low)
    return passed / clock_length(law, t_low, t_high)
