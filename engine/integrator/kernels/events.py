"""Events within one step, located in its dense output: exits and crossings of a surface of section.

An orbit that has crossed the path of a Lyapunov orbit does not return. Any other exit can be crossed and recrossed within a step,
so the whole step is examined for such an exit.
"""

from __future__ import annotations

from engine.integrator.jit.decorator import subroutine
from engine.integrator.kernels.exit_geometry import (
    COEFFICIENTS,
    HALF_WIDTH,
    LINE,
    ORIGIN_X,
    ORIGIN_Y,
    OUTWARD_X,
    OUTWARD_Y,
    REACH,
    SHAPE,
    ends_inside,
    exit_distance,
    is_circle,
    position_across,
)
from engine.integrator.kernels.sections import counts_falls, is_on_side, section_series

# Fates of an orbit or a start, besides the number, 1 or more, of the exit at which an orbit ended.
BOUNDED, FORBIDDEN, OUTSIDE, NOT_COMPUTED, FAILED = 0, -1, -2, -3, -4

# Number of parts of a step that are examined in turn; within a part, the slope of a series is assumed to change its sign at most
# once.
_PARTS = 8
# Largest number of iterations in the search for a root.
_ROOT_ITERATIONS = 80
# Accuracy of a root, in units of time or length of the well.
_ROOT_ACCURACY = 1e-15


@subroutine
def crossed_exit(x0, y0, x1, y1, curves, gates):
    """Return the number of the exit that an orbit crosses outward in a step from (x0, y0) to (x1, y1); 0 for none.

    curves (exits, columns), gates (exits, 3): see `engine.integrator.kernels.propagate.Exits`.
    """
    for k in range(curves.shape[0]):
        curve = curves[k]
        if not is_circle(curve) and gates[k, 0] * x1 + gates[k, 1] * y1 <= gates[k, 2]:
            continue
        end_distance = exit_distance(x1, y1, curve)
        # `not … >` also skips NaN.
        if not end_distance > 0.0:
            continue
        start_distance = exit_distance(x0, y0, curve)
        if start_distance > 0.0:
            continue
        if is_circle(curve):
            return k + 1
        s0 = position_across(x0, y0, curve)
        s1 = position_across(x1, y1, curve)
        # The crossing of the chord of the step, by linear interpolation.
        if abs(s0 + (s1 - s0) * start_distance / (start_distance - end_distance)) <= curve[REACH]:
            return k + 1
    return 0


@subroutine
def series_value(jet, i, tau):
    """Return the value of a series, column i of `jet` (order + 1, n), at time tau after the start of its step."""
    value = jet[jet.shape[0] - 1, i]
    for k in range(jet.shape[0] - 2, -1, -1):
        value = value * tau + jet[k, i]
    return value


@subroutine
def series_slope(jet, i, tau):
    """Return the time derivative of a series, column i of `jet` (order + 1, n), at time tau after the start of its step."""
    order = jet.shape[0] - 1
    slope = order * jet[order, i]
    for k in range(order - 1, 0, -1):
        slope = slope * tau + k * jet[k, i]
    return slope


@subroutine
def find_extremum(jet, i, low, high):
    """Find the time between `low` and `high` at which the slope of a series changes its sign, by bisection."""
    is_rising = series_slope(jet, i, low) > 0.0
    for _ in range(_ROOT_ITERATIONS):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        if (series_slope(jet, i, middle) > 0.0) == is_rising:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@subroutine
def find_zero(jet, i, low, high):
    """Find the zero of a series between two times at which its signs differ, by Newton's method, safeguarded by bisection."""
    is_positive = series_value(jet, i, low) > 0.0
    tau = 0.5 * (low + high)
    for _ in range(_ROOT_ITERATIONS):
        value = series_value(jet, i, tau)
        if (value > 0.0) == is_positive:
            low = tau
        else:
            high = tau
        slope = series_slope(jet, i, tau)
        newton_tau = tau - value / slope if slope != 0.0 else low
        if abs(newton_tau - tau) < _ROOT_ACCURACY or high - low < _ROOT_ACCURACY:
            break
        tau = newton_tau if low < newton_tau < high else 0.5 * (low + high)
    return tau


@subroutine
def crossing_between(jet, i, direction, low, y_low, slope_low, high, y_high, slope_high):
    """Return times before and after the zero of a series, in a direction, in a part of a step; equal times if there is none.

    jet: series, such as y; direction: 1 for crossings from y < 0 to y ≥ 0, −1 for crossings from y > 0 to y ≤ 0; low, high: the
    ends of the part; y_…, slope_…: y and ẏ at these ends, times `direction`. A crossing may be one of a pair in opposite
    directions.
    """
    # An orbit that starts on the section and moves against the direction counts as being before the section.
    is_before = y_low < 0.0 or (y_low == 0.0 and slope_low < 0.0)
    if is_before and y_high >= 0.0:
        return low, high
    if y_low * y_high > 0.0 and y_low * slope_low < 0.0 and y_high * slope_high > 0.0:
        turning_tau = find_extremum(jet, i, low, high)
        turns_before = direction * series_value(jet, i, turning_tau) < 0.0
        if turns_before and y_low > 0.0:
            return turning_tau, high
        if not turns_before and y_low < 0.0:
            return low, turning_tau
    return low, low


@subroutine
def count_crossings(x_jet, y_jet, i, duration, section, work):
    """Count the crossings of a section within `duration` of the start of a step; work: see `section_series`."""
    jet = section_series(x_jet, y_jet, i, section, work)
    count = 0
    low = 0.0
    at_low, slope_low = series_value(jet, i, low), series_slope(jet, i, low)
    for part in range(1, _PARTS + 1):
        high = duration * part / _PARTS
        at_high, slope_high = series_value(jet, i, high), series_slope(jet, i, high)
        for fall in range(2 if counts_falls(section) else 1):
            sign = -1.0 if fall == 1 else 1.0
            before, after = crossing_between(
                jet, i, sign, low, sign * at_low, sign * slope_low, high, sign * at_high, sign * slope_high
            )
            if after > before and (section.shape[0] == 0 or _counts_on_side(x_jet, y_jet, i, jet, before, after, section)):
                count += 1
        low, at_low, slope_low = high, at_high, slope_high
    return count


@subroutine
def _counts_on_side(x_jet, y_jet, i, jet, before, after, section):
    """Return whether the crossing between two times of a step is on the side of the section on which crossings count."""
    tau = find_zero(jet, i, before, after)
    return is_on_side(series_value(x_jet, i, tau), series_value(y_jet, i, tau), section)


@subroutine
def append_crossings(x_jet, y_jet, i, begin, duration, section, work, crossings, found, orbit):
    """Append each crossing of a section within `duration` of the start of a step to `crossings` (n, m, columns).

    begin: time at the start of the step; work: see `section_series`; columns: the first 3 to 5 of x, px, time, py and y; found
    (n,): number of crossings of each orbit, increased in place. The row of `orbit` is filled from this index, until the row has m
    crossings.
    """
    jet = section_series(x_jet, y_jet, i, section, work)
    low = 0.0
    at_low, slope_low = series_value(jet, i, low), series_slope(jet, i, low)
    for part in range(1, _PARTS + 1):
        high = duration * part / _PARTS
        at_high, slope_high = series_value(jet, i, high), series_slope(jet, i, high)
        # A pair of crossings in a part is a rise before a fall if the part begins below the section.
        falls_first = at_low > 0.0
        for crossing in range(2 if counts_falls(section) else 1):
            sign = -1.0 if counts_falls(section) and (crossing == 0) == falls_first else 1.0
            before, after = crossing_between(
                jet, i, sign, low, sign * at_low, sign * slope_low, high, sign * at_high, sign * slope_high
            )
            if after > before and found[orbit] < crossings.shape[1]:
                tau = find_zero(jet, i, before, after)
                if is_on_side(series_value(x_jet, i, tau), series_value(y_jet, i, tau), section):
                    _append_crossing(x_jet, y_jet, i, begin, tau, crossings, found, orbit)
        low, at_low, slope_low = high, at_high, slope_high


@subroutine
def _append_crossing(x_jet, y_jet, i, begin, tau, crossings, found, orbit):
    """Append the state at time tau after the start of a step to the crossings of an orbit, see `append_crossings`."""
    crossings[orbit, found[orbit], 0] = series_value(x_jet, i, tau)
    crossings[orbit, found[orbit], 1] = series_slope(x_jet, i, tau)
    crossings[orbit, found[orbit], 2] = begin + tau
    if crossings.shape[2] > 3:
        crossings[orbit, found[orbit], 3] = series_slope(y_jet, i, tau)
    if crossings.shape[2] > 4:
        crossings[orbit, found[orbit], 4] = series_value(y_jet, i, tau)
    found[orbit] += 1


@subroutine
def _exit_rate(x_jet, y_jet, i, tau, curve):
    """Return a number with the sign of the rate at which the distance from a line, a disc or the escape circle grows."""
    vx = series_slope(x_jet, i, tau)
    vy = series_slope(y_jet, i, tau)
    if curve[SHAPE] == LINE:
        s = min(max(position_across(series_value(x_jet, i, tau), series_value(y_jet, i, tau), curve), -1.0), 1.0)
        # The derivatives of the Chebyshev polynomials s and 2s² − 1 are 1 and 4s.
        slope = (curve[COEFFICIENTS + 1] + 4.0 * s * curve[COEFFICIENTS + 2]) / curve[HALF_WIDTH]
        u_rate = curve[OUTWARD_X] * vx + curve[OUTWARD_Y] * vy
        return u_rate - slope * (curve[OUTWARD_X] * vy - curve[OUTWARD_Y] * vx)
    rate = (series_value(x_jet, i, tau) - curve[ORIGIN_X]) * vx + (series_value(y_jet, i, tau) - curve[ORIGIN_Y]) * vy
    return -rate if ends_inside(curve) else rate


@subroutine
def _find_excursion(x_jet, y_jet, i, duration, curve):
    """Return the time within `duration` at which an orbit is farthest beyond an exit that it recrosses; −1 for none."""
    low = 0.0
    rate_low = _exit_rate(x_jet, y_jet, i, low, curve)
    for part in range(1, _PARTS + 1):
        high = duration * part / _PARTS
        rate_high = _exit_rate(x_jet, y_jet, i, high, curve)
        if rate_low > 0.0 and rate_high <= 0.0:
            before, after = low, high
            for _ in range(_ROOT_ITERATIONS):
                middle = 0.5 * (before + after)
                if middle <= before or middle >= after:
                    break
                if _exit_rate(x_jet, y_jet, i, middle, curve) > 0.0:
                    before = middle
                else:
                    after = middle
            if _is_beyond(series_value(x_jet, i, before), series_value(y_jet, i, before), curve):
                return before
        low, rate_low = high, rate_high
    return -1.0


@subroutine
def _is_beyond(x, y, curve):
    """Return whether a point is beyond an exit and, for a line, within its reach."""
    return exit_distance(x, y, curve) > 0.0 and (is_circle(curve) or abs(position_across(x, y, curve)) <= curve[REACH])


@subroutine
def passed_exit(x_jet, y_jet, i, duration, curves):
    """Return the number of the exit that an orbit crosses and recrosses within `duration` of the start of a step; 0 for none."""
    for k in range(curves.shape[0]):
        if curves[k, SHAPE] >= LINE and _find_excursion(x_jet, y_jet, i, duration, curves[k]) >= 0.0:
            return k + 1
    return 0


@subroutine
def find_exit_time(x_jet, y_jet, i, duration, curve):
    """Return the time from the start of a step to the crossing of an exit, by the Illinois method."""
    low, high = 0.0, duration
    if curve[SHAPE] >= LINE:
        excursion = _find_excursion(x_jet, y_jet, i, duration, curve)
        high = excursion if excursion >= 0.0 else duration
    at_low = exit_distance(series_value(x_jet, i, low), series_value(y_jet, i, low), curve)
    at_high = exit_distance(series_value(x_jet, i, high), series_value(y_jet, i, high), curve)
    if at_low >= 0.0:
        return low
    # The end that moved last. If it moves again, the value at the other end is halved.
    side = 0
    for _ in range(_ROOT_ITERATIONS):
        tau = (low * at_high - high * at_low) / (at_high - at_low)
        if not (low < tau < high) or high - low < _ROOT_ACCURACY:
            break
        value = exit_distance(series_value(x_jet, i, tau), series_value(y_jet, i, tau), curve)
        if abs(value) < _ROOT_ACCURACY:
            return tau
        if value > 0.0:
            high, at_high = tau, value
            if side > 0:
                at_low *= 0.5
            side = 1
        else:
            low, at_low = tau, value
            if side < 0:
                at_high *= 0.5
            side = -1
    return high
