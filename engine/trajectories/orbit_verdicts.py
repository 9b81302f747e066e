"""The verdict on one orbit: escaped or bounded, until what time, and regular or chaotic. All texts on orbits are based on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from engine.evidence.birkhoff_averages import TORUS_DIGITS
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_count, format_time
from engine.propagation.fates import Evidence, Fate, describe_evidence, describe_fate, name_fate, outcome_of
from engine.systems.outcomes import Outcome
from engine.trajectories.birkhoff_digits import BirkhoffDigits
from engine.trajectories.chaos_indicators import INDICATORS, IndicatorVerdict, Verdict, evaluate_indicators
from engine.trajectories.trajectory import Orbit, SectionResult

_DEVIATION_INDICATORS = {indicator.name for indicator in INDICATORS if indicator.of_deviations}


@dataclass(frozen=True)
class OrbitVerdict(SectionResult):
    """The facts known about one orbit.

    Attributes
    ----------
    fate
        k ≥ 1 for the outcome ``outcomes[k - 1]``, such as channel k, or a `Fate`.
    t_end
        Time of the escape, or time until which the orbit is integrated, dimensionless.
    crossings
        Crossings of `section` until `t_end`.
    evidence
        The reason why the orbit is called bounded: ``INTEGRATED`` holds only until `t_end`, ``CLOSED`` for ever, and
        ``QUASI_PERIODIC`` is evidence of a torus, on which the orbit would stay for ever. ``NONE`` for other orbits.
    character
        What the indicators show until `t_end`. For a bounded orbit: "regular", "chaotic", "no sign of chaos" (like a regular
        orbit but without evidence of a torus), or "undecided". For other orbits: "chaotic while inside" or None.
    indicators
        Names and values of the indicators whose conclusion is the character, separated by commas; empty if there are none.
    outcomes
        The outcomes of the potential, see `Potential.outcomes`; empty if they are not known.
    exits_unknown
        The reason why the exits over saddles are not known at the energy, see `Orbit`; empty if they are known.
    findings
        What each indicator concludes: SALI, the Lyapunov exponent, the Birkhoff digits of both halves of a bounded orbit and, if
        given, the digits of windows. Each finding has a `name`, a `value` at the end of the orbit (NaN if not available), a
        `conclusion` (one of the words of `character`, or None) and a `sentence` with the reason.
    """

    fate: int
    t_end: float
    crossings: int
    evidence: Evidence
    character: Verdict | None
    indicators: str
    outcomes: tuple[Outcome, ...] = field(default=(), repr=False)
    exits_unknown: str = ""
    findings: tuple[IndicatorVerdict, ...] = field(default=(), repr=False, compare=False)
    codes: ClassVar = {"fate": Fate, "evidence": Evidence}

    @property
    def is_bounded_for_ever(self) -> bool:
        """Whether the energy proves that the orbit can never escape."""
        return self.evidence is Evidence.CLOSED

    @property
    def outcome(self) -> str:
        """The fate in a word or two."""
        return "not known" if self._may_have_left else name_fate(self.fate, self.outcomes)

    def describe(self) -> str:
        """Describe the verdict in one sentence; if exits are not known, a second sentence says why."""
        reason = f" Exits are not known at this energy: {self.exits_unknown}." if self.exits_unknown else ""
        return self._describe_fate() + reason

    def _describe_fate(self) -> str:
        """Describe the fate, the evidence and the character in one sentence."""
        crossings, time = self.section.count(self.crossings), format_time(self.t_end)
        if self.fate >= 1:
            manner = f"after {crossings}" if self.crossings else f"directly, {self.section.words.absence}"
            return f"{outcome_of(self.fate, self.outcomes).past} at t = {time}, {manner}{self._character_inside}."
        if self.character is None:
            # The orbit neither escaped nor is bounded, as when its start is forbidden.
            return describe_fate(self.fate, self.outcomes)
        reason = describe_evidence(self.evidence)
        match self.evidence:
            case Evidence.CLOSED:
                return f"Bounded for ever ({reason}){self._character_bounded}, with {crossings} until t = {time}."
            case Evidence.QUASI_PERIODIC:
                return f"Bounded until t = {time} and probably for ever ({reason}){self._character_bounded}, with {crossings}."
            case _:
                return f"{self._participle.capitalize()} until t = {time}{self._character_bounded}, with {crossings}."

    def summarize(self) -> str:
        """Return the verdict in a few words, for lists."""
        if self.fate >= 1:
            return f"{name_fate(self.fate, self.outcomes)} at t = {format_time(self.t_end, digits=5)}{self._character_inside}"
        if self.character is None:
            # The orbit neither escaped nor is bounded, as when its start is forbidden.
            return name_fate(self.fate, self.outcomes)
        until = "for ever" if self.is_bounded_for_ever else f"until t = {format_time(self.t_end)}"
        return f"{self._participle} {until}, {self.character}"

    def headline(self) -> str:
        """Return the verdict in a few rounded words: "Escapes through exit 4 at t = 66.22, after 12 crossings"."""
        if self.fate >= 1:
            action, crossings = outcome_of(self.fate, self.outcomes).present, format_count(self.crossings, "crossing")
            time = format_time(self.t_end, digits=4)
            return f"{action[0].upper()}{action[1:]} at t = {time}, after {crossings}{self._character_inside}"
        summary = self.summarize()
        return summary[0].upper() + summary[1:]

    @property
    def _may_have_left(self) -> bool:
        """Whether the orbit has not ended, but may have passed an exit that is not known."""
        return self.fate == Fate.BOUNDED and bool(self.exits_unknown)

    @property
    def _participle(self) -> str:
        """The participle for an orbit that has not ended."""
        return "followed" if self._may_have_left else "bounded"

    @property
    def _character_bounded(self) -> str:
        """The part of a sentence on the character of a bounded orbit."""
        match self.character:
            case Verdict.UNDECIDED:
                return ", undecided whether regular or chaotic"
            case Verdict.NO_SIGN:
                return f", no sign of chaos until t = {format_time(self.t_end)}"
            case _:
                return f", {self.character} ({self.indicators})"

    @property
    def _character_inside(self) -> str:
        """The part of a sentence on the character of an escaping orbit."""
        return f", {self.character}" if self.character is not None else ""


@checks_types(orbit=Orbit, digits=(BirkhoffDigits, type(None)))
def judge_orbit(orbit: Orbit, digits: BirkhoffDigits | None = None) -> OrbitVerdict:
    """Judge an orbit by its energy, its outcome and its chaos indicators.

    A bounded orbit is regular or chaotic if an indicator concludes so and no indicator concludes the opposite. If none concludes
    either, and all indicators of deviation vectors conclude that there is no sign of chaos, so does the verdict. In all other
    cases, the orbit is undecided. The orbit is bounded for ever if its well is closed at its energy. In a non-rotating well,
    Birkhoff averages that agree as on an invariant torus are evidence that the orbit is bounded for ever
    (`Potential.tori_are_evidence`), unless another indicator shows chaos. An escaping orbit is chaotic while inside if an
    indicator concludes so.

    Parameters
    ----------
    orbit
        The `Orbit`.
    digits
        The `BirkhoffDigits` of this orbit, ``orbit.compute_birkhoff_digits()``; None to judge without digits.

    Examples
    --------
    >>> from escape_explorer import CASES, integrate_orbit, judge_orbit
    >>> print(judge_orbit(integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), t_max=1e3)).describe())
    Escaped through exit 1 at t = 15.1781, after 1 upward crossing of y = 0.
    >>> judge_orbit(integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=1e3)).summarize()
    'bounded for ever, regular'
    >>> for finding in judge_orbit(integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.3), t_max=2e3)).findings:
    ...     print(finding.name, finding.conclusion)
    SALI no sign of chaos
    Lyapunov exponent no sign of chaos
    Birkhoff digits of halves regular
    """
    findings = evaluate_indicators(orbit, digits)
    conclusions = [finding.conclusion for finding in findings]
    character = _combine_conclusions(findings) if orbit.fate == Fate.BOUNDED else _judge_inside(conclusions)
    return OrbitVerdict(
        orbit.fate,
        float(orbit.t[-1]),
        orbit.crossings,
        _find_evidence(orbit, digits, Verdict.CHAOTIC in conclusions),
        character,
        _name_deciding_indicators(findings, character),
        orbit.outcomes,
        orbit.exits_unknown,
        findings=findings,
        section=orbit.section,
        made_by=orbit.made_by,
    )


def _combine_conclusions(findings: Sequence[IndicatorVerdict]) -> Verdict:
    """Combine the conclusions on a bounded orbit, see `judge_orbit`."""
    decisive = {Verdict.REGULAR, Verdict.CHAOTIC}.intersection(finding.conclusion for finding in findings)
    if len(decisive) == 1:
        return decisive.pop()
    deviation_conclusions = {finding.conclusion for finding in findings if finding.name in _DEVIATION_INDICATORS}
    return Verdict.NO_SIGN if not decisive and deviation_conclusions == {Verdict.NO_SIGN} else Verdict.UNDECIDED


def _judge_inside(conclusions: Sequence[Verdict | None]) -> Verdict | None:
    """Return the character of an orbit that is not bounded."""
    return Verdict.CHAOTIC_INSIDE if Verdict.CHAOTIC_INSIDE in conclusions else None


def _name_deciding_indicators(findings: Sequence[IndicatorVerdict], character: Verdict | None) -> str:
    """Return the names and values of the indicators that conclude this character; empty without a character."""
    deciding = [finding for finding in findings if character is not None and finding.conclusion is character]
    return ", ".join(f"{finding.name} {finding.value:.2g}" for finding in deciding)


def _find_evidence(orbit: Orbit, birkhoff_digits: BirkhoffDigits | None, shows_chaos: bool) -> Evidence:
    """Return the evidence of an orbit; `Evidence.QUASI_PERIODIC` if its longest windows show a torus and count as evidence."""
    if orbit.evidence is not Evidence.INTEGRATED or shows_chaos or birkhoff_digits is None or not birkhoff_digits.digits.size:
        return orbit.evidence
    if orbit.potential is not None and not orbit.potential.tori_are_evidence:
        return orbit.evidence
    longest_window_digits = birkhoff_digits.digits[-1]
    return Evidence.QUASI_PERIODIC if longest_window_digits >= TORUS_DIGITS else Evidence.INTEGRATED
