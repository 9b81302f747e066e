"""Compare fates and escape times of robust orbits with own integrations."""

from __future__ import annotations

import numpy as np

from engine import Fate, classify_orbits
from tests.referee.own_orbits import EnergyError, UndecidedError
from tests.referee.report import UNDECIDED, Report
from tests.referee.setting import DURATION, STEADY, Setting

CHECK = "fates"
STARTS = 12
# Rounding of escape times by the sampled exits, in units of time.
_ROUNDING = 1e-5

# Largest distance of the ends of a bounded orbit and of a shifted one that resolve where the orbit goes, in units of the size.
_NEAR = 0.1

FARTHER = 1000.0
"""Factor of the distance up to which an orbit is followed to see whether it comes back, possibly from a large outer well."""

# Factor of the time within which orbits come back: one that stays near a Lyapunov orbit for a while comes back later.
_LONGER = 4.0


def check_fates(setting: Setting, seed: int, report: Report) -> None:
    """Compare the fates of random starts, half of them from where the origin is seen, and of the start of an example."""
    states = np.vstack([setting.random_starts(STARTS, seed), setting.hidden_starts(STARTS, seed)])
    if setting.is_start_of_example:
        states = np.vstack([states, setting.formula.state])
    if not len(states):
        report.add(CHECK, UNDECIDED, "no start")
        return
    found = classify_orbits(setting.potential, setting.energy, states, t_max=DURATION * setting.time_unit)
    for k, (start, other) in enumerate(zip(states, setting.shifted(states), strict=True)):
        try:
            _check_orbit(setting, start, other, int(found.fate[k]), float(found.escape_time[k]), report)
        except UndecidedError as error:
            report.add(CHECK, UNDECIDED, str(error))


def _check_orbit(setting: Setting, start: np.ndarray, other: np.ndarray, fate: int, time: float, report: Report) -> None:
    t_max, unit = DURATION * setting.time_unit, setting.time_unit
    end, shifted = (setting.orbits.end_of(each, setting.exits, t_max) for each in (start, other))
    change = abs(end.time - shifted.time)
    if end.channel != shifted.channel or change > STEADY * unit or fate == Fate.FAILED:
        report.add(CHECK, UNDECIDED, "unresolved" if fate == Fate.FAILED else "the fate changes with a shift of the start")
        return
    is_resolved = np.hypot(*(end.state - shifted.state)[:2]) <= _NEAR * setting.size
    if not is_resolved and end.channel == 0 and fate != 0:
        report.add(CHECK, UNDECIDED, "a bounded orbit changes with a shift of the start")
        return
    known = {"start": start.tolist(), "said": [fate, time], "own": [end.channel, end.time]} | setting.reproduction
    report.judge(CHECK, "a fate differs", fate == end.channel, **known)
    if fate != end.channel:
        return
    if fate > 0:
        report.judge(CHECK, "an escape time differs", abs(time - end.time) <= change + _ROUNDING * unit, **known)
        _check_beyond(setting, end.channel, end.state, known, report)
    elif np.hypot(*end.state[:2]) > setting.orbits.farthest:
        report.judge(CHECK, "a bounded orbit runs away", not setting.orbits.leaves(end.state), **known)


def _check_beyond(setting: Setting, channel: int, state: np.ndarray, known: dict, report: Report) -> None:
    """Compare whether an orbit comes back with the share of the flux through its exit that does."""
    flux = setting.flux
    share = float(flux.returning[flux.channels == channel][0])
    longest = _LONGER * flux.followed_time
    try:
        later = setting.orbits.end_of(_beyond(setting, state), setting.exits, longest, farther=FARTHER)
    except EnergyError:
        raise
    except UndecidedError:
        # The orbit runs to infinity in a finite time.
        later = None
    if later is not None and later.time < longest and not later.channel and not setting.orbits.leaves(later.state):
        report.add(CHECK, UNDECIDED, "an orbit is far away, but does not leave")
        return
    comes_back = later is not None and later.channel > 0
    if comes_back and not share:
        report.add(CHECK, UNDECIDED, "an orbit comes back, but none of those sampled for the flux")
        return
    report.judge(CHECK, "an orbit does not come back", comes_back or share < 1.0, **known, share=share)


def _beyond(setting: Setting, state: np.ndarray) -> np.ndarray:
    """Return the state a little later, so that the crossing is not found again."""
    return setting.orbits.state_at(state, 1e-4 * setting.time_unit)[1]
