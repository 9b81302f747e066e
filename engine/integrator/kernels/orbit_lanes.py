"""Adaptive steps of one orbit per lane until the orbit escapes, for passages through a section and integrals of the speed.

These kernels are compiled once for all potentials, like `engine.integrator.kernels.propagate`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_step
from engine.integrator.kernels.events import (
    BOUNDED,
    FAILED,
    append_crossings,
    crossed_exit,
    find_exit_time,
    passed_exit,
    series_slope,
    series_value,
)
from engine.integrator.kernels.exit_geometry import reached_exit
from engine.integrator.kernels.lanes import fill_lanes, fill_vectors, has_failed, move_lane
from engine.integrator.kernels.propagate import make_buffer, passes_exit
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW, TIME_ROW
from engine.integrator.source.series import ORDER
from engine.integrator.source.step_flags import CROSSES, GATE, HIDDEN, NEAR, OVERSHOOT

# Nodes and weights of Gauss's rule with 8 points on [−1, 1].
_NODES = (
    -0.96028985649753623168, -0.79666647741362673959, -0.52553240991632898582, -0.18343464249564980494,
    0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959, 0.96028985649753623168,
)  # fmt: skip
_WEIGHTS = (
    0.10122853629037625915, 0.22238103445337447054, 0.31370664587788728734, 0.36268378337836198297,
    0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054, 0.10122853629037625915,
)  # fmt: skip
# Largest difference between the results of the rule on a part of a step and on both halves of the part, relative to the integral
# over the step. Beyond this difference, the part is halved.
_ACCURACY = 1e-13
# Largest number of halvings. Near a point of rest, |v|^power with a power below 1 is almost singular.
_MOST_HALVINGS = 40


class _PassageBuffer(NamedTuple):
    """Steps whose passages have not been located yet.

    start (6, lanes): x, y, px, py, t and step size; orbit (lanes,): the orbit of the step; channel (lanes,): the exit through
    which the orbit escapes in the step, or 0.
    """

    start: np.ndarray
    orbit: np.ndarray
    channel: np.ndarray


@kernel
def find_section_passages(step, jets, coefficients, tolerance, horizon, exits, state, passages, found, fate):
    """Find the first m crossings of the section by each orbit before it escapes through an exit or passes `horizon`.

    exits: `propagate.Exits`; state (4, lanes), lanes a multiple of `VECTOR` up to `LANES`; passages (lanes, m, 3 to 5):
    set to x, px, time, py and y; found (lanes,): zeros, set to the numbers of crossings; fate (lanes,): set where an orbit has
    ended, which says nothing about an orbit with m crossings: the number of the exit, or BOUNDED or FAILED.
    """
    lanes = state.shape[1]
    most_passages = passages.shape[1]
    now, new, lane_orbit = fill_lanes(state)
    flag, crossed = np.zeros(LANES, np.int64), np.zeros(LANES, np.int64)
    buffer = _PassageBuffer(np.zeros((6, lanes)), np.zeros(lanes, np.int64), np.zeros(lanes, np.int64))
    single = make_buffer(2)
    buffered = 0
    active = lanes
    while active > 0:
        width = fill_vectors(active)
        call_step(step, coefficients, width, tolerance, horizon, exits.gates, now, new, flag, crossed)
        for i in range(active - 1, -1, -1):
            orbit = lane_orbit[i]
            curves = exits.curves[exits.curve_row[orbit]]
            is_full = found[orbit] == most_passages
            passes = crossed[i] > 0 or flag[i] & CROSSES != 0
            crossed[i] = 0
            if flag[i] == 0 and not passes and not is_full:
                continue
            fails = has_failed(new, i)
            channel = 0
            if not fails and flag[i] & (GATE | NEAR) != 0:
                channel = crossed_exit(now[0, i], now[1, i], new[0, i], new[1, i], curves, exits.gates)
            if not fails and channel == 0 and flag[i] & NEAR != 0:
                channel = passes_exit(jets, coefficients, now, i, new[SIZE_ROW, i], curves, single)
            if not fails and not is_full and (passes or channel > 0 or flag[i] & HIDDEN != 0):
                for c in range(5):
                    buffer.start[c, buffered] = now[c, i]
                buffer.start[SIZE_ROW, buffered] = new[SIZE_ROW, i]
                buffer.orbit[buffered] = orbit
                buffer.channel[buffered] = channel
                buffered += 1
                if buffered == lanes:
                    _locate_passages(jets, coefficients, horizon, buffer, buffered, exits, passages, found, fate)
                    buffered = 0
            if fails or is_full or channel > 0 or flag[i] & OVERSHOOT != 0:
                if channel == 0:
                    fate[orbit] = FAILED if fails else BOUNDED
                active -= 1
                move_lane(new, active, i, lane_orbit)
        now, new = new, now
    _locate_passages(jets, coefficients, horizon, buffer, buffered, exits, passages, found, fate)


@subroutine
def _locate_passages(jets, coefficients, horizon, buffer, n, exits, passages, found, fate):
    """Append the crossings in each of the first `n` buffered steps to the passages of the orbit of the step, and set its fate."""
    start, section = buffer.start, exits.gates[exits.curves.shape[1] :]
    work = np.empty((ORDER + 1, start.shape[1]))
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        duration = start[SIZE_ROW, i]
        if buffer.channel[i] > 0:
            channel, curves = buffer.channel[i], exits.curves[exits.curve_row[buffer.orbit[i]]]
            duration = find_exit_time(x_jet, y_jet, i, duration, curves[channel - 1])
            channel = reached_exit(series_value(x_jet, i, duration), series_value(y_jet, i, duration), channel, curves)
            fate[buffer.orbit[i]] = BOUNDED if start[TIME_ROW, i] + duration > horizon else channel
        duration = min(duration, horizon - start[TIME_ROW, i])
        append_crossings(x_jet, y_jet, i, start[TIME_ROW, i], duration, section, work, passages, found, buffer.orbit[i])


@kernel
def integrate_speed(step, jets, coefficients, tolerance, duration, power, budget, gates, curves, curve_row, orbits, integral):
    """Continue the integrals of |v|^power to `duration`, or until an orbit crosses an exit, by at most `budget` steps.

    gates (exits, 3); curves (energies, exits, columns); curve_row (lanes,): the row of `curves` of each orbit; orbits (ROWS,
    lanes), lanes a multiple of `VECTOR` up to `LANES`: see `ROWS`; integral (lanes,): the integrals so far. Orbits and
    integrals are changed in place. The time becomes infinite where an integral is complete, and the integral becomes NaN for an
    orbit whose steps become too short.
    """
    now, new, lane_orbit = fill_lanes(orbits)
    flag, crossed = np.zeros(LANES, np.int64), np.zeros(LANES, np.int64)
    active = orbits.shape[1]
    for i in range(active):
        orbits[TIME_ROW, i] = np.inf
    x_jet = np.zeros((ORDER + 1, LANES))
    y_jet = np.zeros((ORDER + 1, LANES))
    taken = 0
    while active > 0 and taken < budget:
        taken += 1
        width = fill_vectors(active)
        call_step(step, coefficients, width, tolerance, duration, gates, now, new, flag, crossed)
        call_jets(jets, coefficients, width, now[0], now[1], now[2], now[3], x_jet, y_jet)
        for i in range(active - 1, -1, -1):
            orbit = lane_orbit[i]
            fails = has_failed(new, i)
            time_inside, ends = _time_inside(now, new, i, flag[i], duration, x_jet, y_jet, curves[curve_row[orbit]], gates)
            if fails:
                integral[orbit] = np.nan
            else:
                integral[orbit] += _integrate_step(x_jet, y_jet, i, time_inside, power)
            if ends or fails:
                active -= 1
                move_lane(new, active, i, lane_orbit)
                for k in range(ORDER + 1):
                    x_jet[k, i] = x_jet[k, active]
                    y_jet[k, i] = y_jet[k, active]
        now, new = new, now
    for i in range(active):
        for c in range(ROWS):
            orbits[c, lane_orbit[i]] = now[c, i]


@subroutine
def _time_inside(now, new, i, flags, duration, x_jet, y_jet, curves, gates):
    """Return how long the orbit of lane i is inside, within its step and until the time `duration`, and whether it ends there."""
    is_late = flags & OVERSHOOT != 0
    time_inside = min(new[SIZE_ROW, i], duration - now[TIME_ROW, i])
    channel = 0
    if is_late or flags & (GATE | NEAR) != 0:
        channel = crossed_exit(now[0, i], now[1, i], new[0, i], new[1, i], curves, gates)
        if channel == 0:
            channel = passed_exit(x_jet, y_jet, i, new[SIZE_ROW, i], curves)
    if channel > 0:
        time_inside = min(time_inside, find_exit_time(x_jet, y_jet, i, new[SIZE_ROW, i], curves[channel - 1]))
    return time_inside, is_late or channel > 0


@subroutine
def _integrate_step(x_jet, y_jet, i, duration, power):
    """Return the integral of |v|^power over the first `duration` of a step, as the sum over successive parts."""
    total = 0.0
    low = 0.0
    width = duration
    largest_error = 0.0
    halvings = 0
    while low < duration:
        # Gauss's rule is applied to the part (0), to its first half (1) and to its second half (2).
        whole = 0.0
        halves = 0.0
        for interval in range(3):
            half_width = 0.5 * width if interval == 0 else 0.25 * width
            middle = low + (half_width if interval < 2 else 3.0 * half_width)
            result = _gauss(x_jet, y_jet, i, middle, half_width, power)
            if interval == 0:
                whole = result
            else:
                halves += result
        if halvings == 0 and low == 0.0:
            largest_error = _ACCURACY * whole
        if abs(halves - whole) > largest_error and halvings < _MOST_HALVINGS:
            width *= 0.5
            halvings += 1
            continue
        total += halves
        low += width
        # The next part may be longer again, but ends within the step.
        if halvings > 0:
            width *= 2.0
            halvings -= 1
        width = min(width, duration - low)
    return total


@subroutine
def _gauss(x_jet, y_jet, i, middle, half_width, power):
    """Return the integral of |v|^power over a part of a step by Gauss's rule."""
    total = 0.0
    for k in range(8):
        vx = series_slope(x_jet, i, middle + half_width * _NODES[k])
        vy = series_slope(y_jet, i, middle + half_width * _NODES[k])
        total += _WEIGHTS[k] * (vx * vx + vy * vy) ** (0.5 * power)
    return half_width * total
