"""Where orbits pass y = 0 downward before they leave, at steps of free size: the cuts of a tube of orbits with the section.

Like `loop`, compiled once for all potentials.
"""

from __future__ import annotations

import numpy as np

from engine.taylor.jit.decorator import kernel
from engine.taylor.jit.function_pointers import call_jets, call_step
from engine.taylor.kernels.events import find_exit_time, find_extremum, outside_channel, series_slope, series_value
from engine.taylor.kernels.propagate import VECTOR
from engine.taylor.source.recurrence import GATE, HIDDEN, ORDER, OVERSHOOT

_CUT_PARTS = 8
_CUT_ITERATIONS = 60
_CUT_ACCURACY = 1e-15


@kernel
def cut(step, jets, coefficients, tolerance, horizon, gates, curves, state, cuts, found):
    """The first downward passages of y = 0 of each orbit, until it has found enough, leaves through an exit or passes `horizon`.

    curves (channels, columns); state (4, lanes), lanes a multiple of `VECTOR`; cuts (lanes, m, 3): x, px and time; found
    (lanes,), zeros. A passage is one from y > 0 to y ≤ 0; none is counted after the moment at which the orbit leaves.
    """
    lanes = state.shape[1]
    most = cuts.shape[1]
    now = np.zeros((5, lanes))
    now[:4] = state
    new = np.empty((5, lanes))
    h = np.empty(lanes)
    flag = np.zeros(lanes, np.int64)
    crossed = np.zeros(lanes, np.int64)
    rider = np.arange(lanes)
    aside = np.zeros((6, lanes))
    aside_rider = np.zeros(lanes, np.int64)
    aside_channel = np.zeros(lanes, np.int64)
    waiting = 0
    riding = lanes
    while riding > 0:
        width = (riding + VECTOR - 1) // VECTOR * VECTOR
        call_step(
            step, coefficients, width, tolerance, horizon, gates, now[0], now[1], now[2], now[3], now[4],
            new[0], new[1], new[2], new[3], new[4], h, flag, crossed,
        )  # fmt: skip
        i = riding
        while i > 0:
            i -= 1
            j = rider[i]
            full = found[j] == most
            down = now[1, i] > 0.0 and new[1, i] <= 0.0
            if flag[i] == 0 and not down and not full:
                continue
            late = flag[i] & OVERSHOOT != 0
            channel = 0
            if not late and flag[i] & GATE != 0:
                channel = outside_channel(new[0, i], new[1, i], curves)
            if not late and not full and (down or channel > 0 or flag[i] & HIDDEN != 0):
                for c in range(5):
                    aside[c, waiting] = now[c, i]
                aside[5, waiting] = h[i]
                aside_rider[waiting] = j
                aside_channel[waiting] = channel
                waiting += 1
                if waiting == lanes:
                    _find_cuts(jets, coefficients, waiting, aside, aside_rider, aside_channel, curves, cuts, found)
                    waiting = 0
            if late or full or channel > 0:
                riding -= 1
                for c in range(5):
                    new[c, i] = new[c, riding]
                rider[i] = rider[riding]
        now, new = new, now
    _find_cuts(jets, coefficients, waiting, aside, aside_rider, aside_channel, curves, cuts, found)


@kernel
def _find_cuts(jets, coefficients, n, start, rider, channel, curves, cuts, found):
    """Locate the downward passages within each of `n` steps set aside, x, y, px, py, t, h, in the order in which they were."""
    x_jet = np.empty((ORDER + 1, start.shape[1]))
    y_jet = np.empty((ORDER + 1, start.shape[1]))
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], x_jet, y_jet)
    for i in range(n):
        j = rider[i]
        duration = start[5, i]
        if channel[i] > 0:
            duration = find_exit_time(x_jet, y_jet, i, duration, curves[channel[i] - 1])
        high = 0.0
        y_high, slope_high = start[1, i], start[3, i]
        for part in range(1, _CUT_PARTS + 1):
            low, y_low, slope_low = high, y_high, slope_high
            high = duration * part / _CUT_PARTS
            y_high = series_value(y_jet, i, high)
            slope_high = series_slope(y_jet, i, high)
            above, below = low, high
            if y_low * y_high > 0.0 and y_low * slope_low < 0.0 and y_high * slope_high > 0.0:
                turning = find_extremum(y_jet, i, low, high)
                if y_low > 0.0:
                    below = turning
                else:
                    above = turning
            if found[j] == cuts.shape[1] or not (series_value(y_jet, i, above) > 0.0 and series_value(y_jet, i, below) <= 0.0):
                continue
            tau = _descent(y_jet, i, above, below)
            cuts[j, found[j], 0] = series_value(x_jet, i, tau)
            cuts[j, found[j], 1] = series_slope(x_jet, i, tau)
            cuts[j, found[j], 2] = start[4, i] + tau
            found[j] += 1


@kernel
def _descent(y_jet, i, above, below):
    """Where a series that is positive at `above` and not at `below` vanishes between them: Newton's method, kept in a bracket."""
    tau = 0.5 * (above + below)
    for _ in range(_CUT_ITERATIONS):
        value = series_value(y_jet, i, tau)
        if value > 0.0:
            above = tau
        else:
            below = tau
        slope = series_slope(y_jet, i, tau)
        newton = tau - value / slope if slope != 0.0 else above
        if abs(newton - tau) < _CUT_ACCURACY or below - above < _CUT_ACCURACY:
            break
        tau = newton if above < newton < below else 0.5 * (above + below)
    return tau
