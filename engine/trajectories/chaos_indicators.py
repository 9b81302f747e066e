"""Chaos indicators of one orbit: SALI, the finite-time Lyapunov exponent and Birkhoff digits.

Each indicator judges a bounded orbit by its own rule. SALI and the exponent come from deviation vectors, which can show chaos.
Where they do not, there is no sign of chaos until then: sticky orbits follow a torus for a long time before they leave it. Only
averages that agree as on a torus make an orbit regular. An escaping orbit can be chaotic while it is inside; there is no other
verdict on it.

The thresholds below were calibrated on 850 orbits bounded until t = 1e5 on six maps (I at h = 0.12 and 0.13, II at 0.16 and 0.17,
III at 0.24 and 0.26). "Tori" are the orbits among them with 8 agreeing digits. `benchmarks.verdicts` counts how many of
the verdicts turn out wrong later.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any

import numpy as np

from engine.evidence.birkhoff_averages import REGULAR_DIGITS, TORUS_DIGITS, WINDOWS, count_agreeing_digits
from engine.exits.exit_rows import exits_of_orbit
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.result import Result
from engine.foundations.validation import checked_state, checks_types
from engine.foundations.wording import format_time
from engine.propagation.batch import OrbitBatch, propagate_batch
from engine.propagation.fates import CHAOS_THRESHOLD, MIN_REGULAR_TIME, Fate, describe_fate, is_chaotic, outcome_of
from engine.systems.potential import Potential
from engine.systems.well_units import TIME
from engine.trajectories.trajectory import Orbit

MIN_GROWTH_TIME = 100.0
"""Shortest orbit judged by the growth of a deviation vector, in units of the well.

On tori ln|w|/ln t can come close to `CHAOTIC_POWER` at t = 30.
"""

REGULAR_SALI = 1e-5
"""A SALI above this is no sign of chaos. Between this and `CHAOS_THRESHOLD` are few tori, and orbits that turn chaotic later."""

CHAOTIC_POWER = 2.0
"""A deviation vector that grew beyond t to this power is chaotic. On tori ln|w|/ln t stayed below 1.5 from t = 100 to 1e5."""

REGULAR_POWER = 1.5
"""Fastest growth from t/10 to t, as a power of t, that is no sign of chaos. On a torus a deviation vector grows like t."""

CHAOTIC_DIGITS = dict(zip(WINDOWS, (1.0, 2.0, 3.0, 4.0), strict=True))
"""An orbit with fewer digits than this is chaotic, by window T. The smallest values on tori were 1.4, 2.2, 3.8 and 6.8."""

_GROWTH_FIT_SAMPLES = 200


class Verdict(StrEnum):
    """Conclusion about a bounded orbit; the last one is about an orbit that escapes.

    ``NO_SIGN``: like a regular orbit until the end of the integration, but without evidence of a torus.
    ``UNDECIDED``: too short to tell, or in between.
    """

    REGULAR = "regular"
    CHAOTIC = "chaotic"
    NO_SIGN = "no sign of chaos"
    UNDECIDED = "undecided"
    CHAOTIC_INSIDE = "chaotic while inside"


@dataclass(frozen=True, eq=False, repr=False)
class BirkhoffDigits(Result):
    """Number of digits to which weighted averages over two consecutive windows agree, by window length; arrays are read-only.

    Attributes
    ----------
    windows
        (m,) increasing window lengths T, dimensionless, with the orbit bounded for 2T. Empty for a shorter orbit.
    digits
        (m,) agreeing digits, above 0 and at most 16. On a recognised torus the last value is `TORUS_DIGITS` or more.
    time_unit
        Unit of time of the well before rounding, 1/ω, of which the windows are multiples.
    """

    windows: np.ndarray = field(metadata=TIME)
    digits: np.ndarray
    time_unit: float = field(default=1.0, metadata=TIME)

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return self.windows.nbytes + self.digits.nbytes


@dataclass(frozen=True)
class IndicatorVerdict:
    """Result of one indicator at the end of an orbit.

    Attributes
    ----------
    name
        Name of the indicator.
    value
        SALI, the exponent per unit of time, or the digits of the longest window; NaN if not available.
    conclusion
        The `Verdict` for a bounded orbit, ``CHAOTIC_INSIDE`` for one that is chaotic before it escapes, otherwise None.
    sentence
        The conclusion and its reason in words.
    """

    name: str
    value: float
    conclusion: Verdict | None
    sentence: str


@checks_types(potential=Potential, execution=Execution)
def compute_birkhoff_digits(
    potential: Potential, state: Any, t_max: float, *, execution: Execution = DEFAULT_EXECUTION
) -> BirkhoffDigits:
    """Compare weighted Birkhoff averages of x² and y² over two consecutive windows, for increasing window lengths.

    The number of agreeing digits rises fast with the window length on a torus and stays at 1 to 3 along a chaotic orbit (Das,
    Saiki, Sander & Yorke 2017, Nonlinearity 30, 4111; Sander & Meiss 2020, Physica D 411, 132569; Duignan & Meiss 2023, Physica D
    449, 133749). `engine.evidence.birkhoff_averages` describes the weight function. The computation runs in the calling
    thread and stops at the first window with `TORUS_DIGITS` digits.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py at the start of the first window; finite, dimensionless.
    t_max
        Largest total time of two windows, 0 < t_max ≤ 1e8, dimensionless. No window uses more than 128 000.
    execution
        How the computation runs.

    Returns
    -------
    The `BirkhoffDigits` for T = 1000, 4000, 16 000 and 64 000 time units of the well, as long as the orbit is bounded for
    2T ≤ t_max. They end early if the averages cannot be compared: on an orbit along an axis one coordinate is 0 throughout.
    There are none around bodies, which the fixed steps of the averages cannot pass.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If `state` is not four finite numbers or `t_max` is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, compute_birkhoff_digits
    >>> compute_birkhoff_digits(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=2000.0).digits.round(1)
    array([8.9])
    """
    start, units = checked_state("state", state), potential.units
    t_max = potential.checked_t_max(t_max)
    return units.restore(_compare_windows(potential.in_well_units, start[None] / units.state, t_max / units.time, execution))


def _compare_windows(potential: Potential, start: np.ndarray, t_max: float, execution: Execution) -> BirkhoffDigits:
    """`compute_birkhoff_digits` of a state (1, 4) in units of the well."""
    curves = exits_of_orbit(potential, float(potential.energy(start)[0]))[0][None]
    orbit = OrbitBatch.from_starts(start, np.zeros(1, np.int64))
    orbit.mark_outside(potential, np.arange(1), curves, execution=execution.in_this_thread())
    digits: list[float] = []
    # Not in units of the well, which are rounded: verdicts must not depend on the user's units.
    unit = potential.well.exact_time_unit
    windows = [window * unit for window in WINDOWS]
    for window in windows:
        if potential.gaps or 2.0 * window > t_max or not _stays_inside(potential, curves, orbit, 2.0 * window, execution):
            break
        found = count_agreeing_digits(potential, start, window, execution=execution.in_this_thread())[0]
        execution.raise_if_cancelled()
        if found == 0.0:
            break
        digits.append(float(found))
        if found >= TORUS_DIGITS:
            break
    return BirkhoffDigits(read_only(np.array(windows[: len(digits)])), read_only(np.array(digits)), unit)


def _stays_inside(potential: Potential, curves: np.ndarray, orbit: OrbitBatch, t_end: float, execution: Execution) -> bool:
    """Continue a batch of one orbit; whether it has not escaped by `t_end`."""
    propagate_batch(potential, curves, orbit, np.arange(1), t_end, final=False, execution=execution.in_this_thread())
    execution.raise_if_cancelled()
    return bool(orbit.fate[0] == Fate.NOT_COMPUTED)


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
    One `IndicatorVerdict` each for SALI, the Lyapunov exponent, the Birkhoff digits of both halves of a bounded orbit and, if
    given, the digits. An orbit that escapes is chaotic while
    inside where SALI or the growth of a deviation vector reached the threshold of chaos before; otherwise it gets values but no
    conclusion, as does a start outside: no orbit that escapes is regular, and one that escapes early may not show its chaos.

    Examples
    --------
    >>> from escape_explorer import CASES, evaluate_indicators, integrate_orbit
    >>> for indicator in evaluate_indicators(integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.3), t_max=2e3)):
    ...     print(indicator.name, indicator.conclusion)
    SALI no sign of chaos
    Lyapunov exponent no sign of chaos
    Birkhoff digits of halves regular
    """
    values = _final_values(orbit, digits)
    judged: list[tuple[Verdict | None, str]]
    if orbit.fate == Fate.BOUNDED:
        judged = [_judge_sali(orbit), _judge_exponent(orbit), _judge_halves(orbit)]
        judged += [_judge_digits(orbit, digits)] if digits is not None else []
    elif orbit.fate >= 1:
        judged = [_judge_sali_inside(orbit), _judge_growth_inside(orbit), (None, _describe_escape(orbit))][: len(values)]
    else:
        judged = [(None, describe_fate(orbit.fate, orbit.outcomes))] * len(values)
    return tuple(IndicatorVerdict(name, value, *verdict) for (name, value), verdict in zip(values, judged, strict=True))


def _final_values(orbit: Orbit, digits: BirkhoffDigits | None) -> list[tuple[str, float]]:
    """Name and final value of each indicator."""
    values = [("SALI", float(orbit.sali[-1])), ("Lyapunov exponent", float(orbit.lyapunov_exponent[-1]))]
    if orbit.fate == Fate.BOUNDED:
        values.append(("Birkhoff digits of halves", orbit.digits_of_halves))
    if digits is not None:
        values.append(("Birkhoff digits", float(digits.digits[-1]) if digits.digits.size else float("nan")))
    return values


def _describe_escape(orbit: Orbit) -> str:
    verb = outcome_of(orbit.fate, orbit.outcomes).present.partition(" ")[0]
    return f"The orbit {verb} at t = {format_time(orbit.escape_time)}, so this is not a verdict."


def _describe_end(orbit: Orbit) -> str:
    return f"{outcome_of(orbit.fate, orbit.outcomes).event} at t = {format_time(orbit.escape_time)}"


def _judge_sali_inside(orbit: Orbit) -> tuple[Verdict | None, str]:
    """Verdict on an orbit that escapes, whose history ends there."""
    least = float(np.min(orbit.sali))
    if not is_chaotic(least):
        return None, _describe_escape(orbit)
    return (
        Verdict.CHAOTIC_INSIDE,
        f"SALI fell to {least:.2g} before the {_describe_end(orbit)}: {CHAOS_THRESHOLD:g} or below is chaotic.",
    )


def _judge_growth_inside(orbit: Orbit) -> tuple[Verdict | None, str]:
    """The same from the growth of a deviation vector."""
    t_end = float(orbit.t[-1])
    log_growth = float(orbit.lyapunov_exponent[-1]) * t_end
    if t_end < MIN_GROWTH_TIME * orbit.time_unit or log_growth <= _growth_limit(t_end, orbit.time_unit):
        return None, _describe_escape(orbit)
    power = f"t^{CHAOTIC_POWER:g}"
    return (
        Verdict.CHAOTIC_INSIDE,
        f"A deviation vector grew by e^{log_growth:.3g} before the {_describe_end(orbit)}, more than {power}.",
    )


def _growth_limit(t_end: float, time_unit: float) -> float:
    """Logarithm of the largest growth of a deviation vector that is not chaotic."""
    return CHAOTIC_POWER * float(np.log(t_end / time_unit))


def _judge_sali(orbit: Orbit) -> tuple[Verdict, str]:
    value, t_end = float(orbit.sali[-1]), float(orbit.t[-1])
    if is_chaotic(value):
        verdict, reason = Verdict.CHAOTIC, f"{CHAOS_THRESHOLD:g} or below: the two deviation vectors are aligned"
    elif t_end < MIN_REGULAR_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    elif value > REGULAR_SALI:
        verdict, reason = _no_sign(t_end, f"above {REGULAR_SALI:g}: the deviation vectors stay apart, as on a torus")
    else:
        verdict, reason = Verdict.UNDECIDED, f"above {CHAOS_THRESHOLD:g}, but less than on most tori"
    return verdict, f"SALI is {value:.2g}, {reason}."


def _judge_exponent(orbit: Orbit) -> tuple[Verdict, str]:
    t_end = float(orbit.t[-1])
    log_growth = float(orbit.lyapunov_exponent[-1]) * t_end
    if t_end < MIN_GROWTH_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    else:
        verdict, reason = _judge_growth(log_growth, _fit_growth_power(orbit), t_end, orbit.time_unit)
    return verdict, f"A deviation vector grew by e^{log_growth:.3g}, {reason}."


def _judge_growth(log_growth: float, power: float, t_end: float, time_unit: float) -> tuple[Verdict, str]:
    """Verdict and reason from the logarithm of the growth until `t_end` and the recent growth as a power of t."""
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
    return Verdict.NO_SIGN, f"{reason}: no sign of chaos until t = {format_time(t_end)}"


def _undecided_too_short(t_end: float) -> tuple[Verdict, str]:
    return Verdict.UNDECIDED, f"but t = {format_time(t_end)} is too short to tell"


def _fit_growth_power(orbit: Orbit) -> float:
    """Power of t by which the first deviation vector grew over the last nine tenths of the orbit."""
    last = orbit.t.size - 1
    sample = np.unique(np.geomspace(0.1 * last, last, _GROWTH_FIT_SAMPLES).astype(int))
    t = orbit.t[sample]
    slope, _ = np.polyfit(np.log(t), orbit.lyapunov_exponent[sample] * t, 1)
    return float(slope)


def _judge_halves(orbit: Orbit) -> tuple[Verdict, str]:
    value, t_end = orbit.digits_of_halves, float(orbit.t[-1])
    if t_end < MIN_REGULAR_TIME * orbit.time_unit:
        verdict, reason = _undecided_too_short(t_end)
    elif value >= REGULAR_DIGITS:
        verdict, reason = Verdict.REGULAR, f"{REGULAR_DIGITS:g} or more, as on a torus"
    else:
        verdict, reason = Verdict.UNDECIDED, f"fewer than {REGULAR_DIGITS:g}: this shows no torus"
    return verdict, f"Averages over both halves of the orbit agree to {value:.1f} digits, {reason}."


def _judge_digits(orbit: Orbit, digits: BirkhoffDigits) -> tuple[Verdict, str]:
    if not digits.digits.size:
        return Verdict.UNDECIDED, f"No windows to compare: {_reason_without_windows(orbit)}."
    window, value = float(digits.windows[-1]), float(digits.digits[-1])
    chaotic = CHAOTIC_DIGITS[min(WINDOWS, key=lambda known: abs(known - window / digits.time_unit))]
    if value >= TORUS_DIGITS:
        verdict, reason = Verdict.REGULAR, f"{TORUS_DIGITS:g} or more, as on a torus"
    elif value < chaotic:
        verdict, reason = Verdict.CHAOTIC, f"below {chaotic:g}: fewer than on any known torus"
    else:
        verdict, reason = Verdict.UNDECIDED, f"neither below {chaotic:g}, as in chaos, nor {TORUS_DIGITS:g}, as on a torus"
    return verdict, f"Averages over two windows of T = {format_time(window)} agree to {value:.1f} digits, {reason}."


def _reason_without_windows(orbit: Orbit) -> str:
    """Why a bounded orbit has no Birkhoff digits, see `compute_birkhoff_digits`."""
    if orbit.potential is not None and orbit.potential.gaps:
        return "the fixed steps of these averages cannot pass close to a body"
    shortest = 2.0 * WINDOWS[0] * orbit.time_unit
    if orbit.t[-1] < shortest:
        return f"t = {format_time(float(orbit.t[-1]))} is too short; the shortest two take t = {format_time(shortest)}"
    return "the orbit runs along an axis"
