"""Three indicators of chaos on one orbit, side by side: SALI, the finite-time Lyapunov exponent and Birkhoff digits.

Each says regular, chaotic or undecided by a rule of its own, so that they may disagree: most of all on a sticky orbit, which is
chaotic and runs for a long time as if on a torus. All speak of an orbit that stays; of one that escapes they conclude nothing.

The limits below were set on 850 orbits bounded until t = 1e5 on six maps (I at h = 0.12 and 0.13, II at 0.16 and 0.17, III at
0.24 and 0.26); "tori" are those of them that are certified by 8 agreeing digits.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from engine.dynamics.classification import classify_orbits
from engine.dynamics.fates import CHAOS_THRESHOLD, Fate, Regularity, describe_fate, judge_regularity
from engine.execution import SerialExecutor, raise_if_cancelled
from engine.invariant_sets.birkhoff_averages import CERTIFIED_DIGITS, WINDOWS, count_agreeing_digits
from engine.potentials.potential import Potential
from engine.trajectories.trajectory import Orbit
from engine.validation import read_state, read_t_max

EARLIEST_REGULAR = 1000.0
"""No bounded orbit is called regular before this time: weak chaos needs as long to show."""

EARLIEST_GROWTH = 100.0
"""Before this time the growth of a deviation says nothing: along tori it may come near `CHAOTIC_POWER` at t = 30."""

REGULAR_SALI = 1e-5
"""A SALI above this is regular; between it and `CHAOS_THRESHOLD` lie few tori, and orbits whose chaos comes to light later."""

CHAOTIC_POWER = 2.0
"""A deviation longer than t to this power is chaotic. Along tori ln|w|/ln t stayed below 1.5, from t = 100 to 1e5."""

REGULAR_POWER = 1.5
"""A deviation that from t/10 to t grew faster than t to this power is not called regular; on a torus it grows like t."""

CHAOTIC_DIGITS = dict(zip(WINDOWS, (1.0, 2.0, 3.0, 4.0), strict=True))
"""Fewer digits than this at the longest window T are chaotic; the fewest of a torus were 1.4, 2.2, 3.8 and 6.8."""

_FITTED_SAMPLES = 200


class Verdict(StrEnum):
    """What an indicator concludes of a bounded orbit."""

    REGULAR = "regular"
    CHAOTIC = "chaotic"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class BirkhoffDigits:
    """To how many digits weighted averages over two consecutive windows agree, for longer and longer windows.

    Attributes
    ----------
    windows
        (m,) lengths T, rising, dimensionless; those the orbit was bounded for twice over. Empty when there is none.
    digits
        (m,) digits that agree, above 0 to 16; the last one is `CERTIFIED_DIGITS` or more on a torus that shows itself.
    """

    windows: np.ndarray
    digits: np.ndarray

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return self.windows.nbytes + self.digits.nbytes


@dataclass(frozen=True)
class IndicatorVerdict:
    """One indicator at the end of an orbit.

    Attributes
    ----------
    name
        Of the indicator.
    value
        SALI, the exponent per unit of time, or the digits of the longest window; NaN when there is none.
    conclusion
        The `Verdict` on a bounded orbit; None for any other.
    sentence
        The same in words, with what it rests on.
    """

    name: str
    value: float
    conclusion: Verdict | None
    sentence: str


def compute_birkhoff_digits(
    potential: Potential, state: Any, t_max: float, *, cancel: threading.Event | None = None
) -> BirkhoffDigits:
    """Weighted Birkhoff averages of x² and y² along one orbit: to how many digits two windows in a row agree, against length.

    On a torus digits rise fast with the window, along a chaotic orbit they stay at 1 to 3 (Das, Saiki, Sander & Yorke 2017,
    Nonlinearity 30, 4111; Sander & Meiss 2020, Physica D 411, 132569; Duignan & Meiss 2023, Physica D 449, 133749). The window's
    shape is ours, see `engine.invariant_sets.birkhoff_averages`. It runs in the calling thread and stops at the first
    window that certifies.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py; finite, dimensionless: where the first window begins.
    t_max
        How long the orbit may be followed, 0 < t_max ≤ 1e8; two windows must fit. Beyond 128 000 nothing more is done.
    cancel
        When set, the work stops after the window at hand, of which the longest takes some 0.2 s.

    Returns
    -------
    Digits for T = 1000, 4000, 16 000 and 64 000, as far as the orbit is bounded for 2T ≤ t_max. They end early where averages
    cannot be compared: on an orbit along an axis, one of whose coordinates is 0 throughout.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When `state` is not four finite numbers, or `t_max` is out of its range.
    """
    start = read_state("state", state)
    t_max = read_t_max(t_max)
    digits: list[float] = []
    for window in WINDOWS:
        if 2.0 * window > t_max or not _stays(potential, start, 2.0 * window, cancel):
            break
        found = count_agreeing_digits(potential, start[None], window, executor=SerialExecutor(), cancel=cancel)[0]
        raise_if_cancelled(cancel)
        if found == 0.0:
            break
        digits.append(float(found))
        if found >= CERTIFIED_DIGITS:
            break
    arrays = np.array(WINDOWS[: len(digits)]), np.array(digits)
    for array in arrays:
        array.flags.writeable = False
    return BirkhoffDigits(*arrays)


def _stays(potential: Potential, start: np.ndarray, t_end: float, cancel: threading.Event | None) -> bool:
    """Whether the orbit has not left by `t_end`."""
    energy = float(potential.energy(start))
    fate = classify_orbits(potential, energy, start[None], t_end, executor=SerialExecutor(), cancel=cancel).fate[0]
    raise_if_cancelled(cancel)
    return bool(fate == Fate.BOUNDED)


def evaluate_indicators(orbit: Orbit, digits: BirkhoffDigits | None = None) -> tuple[IndicatorVerdict, ...]:
    """What each indicator concludes of an orbit, as far as it was followed.

    Parameters
    ----------
    orbit
        The `Orbit`; SALI and the exponent are those at its end.
    digits
        The `BirkhoffDigits` of the same orbit; None leaves them out.

    Returns
    -------
    The verdicts of SALI, of the Lyapunov exponent and, when given, of the digits. An orbit that escapes, or that starts outside,
    gets its numbers and no conclusion: whether it escapes and whether it is chaotic are different questions.
    """
    if orbit.fate != Fate.BOUNDED:
        return tuple(IndicatorVerdict(name, value, None, _describe_departure(orbit)) for name, value in _values(orbit, digits))
    judged = [_judge_sali(orbit), _judge_exponent(orbit)]
    if digits is not None:
        judged.append(_judge_digits(digits))
    return tuple(
        IndicatorVerdict(name, value, *verdict) for (name, value), verdict in zip(_values(orbit, digits), judged, strict=True)
    )


def _values(orbit: Orbit, digits: BirkhoffDigits | None) -> list[tuple[str, float]]:
    """Name and number of each indicator."""
    values = [("SALI", float(orbit.sali[-1])), ("Lyapunov exponent", float(orbit.lyapunov_exponent[-1]))]
    if digits is not None:
        values.append(("Birkhoff digits", float(digits.digits[-1]) if digits.digits.size else float("nan")))
    return values


def _describe_departure(orbit: Orbit) -> str:
    if orbit.fate < 1:
        return describe_fate(orbit.fate)
    return f"Transient: the orbit leaves at t = {orbit.escape_time:.6g}; this number is of its way out and no verdict."


def _judge_sali(orbit: Orbit) -> tuple[Verdict, str]:
    value, t_end = float(orbit.sali[-1]), float(orbit.t[-1])
    if judge_regularity(value) is Regularity.CHAOTIC:
        verdict, reason = Verdict.CHAOTIC, f"{CHAOS_THRESHOLD:g} or below: two deviations have become one"
    elif t_end < EARLIEST_REGULAR:
        verdict, reason = Verdict.UNDECIDED, f"but t = {t_end:g} is too short to tell"
    elif value > REGULAR_SALI:
        verdict, reason = Verdict.REGULAR, f"above {REGULAR_SALI:g}: two deviations stay apart, as on a torus"
    else:
        verdict, reason = Verdict.UNDECIDED, f"not yet {CHAOS_THRESHOLD:g}, but less than on most tori"
    return verdict, f"SALI is {value:.2g}, {reason}."


def _judge_exponent(orbit: Orbit) -> tuple[Verdict, str]:
    t_end = float(orbit.t[-1])
    growth = float(orbit.lyapunov_exponent[-1]) * t_end
    if t_end < EARLIEST_GROWTH:
        verdict, reason = Verdict.UNDECIDED, f"but t = {t_end:g} is too short to tell"
    else:
        verdict, reason = _judge_growth(growth, _find_growth_power(orbit), t_end)
    return verdict, f"A deviation grew by e^{growth:.3g}, {reason}."


def _judge_growth(growth: float, power: float, t_end: float) -> tuple[Verdict, str]:
    """From the logarithm of the growth and the power of t it followed last: no power of t keeps up with chaos."""
    limit = CHAOTIC_POWER * float(np.log(t_end))
    if growth > limit:
        return Verdict.CHAOTIC, f"more than t^{CHAOTIC_POWER:g} = e^{limit:.3g}, which no torus reaches"
    if t_end < EARLIEST_REGULAR:
        return Verdict.UNDECIDED, f"but t = {t_end:g} is too short to tell"
    if power <= REGULAR_POWER:
        return Verdict.REGULAR, f"of late like t^{power:.2f}, on a torus like t; an exponent above {limit / t_end:.2g} would show"
    return Verdict.UNDECIDED, f"less than t^{CHAOTIC_POWER:g}, but of late like t^{power:.2f}, faster than on a torus"


def _find_growth_power(orbit: Orbit) -> float:
    """The power of t like which the deviation grew from a tenth of the orbit to its end."""
    last = orbit.t.size - 1
    sample = np.unique(np.geomspace(0.1 * last, last, _FITTED_SAMPLES).astype(int))
    t = orbit.t[sample]
    slope, _ = np.polyfit(np.log(t), orbit.lyapunov_exponent[sample] * t, 1)
    return float(slope)


def _judge_digits(found: BirkhoffDigits) -> tuple[Verdict, str]:
    if not found.digits.size:
        return Verdict.UNDECIDED, "No windows to compare: the orbit is too short, or runs along an axis."
    window, value = float(found.windows[-1]), float(found.digits[-1])
    least, most = CERTIFIED_DIGITS, CHAOTIC_DIGITS[window]
    if value >= least:
        verdict, reason = Verdict.REGULAR, f"{least:g} or more, as on a torus"
    elif value < most:
        verdict, reason = Verdict.CHAOTIC, f"below {most:g}: fewer than on any torus we know"
    else:
        verdict, reason = Verdict.UNDECIDED, f"neither below {most:g}, as in chaos, nor {least:g}, as on a torus"
    return verdict, f"Averages over two windows of T = {window:g} agree to {value:.1f} digits, {reason}."
