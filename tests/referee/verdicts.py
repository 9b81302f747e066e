"""Compare verdicts on bounded orbits, regular or chaotic, with the growth of an own deviation vector."""

from __future__ import annotations

import math

import numpy as np

from engine import (
    Evidence,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    Window,
    compute_map,
    compute_regularity,
    integrate_orbit,
    judge_orbit,
    start_states,
)
from engine.trajectories.chaos_indicators import Verdict
from tests.referee.own_orbits import UndecidedError
from tests.referee.report import REFUSED, UNDECIDED, Report
from tests.referee.setting import Setting

CHECK = "verdicts"
# Duration in units of time, and factor for the start of an example; pixels along a side of the map, and largest number compared.
DURATION, LONGER, SIDE, MOST = 1000.0, 10.0, 8, 4
# ln of the growth that only chaos reaches, beyond the power of time that regular orbits reach.
_CHAOTIC_GROWTH, _REGULAR_POWER = 20.0, 2.0
# Times at which the growth is read, as shares of the duration.
_SHARES = np.array([0.25, 0.5, 1.0])

_CHAOTIC = (Regularity.CHAOTIC, Verdict.CHAOTIC)
_NOT_CHAOTIC = (Regularity.REGULAR, Regularity.NO_SIGN_OF_CHAOS, Verdict.REGULAR, Verdict.NO_SIGN)


def check_verdicts(setting: Setting, seed: int, report: Report) -> None:
    """Compare the verdicts of a small map on bounded pixels, and that on one orbit."""
    t_max = DURATION * setting.time_unit * (LONGER if setting.is_start_of_example else 1.0)
    try:
        found = compute_map(_request(setting, t_max))
        characters = compute_regularity(found).character
    except ValueError as error:
        report.add(CHECK, REFUSED, str(error))
        return
    bounded = np.flatnonzero(found.fate.ravel() == Fate.BOUNDED)
    chosen = np.random.default_rng(seed).permutation(bounded)[:MOST]
    states = start_states(setting.potential, Plane.X_PX, setting.energy, *found.coordinates(chosen))
    for pixel, state in zip(chosen, states, strict=True):
        _compare(setting, state, t_max, [Regularity(int(characters.flat[pixel]))], int(found.evidence.flat[pixel]), report)
    if len(states):
        orbit = integrate_orbit(setting.potential, states[0], t_max=t_max)
        if orbit.fate == Fate.BOUNDED:
            _compare(setting, states[0], t_max, [judge_orbit(orbit).character], int(orbit.evidence), report)


def _request(setting: Setting, t_max: float) -> MapSpec:
    """The request of the map: around the start of an example, otherwise the default window."""
    if not setting.is_start_of_example or setting.formula.state[1]:
        return MapSpec(setting.potential, Plane.X_PX, setting.energy, (SIDE, SIDE), t_max=t_max)
    x, _, px, _ = setting.formula.state
    reach = 1e-9 * setting.potential.units.length
    window = Window(x - reach, x + reach, px - reach, px + reach)
    return MapSpec(setting.potential, Plane.X_PX, setting.energy, (1, 1), window, t_max=t_max)


def _compare(setting: Setting, state: np.ndarray, t_max: float, said: list, evidence: int, report: Report) -> None:
    known = {"start": state.tolist(), "said": [str(each) for each in said], "evidence": Evidence(evidence).name, "t_max": t_max}
    try:
        growths = [setting.orbits.growth(each, t_max * _SHARES) for each in (state, setting.shifted(state[None])[0])]
        _check_evidence(setting, state, t_max, evidence, known, report)
    except UndecidedError as error:
        report.add(CHECK, UNDECIDED, str(error))
        return
    power = _REGULAR_POWER * math.log(t_max / setting.time_unit)
    known["growth"] = growths[0].tolist()
    for verdict in said:
        if verdict in _NOT_CHAOTIC:
            chaotic = min(growth[-1] for growth in growths) > _CHAOTIC_GROWTH + power
            report.judge(CHECK, f"chaos is called {verdict}", not chaotic, **known, **setting.reproduction)
        elif verdict in _CHAOTIC:
            late = _REGULAR_POWER * math.log(1.0 / _SHARES[0])
            regular = all(growth[-1] < power and growth[-1] - growth[0] < late for growth in growths)
            report.judge(CHECK, "a regular orbit is called chaotic", not regular, **known, **setting.reproduction)
        else:
            report.add(CHECK, UNDECIDED, f"verdict {verdict}")


def _check_evidence(setting: Setting, state: np.ndarray, t_max: float, evidence: int, known: dict, report: Report) -> None:
    """An orbit that is called bounded on evidence does not cross an exit within twice the duration."""
    if evidence in (Evidence.NONE, Evidence.INTEGRATED, Evidence.CLOSED) or not setting.exits.channels:
        return
    ends = [setting.orbits.end_of(each, setting.exits, 2.0 * t_max) for each in (state, setting.shifted(state[None])[0])]
    escapes = all(end.channel or (np.hypot(*end.state[:2]) > setting.orbits.farthest) for end in ends)
    report.judge(
        CHECK, f"bounded on evidence ({Evidence(evidence).name}), but escapes", not escapes, **known, **setting.reproduction
    )
