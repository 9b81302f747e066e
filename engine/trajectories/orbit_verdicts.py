"""The verdict on one orbit, which all texts about it follow: escaped or bounded, until when, and regular or chaotic."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from engine.dynamics.certificates import Certificate, describe_certificate
from engine.dynamics.fates import Fate, describe_fate
from engine.invariant_sets.birkhoff_averages import CERTIFIED_DIGITS
from engine.results.result import Result
from engine.results.wording import format_count, format_time
from engine.trajectories.chaos_indicators import BirkhoffDigits, Verdict, evaluate_indicators
from engine.trajectories.trajectory import Orbit


@dataclass(frozen=True)
class OrbitVerdict(Result):
    """What is known of one orbit.

    Attributes
    ----------
    fate
        Channel k ≥ 1, or a `Fate`.
    t_end
        Time of the escape, or time until which the orbit is integrated, dimensionless.
    crossings
        Upward crossings of y = 0 until then.
    certificate
        Why the orbit is called bounded: ``INTEGRATED`` holds until `t_end` only, other certificates for ever. ``NONE`` if it is
        not bounded.
    character
        Regular, chaotic or undecided; None unless the orbit is bounded.
    """

    fate: int
    t_end: float
    crossings: int
    certificate: Certificate
    character: Verdict | None

    @property
    def is_bounded_for_ever(self) -> bool:
        """Whether a certificate shows that the orbit never escapes."""
        return self.certificate not in (Certificate.NONE, Certificate.INTEGRATED)

    def describe(self) -> str:
        """The verdict in one sentence."""
        crossings, time = f"{format_count(self.crossings, 'upward crossing')} of y = 0", format_time(self.t_end)
        if self.fate >= 1:
            kind = f"after {crossings}" if self.crossings else "directly, without crossing y = 0 upward"
            return f"Escaped through channel {self.fate} at t = {time}, {kind}."
        if self.character is None:
            return describe_fate(self.fate)
        undecided = self.character is Verdict.UNDECIDED
        decided = ", undecided whether regular or chaotic" if undecided else f" and {self.character}"
        if self.is_bounded_for_ever:
            reason = describe_certificate(self.certificate)
            return f"Bounded for ever ({reason}){decided}, with {crossings} until t = {time}."
        return f"Bounded until t = {time}{decided}, with {crossings}."

    def summarize(self) -> str:
        """The verdict in a few words, for lists."""
        if self.fate >= 1:
            return f"channel {self.fate} at t = {format_time(self.t_end, digits=5)}"
        if self.character is None:
            return Fate(self.fate).name.lower().replace("_", " ")
        return f"bounded {'for ever' if self.is_bounded_for_ever else f'until t = {format_time(self.t_end)}'}, {self.character}"


def judge_orbit(orbit: Orbit, digits: BirkhoffDigits | None = None) -> OrbitVerdict:
    """The verdict on an orbit, from its energy, its outcome and its chaos indicators.

    A bounded orbit is regular or chaotic if an indicator of `evaluate_indicators` concludes so and none concludes the opposite.
    It is bounded for ever if its energy is below every saddle, or if its Birkhoff averages agree as on an invariant torus: the
    same certificates as those of single pixels on maps.

    Parameters
    ----------
    orbit
        The `Orbit`.
    digits
        The `BirkhoffDigits` of the same orbit; None leaves them out.

    Examples
    --------
    >>> from engine import CASES, integrate_orbit, judge_orbit
    >>> print(judge_orbit(integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), t_max=1e3)).describe())
    Escaped through channel 1 at t = 15.1781, after 1 upward crossing of y = 0.
    >>> print(judge_orbit(integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=1e3)).describe())
    Bounded for ever (its energy is below every saddle) and regular, with 160 upward crossings of y = 0 until t = 1 000.
    """
    conclusions = (indicator.conclusion for indicator in evaluate_indicators(orbit, digits))
    character = _combine(conclusions) if orbit.fate == Fate.BOUNDED else None
    return OrbitVerdict(orbit.fate, float(orbit.t[-1]), orbit.crossings, _certificate(orbit, digits), character)


def _combine(conclusions: Iterable[Verdict | None]) -> Verdict:
    decided = {conclusion for conclusion in conclusions if conclusion is not None and conclusion is not Verdict.UNDECIDED}
    return decided.pop() if len(decided) == 1 else Verdict.UNDECIDED


def _certificate(orbit: Orbit, digits: BirkhoffDigits | None) -> Certificate:
    if orbit.certificate is not Certificate.INTEGRATED or digits is None or not digits.digits.size:
        return orbit.certificate
    return Certificate.QUASI_PERIODIC if digits.digits[-1] >= CERTIFIED_DIGITS else Certificate.INTEGRATED
