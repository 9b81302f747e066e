"""Roots of functions of one variable, and bisection of many intervals at once."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

_MOST_STEPS = 100


def find_root(function: Callable[[float], float], low: float, high: float, *, absolute: float, relative: float) -> float:
    """Find a root by Brent's method (Brent 1973, Algorithms for Minimization without Derivatives, chapter 4).

    The steps are those of `scipy.optimize.brentq`, which is not used because its import takes longer than a search.

    Parameters
    ----------
    function
        Continuous function.
    low, high
        The ends of the bracket; the function has different signs there.
    absolute, relative
        The root is within ``absolute + relative * abs(root)`` of a change of sign.

    Returns
    -------
    The root. After 100 steps, more than a continuous function needs, the last point.

    Raises
    ------
    ValueError
        If the function has the same sign at both ends, or is NaN at a point where it is evaluated.
    """

    def checked(x: float) -> float:
        found = function(x)
        if math.isnan(found):
            raise ValueError(f"bracket=({low}, {high}): the function is NaN at {x}")
        return found

    before, here = low, high
    value_before, value = checked(before), checked(here)
    if value_before * value > 0.0:
        raise ValueError(f"bracket=({low}, {high}): the function must have different signs at its ends")
    # The root lies between `here` and `across`.
    across, value_across = before, value_before
    last_step = step = here - before
    for _ in range(_MOST_STEPS):
        if value_before and value and (value_before < 0.0) != (value < 0.0):
            across, value_across = before, value_before
            last_step = step = here - before
        if abs(value_across) < abs(value):
            before, here, across = here, across, here
            value_before, value, value_across = value, value_across, value
        tolerance = (absolute + relative * abs(here)) / 2.0
        half = (across - here) / 2.0
        if value == 0.0 or abs(half) < tolerance:
            return here
        trial = math.inf
        if abs(last_step) > tolerance and abs(value) < abs(value_before):
            trial = _interpolate((before, value_before), (here, value), (across, value_across))
        # Interpolate only if the steps shrink fast enough; otherwise bisect.
        if 2.0 * abs(trial) < min(abs(last_step), 3.0 * abs(half) - tolerance):
            last_step, step = step, trial
        else:
            last_step = step = half
        before, value_before = here, value
        here += step if abs(step) > tolerance else math.copysign(tolerance, half)
        value = checked(here)
    return here


def _interpolate(before: tuple[float, float], here: tuple[float, float], across: tuple[float, float]) -> float:
    """Return the step from `here` by linear interpolation, or by inverse quadratic interpolation if all three points differ.

    An undefined step is infinite.
    """
    (x0, f0), (x, f), (x1, f1) = before, here, across
    if x0 == x1:
        return -f * (x - x0) / (f - f0)
    slope_before, slope_across = (f0 - f) / (x0 - x), (f1 - f) / (x1 - x)
    divisor = slope_across * slope_before * (f1 - f0)
    # The product of small values can underflow.
    return -f * (f1 * slope_across - f0 * slope_before) / divisor if divisor else math.inf


def bisect(
    is_beyond: Callable[[np.ndarray], np.ndarray], within: np.ndarray, beyond: np.ndarray, halvings: int
) -> tuple[np.ndarray, np.ndarray]:
    """Enclose many boundaries at once by halving intervals.

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
        past = is_beyond(middle)
        within, beyond = np.where(past, within, middle), np.where(past, middle, beyond)
    return within, beyond
