"""Roots of functions of one variable, and bisection of many intervals at once."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

# Largest number of steps; far more than smooth functions need.
_MOST_STEPS = 100
# Smallest relative tolerance that rounding permits, the default of SciPy.
_SMALLEST_RTOL = 4.0 * float(np.finfo(float).eps)


def find_root(function: Callable[[float], float], low: float, high: float, *, xtol: float, rtol: float = _SMALLEST_RTOL) -> float:
    """Find a root by Brent's method (Brent 1973, Algorithms for Minimization without Derivatives, chapter 4).

    The steps are those of `scipy.optimize.brentq`, which is not used because its import takes longer than a search.

    Parameters
    ----------
    function
        Continuous function.
    low, high
        The ends of the bracket, at which the function has different signs.
    xtol, rtol
        The result is within ``xtol + rtol * abs(root)`` of a change of sign, unless the number of steps is exhausted. By default
        `rtol` is four times the spacing of doubles at 1.

    Returns
    -------
    The root. After 100 steps, far more than smooth functions need, the last point.

    Raises
    ------
    ValueError
        If the function has the same sign at both ends, or is NaN at a point where it is evaluated.
    """

    def evaluate(x: float) -> float:
        value = function(x)
        if math.isnan(value):
            raise ValueError(f"bracket=({low}, {high}): the function is NaN at {x}")
        return value

    previous_x, x = low, high
    previous_value, value = evaluate(previous_x), evaluate(x)
    if previous_value * value > 0.0:
        raise ValueError(f"bracket=({low}, {high}): the function must have different signs at its ends")
    # The root lies between `x` and `opposite_x`.
    opposite_x, opposite_value = previous_x, previous_value
    last_step = step = x - previous_x
    for _ in range(_MOST_STEPS):
        if previous_value and value and (previous_value < 0.0) != (value < 0.0):
            opposite_x, opposite_value = previous_x, previous_value
            last_step = step = x - previous_x
        # `x` is the end of the bracket with the smaller value.
        if abs(opposite_value) < abs(value):
            previous_x, x, opposite_x = x, opposite_x, x
            previous_value, value, opposite_value = value, opposite_value, value
        tolerance = (xtol + rtol * abs(x)) / 2.0
        half_width = (opposite_x - x) / 2.0
        if value == 0.0 or abs(half_width) < tolerance:
            return x
        trial_step = math.inf
        if abs(last_step) > tolerance and abs(value) < abs(previous_value):
            trial_step = _interpolate((previous_x, previous_value), (x, value), (opposite_x, opposite_value))
        # Interpolate only if the steps shrink fast enough; otherwise bisect.
        if 2.0 * abs(trial_step) < min(abs(last_step), 3.0 * abs(half_width) - tolerance):
            last_step, step = step, trial_step
        else:
            last_step = step = half_width
        previous_x, previous_value = x, value
        x += step if abs(step) > tolerance else math.copysign(tolerance, half_width)
        value = evaluate(x)
    return x


def _interpolate(previous: tuple[float, float], present: tuple[float, float], opposite: tuple[float, float]) -> float:
    """Return the step from the present point (x, value) by inverse quadratic interpolation through three points.

    If the previous and the opposite point are the same, the interpolation is linear. An undefined step is infinite.
    """
    (x0, f0), (x, f), (x1, f1) = previous, present, opposite
    if x0 == x1:
        return -f * (x - x0) / (f - f0)
    slope0, slope1 = (f0 - f) / (x0 - x), (f1 - f) / (x1 - x)
    divisor = slope1 * slope0 * (f1 - f0)
    # The product of small values can underflow.
    return -f * (f1 * slope1 - f0 * slope0) / divisor if divisor else math.inf


def bisect(
    is_beyond: Callable[[np.ndarray], np.ndarray], within: np.ndarray, beyond: np.ndarray, halvings: int
) -> tuple[np.ndarray, np.ndarray]:
    """Enclose many boundaries at once by bisection.

    Parameters
    ----------
    is_beyond
        A function that returns whether each point is beyond its boundary.
    within, beyond
        The ends of the intervals, of any shape, on the two sides of their boundaries.
    halvings
        Number of times that the intervals are halved.

    Returns
    -------
    The ends `within` and `beyond` of the last intervals.
    """
    for _ in range(halvings):
        middle = 0.5 * (within + beyond)
        mask = is_beyond(middle)
        within, beyond = np.where(mask, within, middle), np.where(mask, middle, beyond)
    return within, beyond
