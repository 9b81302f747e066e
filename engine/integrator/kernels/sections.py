"""The surface of section at which crossings are counted, for events within a step.

A section is an array of rows (rows, 3), see `engine.integrator.source.section_numbers.NAMES`; without rows, it is y = 0,
crossed upward. In the gates of the exits, these rows follow those of the exits.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import subroutine
from engine.integrator.source.section_numbers import COLUMNS, ROUNDING

UPWARD = np.empty((0, COLUMNS))
"""The section y = 0, crossed upward."""


@subroutine
def counts_falls(section):
    """Return whether crossings from positive to other values of the form count as well."""
    return section.shape[0] > 0 and section[3, 0] > 0.0


@subroutine
def is_on_side(x, y, section):
    """Return whether a point of the section is on the side on which crossings count."""
    return section.shape[0] == 0 or section[2, 0] * x + section[2, 1] * y >= section[2, 2]


@subroutine
def section_series(x_jet, y_jet, i, section, work):
    """Return an array whose column i is the series of the form in a step: `work`, or `y_jet` for the section y = 0, upward.

    x_jet, y_jet, work (order + 1, n): series of x and y, and an array that may be overwritten.
    """
    if section.shape[0] == 0:
        return y_jet
    order = x_jet.shape[0] - 1
    for k in range(order + 1):
        work[k, i] = section[0, 0] * x_jet[k, i] + section[0, 1] * y_jet[k, i]
    for k in range(order):
        slope = section[0, 2] * x_jet[k + 1, i] + section[1, 0] * y_jet[k + 1, i]
        if section[1, 1] != 0.0:
            # x px + y py is half the derivative of x² + y².
            square = 0.0
            for j in range(k + 2):
                square += x_jet[j, i] * x_jet[k + 1 - j, i] + y_jet[j, i] * y_jet[k + 1 - j, i]
            slope += section[1, 1] * (0.5 * square)
        work[k, i] += (k + 1.0) * slope
    work[0, i] -= section[1, 2]
    # As in the step, a form that is smaller than its rounding errors is 0.
    size = abs(section[0, 0] * x_jet[0, i]) + abs(section[0, 1] * y_jet[0, i]) + abs(section[1, 2])
    size += abs(section[0, 2] * x_jet[1, i]) + abs(section[1, 0] * y_jet[1, i])
    size += abs(section[1, 1]) * (abs(x_jet[0, i] * x_jet[1, i]) + abs(y_jet[0, i] * y_jet[1, i]))
    if abs(work[0, i]) <= ROUNDING * size:
        work[0, i] = 0.0
    return work
