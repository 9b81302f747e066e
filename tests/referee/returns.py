"""Compare the share of the flux through an exit that comes back with own orbits that leave there."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.stats import binom

from engine import Fate, classify_orbits
from tests.referee.fates import FARTHER
from tests.referee.own_orbits import EnergyError, UndecidedError
from tests.referee.report import Report
from tests.referee.setting import Setting

CHECK = "returns"
_ORBITS = 16
# Error of the engine's share, which is that of some hundred orbits, and smallest probability of the own number of orbits.
_ERROR, _LEAST_PROBABILITY = 0.08, 1e-7
# Distances in units of the farthest of an orbit, and number of angles, at which V is compared with the energy.
_FAR, _ANGLES = np.geomspace(1.0, 1e8, 100), 3600
# Distance beyond the exit at which the orbits start, in lengths of the exit.
_BEYOND = 1e-6


def check_returns(setting: Setting, seed: int, report: Report) -> None:
    """Compare the share of one exit, chosen at random."""
    if not setting.exits.channels:
        return
    random = np.random.default_rng(seed)
    index = int(random.integers(len(setting.exits.channels)))
    flux = setting.flux
    channel = setting.exits.channels[index]
    share = float(flux.returning[flux.channels == channel][0])
    states = _leaving_states(setting, setting.exits.paths[index], random)
    number = sum(_come_back(setting, states, flux.followed_time))
    least = binom.sf(number - 1, _ORBITS, min(share + _ERROR, 1.0))
    most = binom.cdf(number, _ORBITS, max(share - _ERROR, 0.0))
    known = {"channel": channel, "share": share, "own": [number, _ORBITS]} | setting.reproduction
    report.judge(CHECK, "another share comes back", min(least, most) > _LEAST_PROBABILITY, **known)


def _leaving_states(setting: Setting, path: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Return states that leave through an exit with the density of its flux, of shape (n, 4)."""
    squares = np.maximum(2.0 * (setting.energy - setting.system.value(*path.T)), 0.0)[1:-1]
    # The points of the path have equal distances in time, in which p·dq is p² dt.
    chosen = 1 + random.choice(squares.size, _ORBITS, p=squares / squares.sum())
    along = path[chosen + 1] - path[chosen - 1]
    along /= np.hypot(*along.T)[:, None]
    normal, angle = np.column_stack([along[:, 1], -along[:, 0]]), np.arcsin(random.uniform(-1.0, 1.0, _ORBITS))
    length = float(np.hypot(*np.diff(path, axis=0).T).sum())
    outward = 1.0 if _is_outside(setting, path[len(path) // 2], _normal_at(path), 1e-3 * length) else -1.0
    momentum = np.sqrt(squares[chosen - 1])[:, None]
    directions = outward * np.cos(angle)[:, None] * normal + np.sin(angle)[:, None] * along
    return np.column_stack([path[chosen] + outward * _BEYOND * length * normal, momentum * directions])


def _normal_at(path: np.ndarray) -> np.ndarray:
    """Return the unit vector normal to the middle of a path, on the right of its direction."""
    middle = len(path) // 2
    along = path[middle + 1] - path[middle - 1]
    return np.array([along[1], -along[0]]) / np.hypot(*along)


def _is_outside(setting: Setting, place: np.ndarray, normal: np.ndarray, distance: float) -> bool:
    """Return whether the engine calls the side of an exit toward the normal outside."""
    sides = np.array([place + distance * normal, place - distance * normal])
    kinetic = np.maximum(setting.energy - setting.system.value(*sides.T), 0.0)
    states = np.column_stack([sides, np.sqrt(2.0 * kinetic), np.zeros(2)])
    right, left = classify_orbits(setting.potential, setting.energy, states, t_max=1e-9 * setting.time_unit).fate
    if (right == Fate.OUTSIDE) == (left == Fate.OUTSIDE):
        raise UndecidedError("the sides of an exit are not known")
    return bool(right == Fate.OUTSIDE)


def _come_back(setting: Setting, states: np.ndarray, t_max: float) -> Iterator[bool]:
    """Yield whether each orbit passes an exit again within t_max; UndecidedError for an orbit that is not followed as long."""
    is_closed = _is_closed_far_out(setting)
    for state in states:
        try:
            left, channel = _follow(setting, state, t_max, is_closed)
        except EnergyError:
            raise
        except UndecidedError:
            # The orbit runs to infinity in a finite time.
            left, channel = 0.0, 0
        if left > 0.0 and not channel:
            raise UndecidedError("an orbit is far away, but does not leave")
        yield channel > 0


def _is_closed_far_out(setting: Setting) -> bool:
    """Return whether V is above the energy all around the origin at some large distance, up to narrow channels."""
    angle = np.linspace(0.0, 2.0 * np.pi, _ANGLES, endpoint=False)
    x, y = setting.orbits.farthest * np.array([np.cos(angle), np.sin(angle)])[..., None] * _FAR
    return bool((setting.system.value(x, y) > setting.energy).all(axis=0).any())


def _follow(setting: Setting, state: np.ndarray, t_max: float, is_closed: bool) -> tuple[float, int]:
    """Return the time left, 0 for an orbit that leaves for ever, and the exit that an orbit passes, 0 without one."""
    orbits, exits = setting.orbits, setting.exits
    end = orbits.end_of(state, exits, t_max)
    left = t_max - end.time
    if end.channel or not left:
        return left, end.channel
    if not is_closed and orbits.leaves(end.state):
        return 0.0, 0
    end = orbits.end_of(end.state, exits, left, farther=FARTHER)
    return left - end.time, end.channel
