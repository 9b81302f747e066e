"""The loop over steps of orbits in double-double arithmetic, until they escape or reach t_max.

Steps, and so fates, are computed with pairs of doubles. Events within a step are located with the high parts of its series:
escape times and crossings are as accurate as in double precision. An orbit that stays close to a Lyapunov orbit for long can be
nearer to its path than the exit curve is, a fit in doubles. So an orbit has escaped when it is `MARGIN` beyond the curve, where
only orbits are that do not return; its escape time is that of its last passage of the curve.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.taylor.jit.decorator import kernel, subroutine
from engine.taylor.jit.double_double import VECTOR
from engine.taylor.jit.function_pointers import call_deep_step
from engine.taylor.kernels.events import (
    BOUNDED,
    CLOSED,
    FAILED,
    SHAPE,
    count_upward_crossings,
    crossed_exit,
    exit_distance,
    find_exit_time,
)
from engine.taylor.source.deep_step import DEEP_ORDER, DEEP_TOLERANCE
from engine.taylor.source.recurrence import LANES

MARGIN = 1e-6
"""Distance beyond an exit, in units of the well, from which an orbit has escaped: far above the error of the exit's curve."""

# Rows of the high parts of the numbers of a step, see `generate_deep_step`; h stands where the tolerance does.
_X, _Y, _H, _SERIES_X, _SERIES_Y = 0, 4, 8, 10, 12 + 2 * DEEP_ORDER
_STATE, _INPUTS, _RESULTS = 8, 10, 14 + 4 * DEEP_ORDER


class DeepOrbits(NamedTuple):
    """Arrays of n orbits, changed in place.

    Attributes
    ----------
    state
        (n, 8) x, px, y, py at time `t`, each as a high and a low part.
    t
        (n,) time reached.
    crossings
        (n,) upward crossings of y = 0 until `t`, at most until t_max.
    channel
        (n,) the exit whose curve has been passed, without return so far; 0 for none.
    exit_time, exit_crossings
        (n,) time and crossings at this passage.
    fate
        (n,) int8: channel, BOUNDED or FAILED of orbits that have ended.
    """

    state: np.ndarray
    t: np.ndarray
    crossings: np.ndarray
    channel: np.ndarray
    exit_time: np.ndarray
    exit_crossings: np.ndarray
    fate: np.ndarray


@kernel
def propagate_deeply(deep_step, coefficients, hides, todo, t_max, budget, curves, gates, orbits):
    """Propagate the orbits numbered `todo` until they end, or `budget` steps of lanes are taken.

    hides: whether crossings can hide within a step; curves (channels, columns), gates (channels, 3): exits; orbits: `DeepOrbits`.
    """
    now = np.zeros((_INPUTS, LANES))
    new = np.zeros((_RESULTS, LANES))
    now[_H] = DEEP_TOLERANCE
    lane_orbit = np.zeros(LANES, np.int64)
    active = min(LANES, todo.shape[0])
    next_orbit = active
    for i in range(active):
        _load(orbits, todo[i], new, i, lane_orbit)
    while active > 0 and budget > 0:
        for c in range(_STATE):
            for i in range(active):
                now[c, i] = new[c, i]
        width = (active + VECTOR - 1) // VECTOR * VECTOR
        call_deep_step(deep_step, coefficients, width, now, new)
        budget -= width
        # Downward, since the last active lane replaces one whose orbit has ended.
        for i in range(active - 1, -1, -1):
            j = lane_orbit[i]
            if not _finish_step(now, new, i, j, hides, t_max, curves, gates, orbits):
                continue
            _store(new, i, orbits, j)
            if next_orbit < todo.shape[0]:
                _load(orbits, todo[next_orbit], new, i, lane_orbit)
                next_orbit += 1
                continue
            active -= 1
            for c in range(_STATE):
                new[c, i] = new[c, active]
            lane_orbit[i] = lane_orbit[active]
    for i in range(active):
        _store(new, i, orbits, lane_orbit[i])


@subroutine
def _finish_step(now, new, i, j, hides, t_max, curves, gates, orbits):
    """Count crossings and follow the exit of the orbit j of lane i; whether it ends with this step."""
    h = new[_H, i]
    x, y = new[_X, i], new[_Y, i]
    if not (np.isfinite(x) and np.isfinite(y) and h > 0.0):
        orbits.fate[j] = FAILED
        return True
    x_jet, y_jet = new[_SERIES_X:_SERIES_Y:2], new[_SERIES_Y::2]
    begin = orbits.t[j]
    orbits.t[j] = begin + h
    if orbits.channel[j] == 0:
        channel = crossed_exit(now[_X, i], now[_Y, i], x, y, curves, gates)
        if channel > 0 and curves[channel - 1, SHAPE] != CLOSED:
            tau = find_exit_time(x_jet, y_jet, i, h, curves[channel - 1])
            orbits.channel[j] = channel
            orbits.exit_time[j] = begin + tau
            orbits.exit_crossings[j] = orbits.crossings[j] + count_upward_crossings(y_jet, i, tau)
    if begin + h > t_max and begin < t_max:
        orbits.crossings[j] += count_upward_crossings(y_jet, i, t_max - begin)
    elif begin < t_max and hides:
        orbits.crossings[j] += count_upward_crossings(y_jet, i, h)
    elif begin < t_max and now[_Y, i] < 0.0 and y >= 0.0:
        orbits.crossings[j] += 1
    if orbits.channel[j] > 0:
        distance = exit_distance(x, y, curves[orbits.channel[j] - 1])
        if distance > MARGIN and orbits.exit_time[j] <= t_max:
            orbits.fate[j] = orbits.channel[j]
            return True
        if distance > MARGIN or distance <= 0.0:
            orbits.channel[j] = 0
    if orbits.channel[j] == 0 and orbits.t[j] >= t_max:
        orbits.fate[j] = BOUNDED
        return True
    return False


@subroutine
def _load(orbits, j, lanes, i, lane_orbit):
    for c in range(_STATE):
        lanes[c, i] = orbits.state[j, c]
    lane_orbit[i] = j


@subroutine
def _store(lanes, i, orbits, j):
    for c in range(_STATE):
        orbits.state[j, c] = lanes[c, i]
