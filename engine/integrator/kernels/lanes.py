"""Lanes of orbits that step together: their arrays, the number of lanes in whole vectors, and orbits that end.

A kernel steps its first active lanes, in a loop that runs downward over the lanes, because the last active lane replaces a lane
whose orbit has ended. Each kernel has a loop of its own, because kernels differ in the step, in what they do with it, and in what
a lane holds. A common loop would need a tuple of arrays and three functions for each kernel, which take more lines than the loop.
"""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import subroutine
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW

VECTOR = 8
"""The number of active lanes is rounded up to a multiple of this, so that no lane is in the scalar remainder of a loop."""


@subroutine
def fill_vectors(count):
    """Return the number of lanes of the whole vectors that hold `count` orbits."""
    return (count + VECTOR - 1) // VECTOR * VECTOR


@subroutine
def fill_lanes(orbits):
    """Return lanes at the start and at the end of a step, and the orbit of each lane, for n orbits (rows, n), n up to `LANES`."""
    now, new, lane_orbit = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros(LANES, np.int64)
    # The elements are copied one by one, because for `now[:4] = orbits` Numba also compiles an error message, which takes 2 s.
    for i in range(orbits.shape[1]):
        for row in range(orbits.shape[0]):
            now[row, i] = orbits[row, i]
        lane_orbit[i] = i
    return now, new, lane_orbit


@subroutine
def move_lane(lanes, source, target, lane_orbit):
    """Copy the orbit of lane `source` of the (ROWS, LANES) array `lanes` to lane `target`."""
    for row in range(ROWS):
        lanes[row, target] = lanes[row, source]
    lane_orbit[target] = lane_orbit[source]


@subroutine
def has_failed(new, i):
    """Return whether the step of lane i has not led to a finite position at a later time."""
    return not (np.isfinite(new[0, i]) and np.isfinite(new[1, i]) and new[SIZE_ROW, i] > 0.0)
