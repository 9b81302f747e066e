"""Chaos indicators of one orbit, the entries of `INDICATORS`: SALI, the finite-time Lyapunov exponent and Birkhoff digits.

Each indicator judges a bounded orbit by its own rule. SALI and the exponent come from deviation vectors. They can show chaos, but
not that an orbit is regular: sticky orbits follow a torus for a long time before they leave it. Only averages that agree as on a
torus make an orbit regular. An escaping orbit can be chaotic while it is inside; no other verdict on it is possible.

The thresholds below were calibrated on 850 orbits bounded until t = 1e5 on six maps (I at h = 0.12 and 0.13, II at 0.16 and 0.17,
III at 0.24 and 0.26). In the texts on thresholds, "tori" are those of the 850 orbits with 8 or more agreeing digits.
`benchmarks.verdicts` counts how many verdicts turn out wrong later.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from engine.evidence.birkhoff_averages import REGULAR_DIGITS, TORUS_DIGITS, WINDOWS
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_number, format_time
from engine.propagation.fates import CHAOS_THRESHOLD, MIN_REGULAR_TIME, Fate, describe_fate, is_chaotic, outcome_of
from engine.trajectories.birkhoff_digits import BirkhoffDigits
from engine.trajectories.trajectory import Orbit

MIN_GROWTH_TIME = 100.0
"""Shortest time after which an orbit is judged by the growth of a deviation vector, in units of the well.

On tori ln|w|/ln t can come close to `CHAOTIC_POWER` at t = 30.
"""

REGULAR_SALI = 1e-5
"""A SALI above this value is no sign of chaos.

The orbits between this value and `CHAOS_THRESHOLD` were a few tori, and orbits that became chaotic later.
"""

CHAOTIC_POWER = 2.0
"""An orbit is chaotic if a deviation vector grew by more than t to this power, t in units of the well.

On tori ln|w|/ln t stayed below 1.5 from t = 100 to 1e5.
"""

REGULAR_POWER = 1.5
"""Largest growth of a deviation vector from t/10 to t, as a power of t, that is no sign of chaos. On a torus it grows like t."""

CHAOTIC_DIGITS = dict(zip(WINDOWS, (1.0, 2.0, 3.0, 4.0), strict=True))
"""By window length T in units of the well, the number of digits below which an orbit is chaotic.

The smallest numbers on tori were 1.4, 2.2, 3.8 and 6.8.
"""

# Number of samples to which the growth of a deviation vector is fitted.
_GROWTH_FIT_SAMPLES = 200


class Verdict(StrEnum):
    """Conclusion about a bounded orbit or, for ``CHAOTIC_INSIDE``, about an orbit that escapes.

    ``NO_SIGN``: the orbit is like a regular orbit until the end of the integration, but without evidence of a torus.
    ``UNDECIDED``: the orbit is too short to tell, or the value is between regular and chaotic values.
    """

    REGULAR = "regular"
    CHAOTIC = "chaotic"
    NO_SIGN = "no sign of chaos"
    UNDECIDED = "undecided"
    CHAOTIC_INSIDE = "chaotic while inside"


@dataclass(frozen=True)
class IndicatorVerdict:
    """The conclusion of one indicator at the end of an orbit.

    Attributes
    ----------
    name
        Name of the indicator.
    value
        SALI, the exponent per unit of time, or the digits of the longest window; NaN if not available.
    conclusion
        The `Verdict` for a bounded orbit, ``CHAOTIC_INSIDE`` for an orbit that is chaotic before it escapes, otherwise None.
    sentence
        The conclusion and its reason in words.
    """

    name: str
    value: float
    conclusion: Verdict | None
    sentence: str


_Judgement = tuple[Verdict | None, str]
_Digits = BirkhoffDigits | None


@dataclass(frozen=True)
class Indicator:
    """An indicator of chaos, as functions of an orbit and of its `BirkhoffDigits`, which may be None.

    Attributes
    ----------
    name
        The name in texts.
    value
        Returns the value of the indicator at the end of an orbit.
    judge
        Returns the verdict on a bounded orbit, and its reason in words.
    judge_inside
        Returns the verdict on an orbit that escapes; None if the indicator shows no chaos before the escape.
    applies
        Returns whether an orbit has this indicator.
    of_deviations
        Whether the indicator is computed from deviation vectors, which can show chaos; other indicators detect tori.
    """

    name: str
    value: Callable[[Orbit, _Digits], float]
    judge: Callable[[Orbit, _Digits], _Judgement]
    judge_inside: Callable[[Orbit], _Judgement | None] = lambda orbit: None
    applies: Callable[[Orbit, _Digits], bool] = lambda orbit, digits: True
    of_deviations: bool = False


@checks_types(orbit=Orbit, digits=(BirkhoffDigits, type(None)))
def evaluate_indicators(orbit: Orbit, digits: BirkhoffDigits | None = None) -> tuple[IndicatorVerdict, ...]:
    """Evaluate the chaos indicators of an orbit at its end.

    Parameters
    ----------
    orbit
        The `Orbit`; its final SALI and Lyapunov exponent are used.
    digits
        The `BirkhoffDigits` of the same orbit; None leaves them out.

    Returns
    -------
    One `IndicatorVerdict` each for SALI, for the Lyapunov exponent, for the Birkhoff digits of both halves of a bounded orbit
    and, if given, for `digits`; `OrbitVerdict.findings` contains these results. An orbit that escapes is chaotic while inside if
    SALI or the growth of a deviation vector reached the threshold of chaos before the escape. Other escaping orbits and starts
    outside have values but no conclusion: no escaping orbit is regular, and an orbit that escapes early may not show its chaos.
    """
    return tuple(_evaluate(indicator, orbit, digits) for indicator in INDICATORS if indicator.applies(orbit, digits))


def _evaluate(indicator: Indicator, orbit: Orbit, digits: _Digits) -> IndicatorVerdict:
    """Return the conclusion of one indicator."""
    judgement: _Judgement
    value = indicator.value(orbit, digits)
    is_known = not indicator.of_deviations or np.isfinite(value)
    if orbit.fate == Fate.BOUNDED:
        judgement = indicator.judge(orbit, digits) if is_known else _undecided_not_finite(indicator)
    elif orbit.fate >= 1:
        verdict = indicator.judge_inside(orbit) if is_known else None
        judgement = verdict or (None, _describe_escape_without_chaos(orbit))
    else:
        judgement = (None, describe_fate(orbit.fate, orbit.outcomes))
    return IndicatorVerdict(indicator.name, value, *judgement)


def _undecided_not_finite(indicator: Indicator) -> _Judgement:
    """Return the verdict of an indicator whose value is NaN or infinite."""
    return Verdict.UNDECIDED, f"{indicator.name} is not known: the deviation vectors became too large for numbers."


def _describe_escape_without_chaos(orbit: Orbit) -> str:
    """Return a sentence for an escaping orbit without a sign of chaos."""
    # The first word: "escapes" of "escapes through exit 1".
    verb = outcome_of(orbit.fate, orbit.outcomes).present.partition(" ")[0]
    return f"Too short to tell: the orbit {verb} at t = {format_time(orbit.escape_time)}."


def _describe_end(orbit: Orbit) -> str:
    """Return the event that ended an orbit, with its time, such as "escape through exit 1 at t = 15.2"."""
    return f"{outcome_of(orbit.fate, orbit.outcomes).event} at t = {format_time(orbit.escape_time)}"


def _judge_sali_inside(orbit: Orbit) -> _Judgement | None:
    """Return the verdict on an escaping orbit from its SALI until the escape; None if SALI shows no chaos."""
    smallest_sali = float(np.min(orbit.sali))
    if not is_chaotic(smallest_sali):
        return None
    fall = f"SALI fell to {smallest_sali:.2g} before the {_describe_end(orbit)}"
    return Verdict.CHAOTIC_INSIDE, f"{fall}: {CHAOS_THRESHOLD:g} or below is chaotic."


def _judge_growth_inside(orbit: Orbit) -> _Judgement | None:
    """Return the verdict on an escaping orbit from the growth of a deviation vector; None if the growth shows no chaos."""
    t_end, log_growth = _measure_growth(orbit)
    if t_end < MIN_GROWTH_TIME * orbit.time_unit or log_growth <= _growth_limit(t_end, orbit.time_unit):
        return None
    growth = f"A deviation vector grew by e^{log_growth:.3g} before the {_describe_end(orbit)}"
    return Verdict.CHAOTIC_INSIDE, f"{growth}, more than t^{CHAOTIC_POWER:g}."


def _measure_growth(orbit: Orbit) -> tuple[float, float]:
    """Return the time at the end of an orbit, and the logarithm of the growth of its first deviation vector until then."""
    t_end = float(orbit.t[-1])
    return t_end, float(orbit.lyapunov_exponent[-1]) * t_end


def _growth_limit(t_end: float, time_unit: float) -> float:
    """Return the logarithm of the largest growth of a deviation vector until `t_end` that is no evidence of chaos."""
    return CHAOTIC_POWER * float(np.log(t_end / time_unit))


def _judge_sali(orbit: Orbit, digits: _Digits) -> _Judgement:
    """Return the verdict on a bounded orbit from its SALI at the end."""
    value, t_end = float(orbit.sali[-1]), float(orbit.t[-1])
    if is_chaotic(value):
        verdict, reason = Verdict.CHAOTIC, f"{format_number(CHAOS_THRESHOLD)} or below: the two deviation vectors are aligned"
    elif t_end < MIN_REGULAR_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    elif value > REGULAR_SALI:
        verdict, reason = _no_sign(t_end, f"above {format_number(REGULAR_SALI)}: the deviation vectors stay apart, as on a torus")
    else:
        verdict, reason = Verdict.UNDECIDED, f"above {format_number(CHAOS_THRESHOLD)}, but less than on most tori"
    return verdict, f"SALI is {format_number(value, 2)}, {reason}."


def _judge_exponent(orbit: Orbit, digits: _Digits) -> _Judgement:
    """Return the verdict on a bounded orbit from the growth of its first deviation vector."""
    t_end, log_growth = _measure_growth(orbit)
    if t_end < MIN_GROWTH_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    else:
        verdict, reason = _judge_growth(log_growth, _fit_growth_power(orbit), t_end, orbit.time_unit)
    return verdict, f"A deviation vector grew by e^{log_growth:.3g}, {reason}."


def _judge_growth(log_growth: float, power: float, t_end: float, time_unit: float) -> tuple[Verdict, str]:
    """Return verdict and reason, given the logarithm of the growth until `t_end` and the recent growth as a power of t."""
    limit = _growth_limit(t_end, time_unit)
    if log_growth > limit:
        return Verdict.CHAOTIC, f"more than t^{CHAOTIC_POWER:g} = e^{limit:.3g}, which no torus reaches"
    if t_end < MIN_REGULAR_TIME * time_unit:
        return _undecided_too_short(t_end)
    if power <= REGULAR_POWER:
        detected = f"an exponent above {limit / t_end:.2g} would be detected"
        return _no_sign(t_end, f"recently like t^{power:.2f}, on a torus like t; {detected}")
    return Verdict.UNDECIDED, f"less than t^{CHAOTIC_POWER:g}, but recently like t^{power:.2f}, faster than on a torus"


def _no_sign(t_end: float, reason: str) -> tuple[Verdict, str]:
    """Return the verdict that there is no sign of chaos, with the reason."""
    return Verdict.NO_SIGN, f"{reason}: no sign of chaos until t = {format_time(t_end)}"


def _undecided_too_short(t_end: float) -> tuple[Verdict, str]:
    """Return the verdict on an orbit that is too short, with the reason."""
    return Verdict.UNDECIDED, f"but t = {format_time(t_end)} is too short to tell"


def _fit_growth_power(orbit: Orbit) -> float:
    """Return the power of t with which the first deviation vector grew over the last nine tenths of the orbit."""
    last = orbit.t.size - 1
    index = np.unique(np.geomspace(0.1 * last, last, _GROWTH_FIT_SAMPLES).astype(int))
    t = orbit.t[index]
    slope, _ = np.polyfit(np.log(t), orbit.lyapunov_exponent[index] * t, 1)
    return float(slope)


def _judge_halves(orbit: Orbit, digits: _Digits) -> _Judgement:
    """Return the verdict on a bounded orbit from the averages over its halves."""
    value, t_end = orbit.digits_of_halves, float(orbit.t[-1])
    if t_end < MIN_REGULAR_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    elif value >= REGULAR_DIGITS:
        verdict, reason = Verdict.REGULAR, f"{REGULAR_DIGITS:g} or more, as on a torus"
    else:
        verdict, reason = Verdict.UNDECIDED, f"fewer than {REGULAR_DIGITS:g}: this shows no torus"
    return verdict, f"Averages over both halves of the orbit agree to {value:.1f} digits, {reason}."


def _digits_of_longest_window(orbit: Orbit, digits: _Digits) -> float:
    """Return the digits for the longest window; NaN without windows."""
    return float(digits.digits[-1]) if digits is not None and digits.digits.size else float("nan")


def _judge_digits(orbit: Orbit, digits: _Digits) -> _Judgement:
    """Return the verdict on a bounded orbit from the averages over the two longest windows."""
    if digits is None or not digits.digits.size:
        return Verdict.UNDECIDED, f"No windows to compare: {_reason_without_windows(orbit)}."
    window, value = float(digits.windows[-1]), float(digits.digits[-1])
    # The quotient is rounded, so the nearest of the windows is used.
    nearest_window = min(WINDOWS, key=lambda each: abs(each - window / digits.time_unit))
    limit = CHAOTIC_DIGITS[nearest_window]
    if value >= TORUS_DIGITS:
        verdict, reason = Verdict.REGULAR, f"{TORUS_DIGITS:g} or more, as on a torus"
    elif value < limit:
        verdict, reason = Verdict.CHAOTIC, f"below {limit:g}: fewer than on any known torus"
    else:
        verdict, reason = Verdict.UNDECIDED, f"neither below {limit:g}, as in chaos, nor {TORUS_DIGITS:g}, as on a torus"
    return verdict, f"Averages over two windows of T = {format_time(window)} agree to {value:.1f} digits, {reason}."


def _reason_without_windows(orbit: Orbit) -> str:
    """Return why a bounded orbit has no Birkhoff digits, see `compute_birkhoff_digits`."""
    if orbit.potential is not None and orbit.potential.gaps:
        return "the digits of regular and chaotic orbits around a body are not known"
    shortest = 2.0 * WINDOWS[0] * orbit.time_unit
    if orbit.t[-1] < shortest:
        return f"t = {format_time(float(orbit.t[-1]))} is too short; the shortest two take t = {format_time(shortest)}"
    return "the orbit runs along an axis"


INDICATORS = (
    Indicator(
        "SALI",
        value=lambda orbit, digits: float(orbit.sali[-1]),
        judge=_judge_sali,
        judge_inside=_judge_sali_inside,
        of_deviations=True,
    ),
    Indicator(
        "Lyapunov exponent",
        value=lambda orbit, digits: float(orbit.lyapunov_exponent[-1]),
        judge=_judge_exponent,
        judge_inside=_judge_growth_inside,
        of_deviations=True,
    ),
    Indicator(
        "Birkhoff digits of halves",
        value=lambda orbit, digits: orbit.digits_of_halves,
        judge=_judge_halves,
        applies=lambda orbit, digits: orbit.fate == Fate.BOUNDED,
    ),
    Indicator(
        "Birkhoff digits",
        value=_digits_of_longest_window,
        judge=_judge_digits,
        applies=lambda orbit, digits: digits is not None,
    ),
)
"""The indicators, in the order in which texts list them."""
