"""Shooting for Lyapunov orbits: half a period of motion across a channel, from one zero-velocity curve to the other.

These kernels are compiled once for all potentials, like `engine.integrator.kernels.propagate`.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_jets, call_potential_value, call_step
from engine.integrator.kernels.events import series_slope
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW, TIME_ROW
from engine.integrator.source.series import ORDER

# Distance between points at which a wall is searched, in units of the well.
_WALL_STRIDE = 0.02
# Largest distance of a wall from the line through the saddle, in units of the well.
_FURTHEST_WALL = 20.0
# Largest number of bisections.
_BISECTIONS = 80
# Largest number of steps of half a period.
_MOST_STEPS = 400
# Number of gates: no fewer than the saddles of any potential of the highest supported degree.
_MOST_CHANNELS = 128


@subroutine
def find_wall(potential_value, coefficients, u, saddle_x, saddle_y, outward_x, outward_y, energy):
    """Return the q < 0 at which the line across the channel at u meets the zero-velocity curve V = energy; NaN for none.

    The coordinates (u, q) are measured from the saddle along `outward` and along the direction 90° counterclockwise from it.
    """
    x = saddle_x + u * outward_x
    y = saddle_y + u * outward_y
    # `low` and `high` are values of −q.
    high = 0.0
    if call_potential_value(potential_value, coefficients, x, y) >= energy:
        return np.nan
    while call_potential_value(potential_value, coefficients, x + high * outward_y, y - high * outward_x) < energy:
        high += _WALL_STRIDE
        if high > _FURTHEST_WALL:
            return np.nan
    low = high - _WALL_STRIDE
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if call_potential_value(potential_value, coefficients, x + middle * outward_y, y - middle * outward_x) < energy:
            low = middle
        else:
            high = middle
    return -0.5 * (low + high)


@kernel
def shoot(
    step, jets, potential_value, coefficients, u, saddle_x, saddle_y, outward_x, outward_y, energy, reach, tolerance, steps
):
    """Start at rest on the zero-velocity curve at u, q < 0, and follow the orbit until its motion across the channel turns back.

    Returns u̇ and the time at the turning point, and the number of steps. u̇ < 0 means a start too close to the well, u̇ > 0 a
    start too far out, and u̇ = 0 the Lyapunov orbit. If an orbit moves farther than `reach` along the channel before it turns,
    u̇ is −1 or 1, and the time is NaN. Without a start or a turning point, both are NaN, and the number of steps is 0.

    steps (m, 5): set to x, y, px, py, t at the start of each step.
    """
    now = np.zeros((ROWS, LANES))
    new = np.zeros((ROWS, LANES))
    flag = np.zeros(LANES, np.int64)
    crossed = np.zeros(LANES, np.int64)
    # No step passes these gates, so exits are ignored.
    gates = np.zeros((_MOST_CHANNELS, 3))
    gates[:, 2] = np.inf
    q = find_wall(potential_value, coefficients, u, saddle_x, saddle_y, outward_x, outward_y, energy)
    if np.isnan(q):
        return np.nan, np.nan, 0
    now[0, 0] = saddle_x + u * outward_x - q * outward_y
    now[1, 0] = saddle_y + u * outward_y + q * outward_x
    for count in range(min(steps.shape[0], _MOST_STEPS)):
        for c in range(5):
            steps[count, c] = now[c, 0]
        call_step(step, coefficients, 1, tolerance, np.inf, gates, now, new, flag, crossed)
        if outward_x * new[3, 0] - outward_y * new[2, 0] <= 0.0:
            return _turning_point(jets, coefficients, now, new[SIZE_ROW, 0], outward_x, outward_y, count)
        excursion = outward_x * (new[0, 0] - saddle_x) + outward_y * (new[1, 0] - saddle_y) - u
        # `not … <` also rejects NaN.
        if not abs(excursion) < reach:
            return (1.0 if excursion > 0.0 else -1.0), np.nan, count + 1
        now, new = new, now
    return np.nan, np.nan, 0


@subroutine
def _turning_point(jets, coefficients, now, h, outward_x, outward_y, count):
    """Return the result of `shoot` for an orbit whose motion across the channel turns back within the step from `now`."""
    x_jet = np.empty((ORDER + 1, 1))
    y_jet = np.empty((ORDER + 1, 1))
    call_jets(jets, coefficients, 1, now[0], now[1], now[2], now[3], x_jet, y_jet)
    low, high = 0.0, h
    for _ in range(_BISECTIONS):
        tau = 0.5 * (low + high)
        if tau <= low or tau >= high:
            break
        if outward_x * series_slope(y_jet, 0, tau) - outward_y * series_slope(x_jet, 0, tau) > 0.0:
            low = tau
        else:
            high = tau
    tau = 0.5 * (low + high)
    u_rate = outward_x * series_slope(x_jet, 0, tau) + outward_y * series_slope(y_jet, 0, tau)
    return u_rate, now[TIME_ROW, 0] + tau, count + 1
