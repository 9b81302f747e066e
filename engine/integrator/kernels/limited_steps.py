"""Many orbits without exits, each with its own steps: weighted Birkhoff averages, section points and SALI.

These kernels are compiled once for all potentials, like `engine.integrator.kernels.propagate`. No step of an orbit
passes a given time, such as that of its next sample. An orbit fails if a coordinate is no longer finite, or if its steps become
too short or too many, as on the way to infinity. The results of an orbit do not depend on the other lanes.
"""

from __future__ import annotations

import math

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_limited_step, call_tangent
from engine.integrator.kernels.events import append_crossings
from engine.integrator.kernels.lanes import fill_lanes, fill_vectors, move_lane
from engine.integrator.kernels.sections import UPWARD
from engine.integrator.source.recurrence import LANES, SIZE_ROW, TIME_ROW
from engine.integrator.source.series import ORDER


@kernel
def birkhoff_averages(limited_step, coefficients, tolerance, interval, budget, weights, state, averages):
    """Compute weighted averages of x² and y² over two consecutive windows, and over a third window that overlaps half of each.

    weights (m,): weights of the samples of a window, at times `interval` apart; budget: largest number of steps; state (4,
    lanes): changed to the state at the end of the second window; averages (3, 2, lanes): zeros, set; NaN for orbits that fail.
    """
    active = state.shape[1]
    m = weights.shape[0]
    now, new, lane_orbit = fill_lanes(state)
    until = _fill_limits(active, interval)
    samples = np.zeros(LANES, np.int64)
    for i in range(active):
        _add_sample(now, i, weights, 0, averages, i)
    taken = 0
    while active > 0:
        call_limited_step(limited_step, coefficients, fill_vectors(active), tolerance, until, now, new)
        taken += 1
        for i in range(active - 1, -1, -1):
            orbit = lane_orbit[i]
            fails = taken > budget or _has_failed(now, new, i)
            if fails:
                for window in range(3):
                    for c in range(2):
                        averages[window, c, orbit] = np.nan
            elif new[TIME_ROW, i] < interval:
                continue
            # The time is counted from the last sample, so that its rounding errors do not grow.
            new[TIME_ROW, i] = 0.0
            samples[i] += 1
            if not fails and samples[i] < 2 * m:
                _add_sample(new, i, weights, samples[i], averages, orbit)
                continue
            active -= 1
            samples[i] = samples[active]
            _end_lane(new, i, active, lane_orbit, state)
        now, new = new, now


@subroutine
def _fill_limits(count, limit):
    """Return the times that lanes must not pass: `limit` for the first `count` lanes."""
    until = np.zeros(LANES)
    for i in range(count):
        until[i] = limit
    return until


@subroutine
def _has_failed(now, new, i):
    """Return whether the step of lane i has not led to a finite state at a later time."""
    # The sum is infinite or NaN if a coordinate is. One comparison takes less time than four.
    size = abs(new[0, i]) + abs(new[1, i]) + abs(new[2, i]) + abs(new[3, i])
    return not (size < np.inf and new[TIME_ROW, i] > now[TIME_ROW, i])


@subroutine
def _end_lane(lanes, i, last, lane_orbit, state):
    """Store the state of the orbit of lane i in `state` (4, orbits), and move the lane `last` there."""
    for c in range(4):
        state[c, lane_orbit[i]] = lanes[c, i]
    move_lane(lanes, last, i, lane_orbit)


@subroutine
def _add_sample(lanes, i, weights, sample, averages, orbit):
    """Add x² and y² of lane i with their weights to the averages of its orbit over those windows that contain the sample."""
    m = weights.shape[0]
    window = 0 if sample < m else 1
    weight = weights[sample - window * m]
    x_square, y_square = lanes[0, i] * lanes[0, i], lanes[1, i] * lanes[1, i]
    averages[window, 0, orbit] += weight * x_square
    averages[window, 1, orbit] += weight * y_square
    if m // 2 <= sample < m // 2 + m:
        weight = weights[sample - m // 2]
        averages[2, 0, orbit] += weight * x_square
        averages[2, 1, orbit] += weight * y_square


@kernel
def find_section_points(limited_step, jets, coefficients, tolerance, duration, budget, state, points, found):
    """Find the next points (x, px) at which orbits cross y = 0 upward, until each orbit has m points or `duration` has passed.

    budget: largest number of steps; state (4, lanes): changed in place; points (lanes, m, 3): x, px and the time since the start
    of the step are appended; found (lanes,): number of points of each orbit, increased in place.
    """
    lanes = state.shape[1]
    active = lanes
    now, new, lane_orbit = fill_lanes(state)
    until = _fill_limits(lanes, duration)
    # Steps with a crossing are collected, so that their series are computed together.
    start, size, step_orbit = np.zeros((4, LANES)), np.zeros(LANES), np.zeros(LANES, np.int64)
    buffered = 0
    taken = 0
    while active > 0:
        call_limited_step(limited_step, coefficients, fill_vectors(active), tolerance, until, now, new)
        taken += 1
        for i in range(active - 1, -1, -1):
            fails = taken > budget or _has_failed(now, new, i)
            if not fails and _may_cross_upward(now, new, i):
                for c in range(4):
                    start[c, buffered] = now[c, i]
                size[buffered] = new[SIZE_ROW, i]
                step_orbit[buffered] = lane_orbit[i]
                buffered += 1
                if buffered == lanes:
                    _locate_crossings(jets, coefficients, buffered, start, size, step_orbit, points, found)
                    buffered = 0
            if fails or new[TIME_ROW, i] >= duration or found[lane_orbit[i]] == points.shape[1]:
                active -= 1
                _end_lane(new, i, active, lane_orbit, state)
        now, new = new, now
    if buffered > 0:
        _locate_crossings(jets, coefficients, buffered, start, size, step_orbit, points, found)


@subroutine
def _may_cross_upward(now, new, i):
    """Return whether lane i crosses y = 0 upward in its step, or may cross it twice because it approaches and then recedes."""
    y_low, y_high = now[1, i], new[1, i]
    crosses = y_low < 0.0 and y_high >= 0.0
    return crosses or (y_low * y_high > 0.0 and y_low * now[3, i] < 0.0 and y_high * new[3, i] > 0.0)


@subroutine
def _locate_crossings(jets, coefficients, n, start, size, step_orbit, points, found):
    """Append the upward crossings in each of the first `n` buffered steps to the points of the orbit of the step."""
    x_jet = np.empty((ORDER + 1, LANES))
    y_jet = np.empty((ORDER + 1, LANES))
    call_jets(jets, coefficients, LANES, start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        append_crossings(x_jet, y_jet, i, 0.0, size[i], UPWARD, y_jet, points, found, step_orbit[i])


@kernel
def follow_deviations(tangent, limited_step, coefficients, tolerance, interval, samples, least_sali, budget, orbits):
    """Integrate orbits with two deviation vectors over `samples` intervals, or until their SALI is at most `least_sali`.

    SALI is min(‖w1 − w2‖, ‖w1 + w2‖) of two unit vectors, eq. 9 of Zotos (2014). It is found after every interval, not after
    every step, because steps are short where forces are strong and SALI is small for a short time.

    budget: largest number of steps; orbits (13, lanes): state, two vectors and the smallest SALI so far, changed in place. The
    SALI of orbits that fail becomes NaN.
    """
    active = orbits.shape[1]
    now, new, lane_orbit = fill_lanes(orbits[:4])
    until = _fill_limits(active, interval)
    vectors = np.zeros((8, LANES))
    for i in range(active):
        for c in range(8):
            vectors[c, i] = orbits[4 + c, i]
    passed = np.zeros(LANES, np.int64)
    taken = 0
    while active > 0:
        width = fill_vectors(active)
        call_limited_step(limited_step, coefficients, width, tolerance, until, now, new)
        for w in (vectors[:4], vectors[4:]):
            call_tangent(tangent, coefficients, width, new[SIZE_ROW], now[0], now[1], now[2], now[3], w[0], w[1], w[2], w[3])
        taken += 1
        for i in range(active - 1, -1, -1):
            orbit = lane_orbit[i]
            fails = taken > budget or _has_failed(now, new, i)
            if new[TIME_ROW, i] < interval and not fails:
                continue
            # The time is counted from the last sample, so that its rounding errors do not grow.
            new[TIME_ROW, i] = 0.0
            passed[i] += 1
            sali = np.nan if fails else _normalise(vectors, i)
            # `not … >=` keeps NaN.
            if not sali >= orbits[12, orbit]:
                orbits[12, orbit] = sali
            if passed[i] == samples or not sali > least_sali:
                active -= 1
                _end_lane(new, i, active, lane_orbit, orbits)
                passed[i] = passed[active]
                for c in range(8):
                    orbits[4 + c, orbit] = vectors[c, i]
                    vectors[c, i] = vectors[c, active]
        now, new = new, now


@subroutine
def _normalise(vectors, i):
    """Normalise the two deviation vectors of lane i in `vectors` (8, lanes), and return their SALI."""
    for first in (0, 4):
        square = 0.0
        for c in range(first, first + 4):
            square += vectors[c, i] ** 2
        norm = math.sqrt(square)
        for c in range(first, first + 4):
            vectors[c, i] /= norm
    difference = 0.0
    total = 0.0
    for c in range(4):
        difference += (vectors[c, i] - vectors[4 + c, i]) ** 2
        total += (vectors[c, i] + vectors[4 + c, i]) ** 2
    return math.sqrt(min(difference, total))
