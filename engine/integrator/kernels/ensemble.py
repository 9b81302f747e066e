"""Propagation of many orbits at the same time, for an animation.

For each orbit, the series of x and y in the current step are kept, which give the position at any time within the step. Steps are
computed for full vectors of lanes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_step
from engine.integrator.kernels.events import crossed_exit, find_exit_time, find_zero, passed_exit, series_slope, series_value
from engine.integrator.kernels.exit_geometry import ends_inside, reached_exit
from engine.integrator.kernels.lanes import fill_vectors
from engine.integrator.kernels.sections import section_series
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW, TIME_ROW
from engine.integrator.source.series import ORDER
from engine.integrator.source.step_flags import CROSSES, NEAR


class Ensemble(NamedTuple):
    """Arrays of n orbits, changed in place by `advance_ensemble`.

    Attributes
    ----------
    ends
        (ROWS, n) x, y, px, py, t, size and remainders at the end of the current step; before the first step, at the start.
    begin
        (n,) time at which the current step begins.
    series
        (2, ORDER + 1, n) coefficients of the series of x and y in the current step.
    leaving
        (n,) int8: number of the exit through which the current step, or an earlier step, leaves the interior; 0 for none.
    escape_time
        (n,) time of the escape, or infinite.
    last_time
        (n,) time until which the orbit is followed, or infinite.
    section
        (4, n) x, y, px, py at the last crossing of the section.
    """

    ends: np.ndarray
    begin: np.ndarray
    series: np.ndarray
    leaving: np.ndarray
    escape_time: np.ndarray
    last_time: np.ndarray
    section: np.ndarray


@kernel
def advance_ensemble(step, jets, coefficients, tolerance, time, beyond, gates, curves, ensemble):
    """Advance each orbit, in place, until its step contains `time`, or the last time at which the orbit is followed.

    beyond: time for which orbits are followed beyond an exit, except into a body; gates (exits + rows, 3) and curves (exits,
    columns): see `engine.integrator.kernels.propagate.Exits`.
    """
    count = ensemble.begin.shape[0]
    now = np.zeros((ROWS, LANES))
    new = np.zeros((ROWS, LANES))
    flag = np.zeros(LANES, np.int64)
    crossed = np.zeros(LANES, np.int64)
    x_jet = np.zeros((ORDER + 1, LANES))
    y_jet = np.zeros((ORDER + 1, LANES))
    work = np.zeros((ORDER + 1, LANES))
    lane_orbit = np.zeros(LANES, np.int64)
    next_orbit = 0
    while next_orbit < count:
        # Lanes without an orbit take harmless steps.
        for i in range(LANES):
            crossed[i] = 0
            for row in range(ROWS):
                now[row, i] = 0.01 if row == 0 else 0.0
        active = 0
        while next_orbit < count and active < LANES:
            if _is_late(ensemble, next_orbit, time):
                for row in range(ROWS):
                    now[row, active] = ensemble.ends[row, next_orbit]
                lane_orbit[active] = next_orbit
                active += 1
            next_orbit += 1
        if active == 0:
            break
        width = fill_vectors(active)
        call_step(step, coefficients, width, tolerance, time, gates, now, new, flag, crossed)
        call_jets(jets, coefficients, width, now[0], now[1], now[2], now[3], x_jet, y_jet)
        for i in range(active):
            crosses = crossed[i] > 0 or flag[i] & CROSSES != 0
            _keep_step(now, new, flag[i], crosses, x_jet, y_jet, work, i, beyond, gates, curves, ensemble, lane_orbit[i])
            # The next turn begins with the first orbit that needs another step.
            if _is_late(ensemble, lane_orbit[i], time):
                next_orbit = min(next_orbit, lane_orbit[i])


@kernel
def place_ensemble(time, ensemble, places, channels):
    """Set `places` (2, n) to x and y at a time, NaN for an orbit no longer followed, and `channels` (n,).

    The channel of an orbit is the exit through which it has left. That of an orbit still inside stays 0.
    """
    for orbit in range(ensemble.begin.shape[0]):
        if time >= ensemble.escape_time[orbit]:
            channels[orbit] = ensemble.leaving[orbit]
        tau = time - ensemble.begin[orbit]
        # After an orbit has failed, the size of its last step is NaN.
        is_far = time > ensemble.last_time[orbit] or not tau <= ensemble.ends[SIZE_ROW, orbit]
        for axis in range(2):
            places[axis, orbit] = np.nan if is_far else series_value(ensemble.series[axis], orbit, tau)


@kernel
def begin_ensemble(starts, ensemble, places, channels):
    """Set all orbits to their starts (n, 4), `places` (2, n) to the positions, and `channels` (n,) to 0."""
    # Loops over whole arrays would be as many copies of the code.
    for orbit in range(starts.shape[0]):
        for row in range(ROWS):
            ensemble.ends[row, orbit] = 0.0
        for row in range(4):
            ensemble.ends[row, orbit] = starts[orbit, row]
            ensemble.section[row, orbit] = np.nan
        ensemble.begin[orbit] = 0.0
        ensemble.leaving[orbit] = 0
        ensemble.escape_time[orbit] = np.inf
        ensemble.last_time[orbit] = np.inf
        channels[orbit] = 0
        for axis in range(2):
            places[axis, orbit] = starts[orbit, axis]


@kernel
def reverse_ensemble(time, ensemble, channels, states):
    """Set `states` (n, 4) to the states at a time of the orbits inside, with reversed momenta, and return their number."""
    count = 0
    for orbit in range(channels.shape[0]):
        if channels[orbit] != 0:
            continue
        tau = time - ensemble.begin[orbit]
        for axis in range(2):
            states[count, axis] = series_value(ensemble.series[axis], orbit, tau)
            states[count, axis + 2] = -series_slope(ensemble.series[axis], orbit, tau)
        count += 1
    return count


@kernel
def measure_spread(starts, places, channels):
    """Return the spread of the orbits inside, at places (2, n), divided by the spread of their starts (n, 4)."""
    start_variance = _variance(starts[:, 0], channels) + _variance(starts[:, 1], channels)
    variance = _variance(places[0], channels) + _variance(places[1], channels)
    return np.sqrt(variance / start_variance)


@subroutine
def _variance(values, channels):
    """Return the variance of the values (n,) of the orbits inside; NaN if there are none."""
    count, total, squares, origin = 0, 0.0, 0.0, 0.0
    for orbit in range(channels.shape[0]):
        if channels[orbit] != 0:
            continue
        # Values are taken relative to the first value, because the values of a small disc differ only in their last digits.
        if count == 0:
            origin = values[orbit]
        difference = values[orbit] - origin
        count += 1
        total += difference
        squares += difference * difference
    mean = total / count if count > 0 else np.nan
    return max(squares / count - mean * mean, 0.0) if count > 0 else np.nan


@subroutine
def _is_late(ensemble, orbit, time):
    """Return whether the step of a followed orbit ends before a time; False for a failed orbit, whose time is NaN."""
    end = ensemble.ends[TIME_ROW, orbit]
    return end < time and end < ensemble.last_time[orbit]


@subroutine
def _keep_step(now, new, flags, crosses, x_jet, y_jet, work, i, beyond, gates, curves, ensemble, orbit):
    """Make the step of lane i, with its events, the current step of its orbit in the ensemble; work: see `section_series`."""
    for k in range(ORDER + 1):
        ensemble.series[0, k, orbit] = x_jet[k, i]
        ensemble.series[1, k, orbit] = y_jet[k, i]
    for row in range(ROWS):
        ensemble.ends[row, orbit] = new[row, i]
    size = new[SIZE_ROW, i]
    ensemble.begin[orbit] = now[TIME_ROW, i]
    if not size > 0.0:
        ensemble.ends[TIME_ROW, orbit] = np.nan
    if ensemble.escape_time[orbit] < np.inf:
        return
    channel = crossed_exit(now[0, i], now[1, i], new[0, i], new[1, i], curves, gates)
    if channel == 0 and flags & NEAR != 0:
        channel = passed_exit(x_jet, y_jet, i, size, curves)
    if channel > 0:
        tau = find_exit_time(x_jet, y_jet, i, size, curves[channel - 1])
        channel = reached_exit(series_value(x_jet, i, tau), series_value(y_jet, i, tau), channel, curves)
        ensemble.escape_time[orbit] = now[TIME_ROW, i] + tau
        follow_time = 0.0 if ends_inside(curves[channel - 1]) else beyond
        ensemble.last_time[orbit] = ensemble.escape_time[orbit] + follow_time
    ensemble.leaving[orbit] = channel
    section = gates[curves.shape[0] :]
    if crosses:
        tau = find_zero(section_series(x_jet, y_jet, i, section, work), i, 0.0, size)
        ensemble.section[0, orbit] = series_value(x_jet, i, tau)
        ensemble.section[1, orbit] = series_value(y_jet, i, tau)
        ensemble.section[2, orbit] = series_slope(x_jet, i, tau)
        ensemble.section[3, orbit] = series_slope(y_jet, i, tau)
