"""Continuation of a solution along a parameter."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple


class StepLimits(NamedTuple):
    """Limits of a continuation: the first and the smallest step of the parameter, and the largest number of attempted steps."""

    first: float
    smallest: float
    attempts: int


def follow[Solution](
    advance: Callable[[Solution, float], Solution | None], solution: Solution, begin: float, end: float, limits: StepLimits
) -> Solution | None:
    """Follow a solution from one value of a parameter up to another with an adaptive step.

    Parameters
    ----------
    advance
        A function of the last solution and of a new value. It returns the solution at the new value, or None if it finds none
        close to the last solution. After None the step is halved; after a solution it is doubled.
    solution
        The solution at `begin`.
    begin, end
        The first and the last value.
    limits
        Limits of the steps.

    Returns
    -------
    The solution at `end`; None if the limits do not suffice to reach `end`.
    """
    reached, step = begin, limits.first
    for _ in range(limits.attempts):
        target = min(reached + step, end)
        next_solution = advance(solution, target)
        if next_solution is not None:
            solution, reached, step = next_solution, target, 2.0 * step
            if reached == end:
                return solution
        elif step > limits.smallest:
            step *= 0.5
        else:
            return None
    return None
