"""Orbits side by side at one fixed step, exits unseen: their weighted averages, and where they pierce the section y = 0.

Like `loop`, compiled once for all potentials. All lanes keep the same time, so nothing is refilled; an
orbit that leaves runs off to infinity, and its numbers with it.
"""

from __future__ import annotations

import math

import numpy as np

from engine.taylor.jit.decorator import kernel
from engine.taylor.jit.function_pointers import call_glide, call_jets, call_tangent
from engine.taylor.kernels.events import series_slope, series_value
from engine.taylor.source.recurrence import ORDER

_RENORMALISED_AFTER = 8
_NEWTON_STEPS = 12
_ROOT_ACCURACY = 1e-14


@kernel
def average(glide, coefficients, h, weights, state, averages):
    """Weighted averages of x² and y² over consecutive windows.

    weights (m,): of the samples of a window, h apart; state (4, lanes), changed in place; averages (windows, 2, lanes), zeros.
    """
    for window in range(averages.shape[0]):
        for weight in weights:
            call_glide(
                glide, coefficients, state.shape[1], h, weight, state[0], state[1], state[2], state[3],
                averages[window, 0], averages[window, 1],
            )  # fmt: skip


@kernel
def pierce(glide, jets, coefficients, h, steps, state, points, found):
    """The next points (x, px) in which orbits cross y = 0 upward, until all have found enough or `steps` are over.

    state (4, lanes), changed in place; points (lanes, m, 2), found (lanes,): filled from where `found` says.
    """
    lanes = state.shape[1]
    before = np.empty((4, lanes))
    aside = np.zeros((4, lanes))
    rider = np.empty(lanes, np.int64)
    nothing = np.zeros((2, lanes))
    waiting = 0
    for taken in range(steps):
        before[:] = state
        call_glide(glide, coefficients, lanes, h, 0.0, state[0], state[1], state[2], state[3], nothing[0], nothing[1])
        for i in range(lanes):
            if not (before[1, i] < 0.0 and state[1, i] >= 0.0 and found[i] < points.shape[1]):
                continue
            for c in range(4):
                aside[c, waiting] = before[c, i]
            rider[waiting] = i
            waiting += 1
            if waiting == lanes:
                _find_points(jets, coefficients, h, waiting, aside, rider, points, found)
                waiting = 0
        if taken % 16 == 0 and found.min() == points.shape[1]:
            break
    if waiting > 0:
        _find_points(jets, coefficients, h, waiting, aside, rider, points, found)


@kernel
def _find_points(jets, coefficients, h, n, start, rider, points, found):
    """Locate the upward crossing within each of `n` steps set aside, in the order in which they were."""
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        lane = rider[i]
        if found[lane] == points.shape[1]:
            continue
        low, high = 0.0, h
        tau = 0.5 * h
        for _ in range(_NEWTON_STEPS):
            value = series_value(y_jet, i, tau)
            if value < 0.0:
                low = tau
            else:
                high = tau
            if abs(value) < _ROOT_ACCURACY:
                break
            slope = series_slope(y_jet, i, tau)
            tau = tau - value / slope if slope != 0.0 else 0.5 * (low + high)
            if not low < tau < high:
                tau = 0.5 * (low + high)
        points[lane, found[lane], 0] = series_value(x_jet, i, tau)
        points[lane, found[lane], 1] = series_slope(x_jet, i, tau)
        found[lane] += 1


@kernel
def align(tangent, glide, coefficients, h, steps, state, first, second, sali):
    """The smallest SALI of orbits over `steps`: min(‖w1 − w2‖, ‖w1 + w2‖) of two unit deviation vectors, eq. 9 of Zotos (2014).

    state, first, second (4, lanes), of orbits and deviations, are changed in place; sali (lanes,) is lowered, and is NaN from
    where an orbit has run off.
    """
    lanes = state.shape[1]
    duration = np.full(lanes, h)
    nothing = np.zeros((2, lanes))
    for taken in range(1, steps + 1):
        for w in (first, second):
            call_tangent(tangent, coefficients, lanes, duration, state[0], state[1], state[2], state[3], w[0], w[1], w[2], w[3])
        call_glide(glide, coefficients, lanes, h, 0.0, state[0], state[1], state[2], state[3], nothing[0], nothing[1])
        if taken % _RENORMALISED_AFTER == 0 or taken == steps:
            _renormalise(first)
            _renormalise(second)
            for i in range(lanes):
                apart = 0.0
                along = 0.0
                for c in range(4):
                    apart += (first[c, i] - second[c, i]) ** 2
                    along += (first[c, i] + second[c, i]) ** 2
                sali[i] = min(sali[i], math.sqrt(min(apart, along)))


@kernel
def _renormalise(w):
    for i in range(w.shape[1]):
        norm = math.sqrt(w[0, i] ** 2 + w[1, i] ** 2 + w[2, i] ** 2 + w[3, i] ** 2)
        for c in range(4):
            w[c, i] /= norm
