"""Many orbits with one fixed step, without exits: weighted Birkhoff averages, section points and SALI.

These kernels are compiled once for all potentials, like `engine.integrator.kernels.propagate`. All lanes have the same time, so a
lane keeps its orbit. The coordinates of an orbit that escapes become infinite or NaN.
"""

from __future__ import annotations

import math

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_fixed_step, call_jets, call_tangent
from engine.integrator.kernels.events import append_crossings
from engine.integrator.source.recurrence import LANES
from engine.integrator.source.series import ORDER

# Number of steps after which deviation vectors are normalised.
_STEPS_TO_RENORMALISATION = 8
# Number of steps between checks whether all section points are found.
_STEPS_BETWEEN_CHECKS = 16


@kernel
def birkhoff_averages(fixed_step, coefficients, h, weights, state, averages):
    """Compute weighted averages of x² and y² over two consecutive windows, and over a third window that overlaps half of each.

    weights (m,): weights of the samples of a window, at intervals h; state (4, lanes): changed in place; averages (3, 2, lanes):
    set.
    """
    lanes = state.shape[1]
    current = _load_lanes(state)
    sums = np.zeros((3, 2, LANES))
    m = weights.shape[0]
    for sample in range(2 * m):
        call_fixed_step(fixed_step, coefficients, lanes, h, weights[sample % m], current, sums[sample // m])
        if m // 2 <= sample < m // 2 + m:
            weight = weights[sample - m // 2]
            for i in range(lanes):
                sums[2, 0, i] += weight * current[0, i] * current[0, i]
                sums[2, 1, i] += weight * current[1, i] * current[1, i]
    _store_lanes(current, state)
    for window in range(3):
        for c in range(2):
            for i in range(lanes):
                averages[window, c, i] = sums[window, c, i]


@subroutine
def _load_lanes(state):
    """Return a (4, LANES) array with the states (4, lanes) in its first columns."""
    current = np.zeros((4, LANES))
    for c in range(4):
        for i in range(state.shape[1]):
            current[c, i] = state[c, i]
    return current


@subroutine
def _store_lanes(current, state):
    """Copy the first columns of `current` (4, LANES) to `state` (4, lanes)."""
    for c in range(4):
        for i in range(state.shape[1]):
            state[c, i] = current[c, i]


@kernel
def find_section_points(fixed_step, jets, coefficients, h, steps, state, points, found):
    """Find the next points (x, px) at which orbits cross y = 0 upward, until each orbit has m points or `steps` are taken.

    state (4, lanes): changed in place; points (lanes, m, 3): x, px and the time since the start of the step are appended; found
    (lanes,): number of points of each orbit, increased in place.
    """
    lanes = state.shape[1]
    current = _load_lanes(state)
    previous = np.zeros((4, lanes))
    ignored_sums = np.zeros((2, LANES))
    # Steps with a crossing are collected, so that their series are computed together.
    start = np.zeros((4, lanes))
    step_lane = np.zeros(lanes, np.int64)
    buffered = 0
    for taken in range(steps):
        for c in range(4):
            for i in range(lanes):
                previous[c, i] = current[c, i]
        call_fixed_step(fixed_step, coefficients, lanes, h, 0.0, current, ignored_sums)
        for i in range(lanes):
            if not (previous[1, i] < 0.0 and current[1, i] >= 0.0 and found[i] < points.shape[1]):
                continue
            for c in range(4):
                start[c, buffered] = previous[c, i]
            step_lane[buffered] = i
            buffered += 1
            if buffered == lanes:
                _locate_crossings(jets, coefficients, h, buffered, start, step_lane, points, found)
                buffered = 0
        if taken % _STEPS_BETWEEN_CHECKS == 0 and _count_below(found, points.shape[1]) == 0:
            break
    if buffered > 0:
        _locate_crossings(jets, coefficients, h, buffered, start, step_lane, points, found)
    _store_lanes(current, state)


@subroutine
def _count_below(values, limit):
    """Return how many of the values (n,) are below a limit."""
    count = 0
    for value in values:
        if value < limit:
            count += 1
    return count


@subroutine
def _locate_crossings(jets, coefficients, h, n, start, step_lane, points, found):
    """Append the upward crossing in each of the first `n` buffered steps to the points of the lane of the step."""
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        append_crossings(x_jet, y_jet, i, 1.0, 0.0, h, points, found, step_lane[i])


@kernel
def fixed_step_sali(tangent, fixed_step, coefficients, h, steps, state, first, second, sali):
    """Take `steps` steps, and lower `sali` to the smallest SALI found after every 8th step and after the last step.

    SALI is min(‖w1 − w2‖, ‖w1 + w2‖) of two unit vectors, eq. 9 of Zotos (2014).

    state, first, second (4, lanes): orbits and their two deviation vectors, changed in place; sali (lanes,): changed in place.
    """
    lanes = state.shape[1]
    duration = np.zeros(lanes)
    for i in range(lanes):
        duration[i] = h
    current = _load_lanes(state)
    ignored_sums = np.zeros((2, LANES))
    for taken in range(1, steps + 1):
        for w in (first, second):
            call_tangent(
                tangent, coefficients, lanes, duration, current[0], current[1], current[2], current[3], w[0], w[1], w[2], w[3]
            )
        call_fixed_step(fixed_step, coefficients, lanes, h, 0.0, current, ignored_sums)
        if taken % _STEPS_TO_RENORMALISATION == 0 or taken == steps:
            _normalise(first)
            _normalise(second)
            _lower_sali(first, second, sali)
    _store_lanes(current, state)


@subroutine
def _normalise(w):
    """Normalise the vectors w (4, lanes) in place."""
    for i in range(w.shape[1]):
        norm = math.sqrt(w[0, i] ** 2 + w[1, i] ** 2 + w[2, i] ** 2 + w[3, i] ** 2)
        for c in range(4):
            w[c, i] /= norm


@subroutine
def _lower_sali(first, second, sali):
    """Lower `sali` (lanes,) to the SALI of unit vectors (4, lanes), where that is smaller."""
    for i in range(sali.shape[0]):
        difference = 0.0
        sum_ = 0.0
        for c in range(4):
            difference += (first[c, i] - second[c, i]) ** 2
            sum_ += (first[c, i] + second[c, i]) ** 2
        sali[i] = min(sali[i], math.sqrt(min(difference, sum_)))
