"""How two orbits part: their distance in phase space against time."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.compiled import kernels_of, step_tolerance
from engine.potentials.potential import Potential
from engine.taylor.kernels.dense_output import sample_path, trace_steps
from engine.validation import read_state, read_t_max

LONGEST_SEPARATION = 2000.0
"""Neighbours in a chaotic sea are as far apart as they can be long before."""

SAMPLES = 2000


@dataclass(frozen=True, eq=False)
class Separation:
    """The distance of two orbits, dimensionless; arrays share one length.

    Attributes
    ----------
    t
        (n,) times, evenly spaced from 0.
    distance
        (n,) √(Δx² + Δy² + Δpx² + Δpy²); 0 while they agree to the last digit.
    """

    t: np.ndarray
    distance: np.ndarray

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return self.t.nbytes + self.distance.nbytes


def compute_separation(
    potential: Potential, first: Any, second: Any, t_end: float, *, cancel: threading.Event | None = None
) -> Separation:
    """Follow two orbits together.

    Both come from the dense output of their own steps at the same times, so that the distance is good to the rounding of
    the states, some 1e-16, while it is small.

    Parameters
    ----------
    potential
        The `Potential`.
    first, second
        (4,) x, y, px, py; finite, dimensionless.
    t_end
        Until when, 0 < t_end ≤ 1e8; not beyond the escape of either, and at most `LONGEST_SEPARATION` of it is followed.
    cancel
        When set, the work stops within about 0.1 s.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a state is not four finite numbers, or `t_end` is out of its range.
    """
    times = np.linspace(0.0, min(read_t_max(t_end), LONGEST_SEPARATION), SAMPLES)
    kernels = kernels_of(potential)
    paths = []
    for name, state in (("first", first), ("second", second)):
        start = read_state(name, state)
        steps = trace_steps(kernels, start, float(times[-1]), potential.channels, cancel, step_tolerance(potential))
        paths.append(sample_path(kernels, steps, times, cancel))
    distance = np.linalg.norm(paths[1] - paths[0], axis=0)
    for array in (times, distance):
        array.flags.writeable = False
    return Separation(times, distance)
