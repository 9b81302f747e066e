"""Tests which points of the Hill region are inside: a path below the energy leads to the origin without crossing an exit.

A path leads downhill from the point until V on the straight line to the origin is below the energy. The path ends with this line,
and the point is inside if the whole path crosses the exits an even number of times. If the path leads to another minimum, or to a
value of V below the values at the origin and on the exits, the path ends outside, and the point is inside if the path crosses the
exits an odd number of times.

The two kernels evaluate V in different ways. The kernel for polynomials uses the terms, with a proof that V on a line is below a
level. The kernel for expressions uses a generated function, and replaces V on a line between neighbouring points by the cubic
with the same values and slopes.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel, subroutine
from engine.integrator.jit.function_pointers import call_potential_slopes
from engine.integrator.kernels.exit_geometry import (
    BEARING_X,
    BEARING_Y,
    REACH,
    ends_inside,
    exit_distance,
    exit_point,
    is_circle,
    is_open_channel,
    position_across,
    reached_exit,
)

# All lengths and energies are in units of the well.

# Longest step of a path near the origin.
_LONGEST_STEP = 1.0 / 32.0
# Shortest step of a path; where steps would be shorter, the path has reached a minimum.
_SHORTEST_STEP = 1e-6
# Largest number of steps of a path.
_MOST_STEPS = 10_000
# Growth of the longest step with |x| + |y|, in units of the longest step near the origin.
_STEP_GROWTH = 0.25
# Cosine and sine of the angle between a path and the gradient; the path thus leaves lines of symmetry, which can end at saddles.
_COS, _SIN = np.cos(0.1), np.sin(0.1)
# Smallest decrease of V in a step, relative to the decrease along the gradient.
_LEAST_DECREASE = 0.25
# Smallest difference between the energy and V on a line to the origin, so that the line does not pass over a saddle of the same
# energy; points may lie above the energy by as much.
_ENERGY_MARGIN = 1e-12
# Smallest slope of V at a point that is not critical.
_LEAST_SLOPE = 1e-9
# Number of parts of a line to the origin.
_PIECES = 32
# Number of points on the edge of a body at the origin, and on each half of an exit.
_EDGE_POINTS = 64
_EXIT_POINTS = 8
# Share of the depth of V below the energy by which V on an exit can be lower than at these points.
_DEPTH_MARGIN = 0.1


@subroutine
def _polynomial_slopes(polynomial, x, y):
    """Return V, V_x and V_y of a polynomial; row 2 of its `work` is set to the series of V(t x, t y) in t."""
    powers, coefficients, _, work = polynomial
    x_power = 1.0
    y_power = 1.0
    for k in range(work.shape[1]):
        work[0, k] = x_power
        work[1, k] = y_power
        work[2, k] = 0.0
        x_power *= x
        y_power *= y
    value = 0.0
    slope_x = 0.0
    slope_y = 0.0
    for m in range(coefficients.shape[0]):
        i = powers[m, 0]
        j = powers[m, 1]
        term = coefficients[m] * work[0, i] * work[1, j]
        value += term
        work[2, i + j] += term
        if i > 0:
            slope_x += coefficients[m] * i * work[0, i - 1] * work[1, j]
        if j > 0:
            slope_y += coefficients[m] * j * work[0, i] * work[1, j - 1]
    return value, slope_x, slope_y


@subroutine
def _polynomial_is_below(polynomial, x, y, level):
    """Return whether all Bernstein coefficients on [0, 1] of the series in row 2 of `work` are at most a level."""
    _, _, bernstein, work = polynomial
    for i in range(bernstein.shape[0]):
        coefficient = 0.0
        for k in range(i + 1):
            coefficient += bernstein[i, k] * work[2, k]
        if coefficient > level:
            return False
    return True


@subroutine
def _expression_slopes(generated, x, y):
    """Return V, V_x and V_y of an expression."""
    address, coefficients, _ = generated
    return call_potential_slopes(address, coefficients, x, y)


@subroutine
def _expression_is_below(generated, x, y, level):
    """Return whether V on the line from the well to (x, y) is at most a level, by Bernstein coefficients of cubics.

    The line begins at the origin, or at the edge of a body at the origin.
    """
    _, _, inner_radius = generated
    # Points of the line are t (x, y) with begin ≤ t ≤ 1.
    begin = inner_radius / max(inner_radius, np.sqrt(x * x + y * y)) if inner_radius > 0.0 else 0.0
    width = (1.0 - begin) / _PIECES
    value, slope_x, slope_y = _expression_slopes(generated, begin * x, begin * y)
    # Bernstein coefficients of a cubic are its values at the ends, and these values plus or minus a third of the slope.
    next_coefficient = value + (slope_x * x + slope_y * y) * width / 3.0
    if not (value <= level and next_coefficient <= level):
        return False
    for piece in range(1, _PIECES + 1):
        t = begin + piece * width
        value, slope_x, slope_y = _expression_slopes(generated, t * x, t * y)
        rise = (slope_x * x + slope_y * y) * width / 3.0
        if not (value <= level and value - rise <= level and (piece == _PIECES or value + rise <= level)):
            return False
    return True


@subroutine
def _crosses_exits(x0, y0, x1, y1, curves):
    """Return whether the line from (x0, y0) to (x1, y1) crosses the open exits an odd number of times."""
    is_odd = False
    for k in range(curves.shape[0]):
        curve = curves[k]
        if not is_open_channel(curve):
            continue
        s0 = position_across(x0, y0, curve)
        s1 = position_across(x1, y1, curve)
        # The part of the line with −1 ≤ s ≤ 1.
        low = 0.0
        high = 1.0
        if s0 != s1:
            at_first_end = (-1.0 - s0) / (s1 - s0)
            at_last_end = (1.0 - s0) / (s1 - s0)
            low = max(low, min(at_first_end, at_last_end))
            high = min(high, max(at_first_end, at_last_end))
        elif abs(s0) > 1.0:
            continue
        if low < high:
            at_low = exit_distance((1.0 - low) * x0 + low * x1, (1.0 - low) * y0 + low * y1, curve)
            at_high = exit_distance((1.0 - high) * x0 + high * x1, (1.0 - high) * y0 + high * y1, curve)
            is_odd ^= (at_low > 0.0) != (at_high > 0.0)
    return is_odd


@subroutine
def _lowest_on_exits(slopes, potential, energy, curves):
    """Return a value below the lowest V on the open exits, down to which paths inside can lead."""
    lowest = energy
    for k in range(curves.shape[0]):
        if not is_open_channel(curves[k]):
            continue
        for i in range(1 - _EXIT_POINTS, _EXIT_POINTS):
            x, y = exit_point(curves[k], i / _EXIT_POINTS)
            value, _, _ = slopes(potential, x, y)
            lowest = min(lowest, value)
    return lowest - _DEPTH_MARGIN * (energy - lowest)


@subroutine
def _is_outside(slopes, is_below, potential, x, y, energy, curves, bottom):
    """Return whether a point is outside.

    slopes, is_below: the two functions above for polynomials or for expressions; potential: their first argument; curves (exits,
    columns); bottom: the lowest V on a path to the origin.
    """
    level = energy - _ENERGY_MARGIN
    # Whether the path so far crosses the exits an odd number of times.
    is_odd = False
    # The lowest V inside. Most paths do not lead below `bottom`, so V on the exits is needed for few paths.
    lowest = -np.inf
    step = _LONGEST_STEP
    for _ in range(_MOST_STEPS):
        value, slope_x, slope_y = slopes(potential, x, y)
        slope = np.sqrt(slope_x * slope_x + slope_y * slope_y)
        if slope < _LEAST_SLOPE and value >= level:
            # A saddle of this energy belongs to the well.
            return False
        if is_below(potential, x, y, level):
            return is_odd ^ _crosses_exits(x, y, 0.0, 0.0, curves)
        if value < bottom and lowest == -np.inf:
            lowest = min(bottom, _lowest_on_exits(slopes, potential, energy, curves))
        if value < lowest:
            break
        direction_x = -(_COS * slope_x - _SIN * slope_y) / slope
        direction_y = -(_SIN * slope_x + _COS * slope_y) / slope
        step = min(2.0 * step, _LONGEST_STEP * max(1.0, _STEP_GROWTH * (abs(x) + abs(y))))
        while step > _SHORTEST_STEP:
            next_value, _, _ = slopes(potential, x + step * direction_x, y + step * direction_y)
            if next_value < value - _LEAST_DECREASE * step * slope:
                break
            step *= 0.5
        if step <= _SHORTEST_STEP:
            break
        is_odd ^= _crosses_exits(x, y, x + step * direction_x, y + step * direction_y, curves)
        x += step * direction_x
        y += step * direction_y
    return not is_odd


@subroutine
def _find_outside(slopes, is_below, potential, x, y, energy, curves, curve_row, bottom, outside):
    """Set `outside` (n,) int8 to the number of an exit for each point outside; other points, and forbidden points, keep 0.

    Beyond a circle, this is the number of the circle; elsewhere, the number of the exit whose saddle is nearest in direction.
    """
    for i in range(x.shape[0]):
        row = curves[curve_row[i]]
        value, _, _ = slopes(potential, x[i], y[i])
        highest = energy[i] + _ENERGY_MARGIN
        circle = _find_circle(x[i], y[i], row)
        # At the centre of a body V may be infinite or NaN; `not … >` accepts NaN.
        if circle > 0 and not value > highest:
            outside[i] = circle
        if circle > 0 or not value <= highest or not _has_exits(row):
            continue
        if not _is_outside(slopes, is_below, potential, x[i], y[i], energy[i], row, bottom):
            continue
        largest = -np.inf
        for k in range(row.shape[0]):
            projection = row[k, BEARING_X] * x[i] + row[k, BEARING_Y] * y[i]
            if not is_circle(row[k]) and projection > largest:
                largest = projection
                outside[i] = k + 1


@subroutine
def _find_circle(x, y, curves):
    """Return the number of the circle beyond which a point lies, or 0; a body takes precedence over the escape circle."""
    number = 0
    for k in range(curves.shape[0]):
        if is_circle(curves[k]) and exit_distance(x, y, curves[k]) > 0.0 and (number == 0 or ends_inside(curves[k])):
            number = reached_exit(x, y, k + 1, curves)
    return number


@subroutine
def _has_exits(curves):
    """Return whether there are exits over saddles, which exclude an escape circle; the reach of an absent exit is negative."""
    has_exits = False
    for k in range(curves.shape[0]):
        has_exits |= not is_circle(curves[k]) and curves[k, REACH] >= 0.0
    return has_exits


@kernel
def find_outside_polynomial(powers, coefficients, bernstein, work, x, y, energy, curves, curve_row, outside):
    """Apply `_find_outside` to a polynomial.

    powers (terms, 2), coefficients (terms,): terms of V; bernstein (n, n): matrix of `engine.exits.interior`; work (3, n): work
    space; x, y, energy (n,); curves (rows, exits, columns); curve_row (n,).
    """
    polynomial = (powers, coefficients, bernstein, work)
    bottom, _, _ = _polynomial_slopes(polynomial, 0.0, 0.0)
    _find_outside(_polynomial_slopes, _polynomial_is_below, polynomial, x, y, energy, curves, curve_row, bottom, outside)


@kernel
def find_outside(potential_slopes, coefficients, inner_radius, x, y, energy, curves, curve_row, outside):
    """Apply `_find_outside` to an expression; inner_radius: radius of a body at the origin, or 0.0."""
    generated = (potential_slopes, coefficients, inner_radius)
    # `bottom` is the lowest value of V on the edge of the body; a path below this value cannot lead to the edge.
    bottom = np.inf
    for k in range(_EDGE_POINTS):
        angle = 2.0 * np.pi * k / _EDGE_POINTS
        value, _, _ = _expression_slopes(generated, inner_radius * np.cos(angle), inner_radius * np.sin(angle))
        bottom = min(bottom, value)
    _find_outside(_expression_slopes, _expression_is_below, generated, x, y, energy, curves, curve_row, bottom, outside)
