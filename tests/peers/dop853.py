"""Escapes by SciPy's DOP853 with dense sampling; from the engine only the terms of the potential and the exits are used.

All orbits are integrated as one large system for short intervals; escaped orbits are removed after each interval.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from engine import Potential
from tests.peers.exit_lines import ExitLine

INTERVAL = 0.5
_SAMPLES = 65
_BISECTIONS = 45


@dataclass(frozen=True)
class PeerOutcomes:
    """Channel (0 if bounded), escape time (NaN if bounded) and number of upward crossings of y = 0 of n orbits."""

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray


def force(potential: Potential, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    fx = sum(-c * i * x ** (i - 1) * y**j for i, j, c in potential.terms if i)
    fy = sum(-c * j * x**i * y ** (j - 1) for i, j, c in potential.terms if j)
    return fx, fy


def equations(potential: Potential):
    def derivative(_t: float, flat: np.ndarray) -> np.ndarray:
        x, y, px, py = flat.reshape(4, -1)
        return np.concatenate([px, py, *force(potential, x, y)])

    return derivative


def variational_equations(potential: Potential):
    """Equations of an orbit and two deviation vectors: (12,) x, y, px, py and twice δx, δy, δpx, δpy."""

    def derivative(_t: float, flat: np.ndarray) -> np.ndarray:
        x, y, px, py = flat[:4]
        out = [px, py, *force(potential, x, y)]
        vxx, vxy, vyy = potential.hessian(x, y)
        for dx, dy, dpx, dpy in flat[4:].reshape(2, 4):
            out += [dpx, dpy, -vxx * dx - vxy * dy, -vxy * dx - vyy * dy]
        return np.array(out)

    return derivative


def classify(potential: Potential, lines: list[ExitLine], states: np.ndarray, t_max: float, rtol: float = 1e-13) -> PeerOutcomes:
    n = len(states)
    outcomes = PeerOutcomes(np.zeros(n, int), np.full(n, np.nan), np.zeros(n, int))
    inside, current = np.arange(n), states.T.copy()
    for begin in np.arange(0.0, t_max, INTERVAL):
        if not inside.size:
            break
        end = min(begin + INTERVAL, t_max)
        solution = solve_ivp(
            equations(potential), (begin, end), current.ravel(), method="DOP853", dense_output=True, rtol=rtol, atol=rtol
        )
        times = np.linspace(begin, end, _SAMPLES)
        x, y = solution.sol(times).reshape(4, -1, _SAMPLES)[:2]
        escaped = _first_crossings(lines, solution.sol, times, x, y)
        for k, orbit in enumerate(inside):
            until = escaped[k][1] if k in escaped else np.inf
            upward = np.flatnonzero((y[k, :-1] < 0) & (y[k, 1:] >= 0) & (times[1:] <= until))
            outcomes.crossings[orbit] += upward.size
            if k in escaped:
                outcomes.fate[orbit], outcomes.escape_time[orbit] = escaped[k]
        stay = np.setdiff1d(np.arange(inside.size), list(escaped))
        inside, current = inside[stay], solution.y[:, -1].reshape(4, -1)[:, stay]
    return outcomes


def _first_crossings(lines: list[ExitLine], sol, times: np.ndarray, x: np.ndarray, y: np.ndarray) -> dict[int, tuple[int, float]]:
    """{orbit: (channel, time)} of the first outward crossing within an interval."""
    crossings: dict[int, tuple[int, float]] = {}
    for line in lines:
        past = line.past(x, y)
        for k in np.flatnonzero((past > 0).any(axis=1)):
            after = int(np.argmax(past[k] > 0))
            low, high = times[max(after - 1, 0)], times[after]
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                x_middle, y_middle = sol(middle).reshape(4, -1)[:2, k]
                low, high = (low, middle) if line.past(x_middle, y_middle) > 0 else (middle, high)
            if k not in crossings or high < crossings[k][1]:
                crossings[k] = (line.channel, high)
    return crossings
