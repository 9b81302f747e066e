"""Random starts: points of a slice, and states on the exits.

The random numbers are those of the generator mulberry32 (Tommy Ettinger). Its state is a single integer, and equal seeds give
equal starts on all machines.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_potential_value
from engine.integrator.kernels.exit_geometry import CURVE, HALF_WIDTH, OUTWARD_X, OUTWARD_Y, SHAPE, exit_point, is_open_channel

BEFORE_EXIT = 9.0
"""Time from the start of an orbit near the edge of a tube to the exit, in units of the well."""

# Mask of 32 bits.
_WORD = 0xFFFFFFFF
# Number of parts of an exit, for each of which the flux is computed.
_PARTS = 200
# Distance of entering orbits from the exit, as a share of its half width; on the exit, rounding would decide which are inside.
_INWARD_SHIFT = 1e-7
# Distance of orbits from the edge of their tube, measured at the exit, as a share of the half width of the exit.
_EDGE_DISTANCE = 3e-3


@subroutine
def _draw_number(seed):
    """Return a random number of 32 bits, at least 0 and below 1; seed (1,) is changed."""
    # 4294967296 is 2^32.
    seed[0] = (seed[0] + 0x6D2B79F5) & _WORD
    state = seed[0]
    mixed = ((state ^ (state >> 15)) * (state | 1)) & _WORD
    mixed ^= (mixed + (((mixed ^ (mixed >> 7)) * (mixed | 61)) & _WORD)) & _WORD
    return (mixed ^ (mixed >> 14)) / 4294967296.0


@kernel
def scatter_points(seed, window, is_round, points):
    """Set `points` (axes, n) to random points, uniform in a window (4,) or, if `is_round`, in the ellipse inscribed in it.

    A third coordinate is an angle from 0 to 2π. seed (1,) is changed.
    """
    width, height = window[1] - window[0], window[3] - window[2]
    for i in range(points.shape[1]):
        x_share, y_share = _draw_number(seed), _draw_number(seed)
        if is_round:
            radius, angle = 0.5 * np.sqrt(x_share), 2.0 * np.pi * y_share
            x_share, y_share = 0.5 + radius * np.cos(angle), 0.5 + radius * np.sin(angle)
        points[0, i] = window[0] + width * x_share
        points[1, i] = window[2] + height * y_share
        for axis in range(2, points.shape[0]):
            points[axis, i] = 2.0 * np.pi * _draw_number(seed)


@kernel
def draw_at_exits(potential_value, coefficients, curves, energy, of_tubes, seed, states):
    """Set `states` (n, 4) to random states on the open exits over saddles (exits, columns); return their number.

    The states move into the well, with the distribution of the flux, like those of `sample_entrances`. With `of_tubes`, the
    states lie near the edges of the tubes of orbits that, in backward time, approach the Lyapunov orbits: half of them inside a
    tube, where orbits pass the exit, and half outside, where orbits turn back. In a rotating frame the exits are lines, not
    Lyapunov orbits, and have no tubes. seed (1,) is changed.
    """
    # The flux through all parts of all exits up to and including each part.
    flux = np.zeros(curves.shape[0] * _PARTS)
    total = 0.0
    for exit in range(curves.shape[0]):
        is_used = curves[exit, SHAPE] == CURVE if of_tubes else is_open_channel(curves[exit])
        for part in range(_PARTS):
            if is_used:
                x, y, along_x, along_y = _point_and_slope(curves[exit], _middle(part))
                speed = _speed(potential_value, coefficients, energy, x, y)
                total += speed * np.sqrt(along_x * along_x + along_y * along_y)
            flux[exit * _PARTS + part] = total
    if not total > 0.0:
        return 0
    for i in range(states.shape[0]):
        index = _find_above(flux, total * _draw_number(seed))
        s = _middle(index % _PARTS) + (2.0 * _draw_number(seed) - 1.0) / _PARTS
        share, shift = 2.0 * _draw_number(seed) - 1.0, _INWARD_SHIFT
        if of_tubes:
            side = 1.0 if share < 0.0 else -1.0
            is_inside = _draw_number(seed) < 0.5
            share = side * (np.sqrt(1.0 - _EDGE_DISTANCE * _EDGE_DISTANCE) if is_inside else 1.0)
            shift = _INWARD_SHIFT if is_inside else _EDGE_DISTANCE
        _launch(potential_value, coefficients, energy, curves[index // _PARTS], s, share, shift, states[i])
    return states.shape[0]


@subroutine
def _find_above(values, limit):
    """Return the index of the first of rising values (n,) above a limit; the last value must be above the limit."""
    low, high = 0, values.shape[0] - 1
    while low < high:
        middle = (low + high) // 2
        if values[middle] > limit:
            high = middle
        else:
            low = middle + 1
    return low


@subroutine
def _middle(part):
    """Return s in the middle of a part of an exit."""
    return -1.0 + (2 * part + 1) / _PARTS


@subroutine
def _launch(potential_value, coefficients, energy, curve, s, share, shift, state):
    """Set `state` (4,) at s of an exit, shifted inward; `share` is the component of the unit velocity along the exit."""
    x, y, along_x, along_y = _point_and_slope(curve, s)
    length = np.sqrt(along_x * along_x + along_y * along_y)
    along_x, along_y = along_x / length, along_y / length
    side = -1.0 if along_y * curve[OUTWARD_X] - along_x * curve[OUTWARD_Y] > 0.0 else 1.0
    inward_x, inward_y = side * along_y, -side * along_x
    inward_share = np.sqrt(max(1.0 - share * share, 0.0))
    state[0] = x + shift * curve[HALF_WIDTH] * inward_x
    state[1] = y + shift * curve[HALF_WIDTH] * inward_y
    speed = _speed(potential_value, coefficients, energy, state[0], state[1])
    state[2] = speed * (share * along_x + inward_share * inward_x)
    state[3] = speed * (share * along_y + inward_share * inward_y)


@subroutine
def _point_and_slope(curve, s):
    """Return x and y of a point of an exit, and their derivatives with respect to s."""
    step = 0.5 / _PARTS
    x, y = exit_point(curve, s)
    x_before, y_before = exit_point(curve, s - step)
    x_after, y_after = exit_point(curve, s + step)
    return x, y, (x_after - x_before) / (2.0 * step), (y_after - y_before) / (2.0 * step)


@subroutine
def _speed(potential_value, coefficients, energy, x, y):
    """Return the speed at a point; 0 in the forbidden region."""
    return np.sqrt(max(2.0 * (energy - call_potential_value(potential_value, coefficients, x, y)), 0.0))
