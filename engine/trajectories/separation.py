"""Distance of two orbits in phase space against time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.result import Chart, RecordedResult
from engine.foundations.validation import checked_state, checks_types
from engine.integrator.kernels.dense_output import sample_path, trace_steps
from engine.systems.potential import Potential
from engine.systems.well_units import LENGTH, TIME

LONGEST_SEPARATION = 2000.0
"""Longest time over which two orbits are compared, in units of the well. Neighbours in a chaotic sea separate much earlier."""

# Number of times at which the distance is computed.
_SAMPLES = 2000


@dataclass(frozen=True, eq=False, repr=False)
class Separation(RecordedResult):
    """Distance of two orbits against time, dimensionless; arrays are read-only.

    Attributes
    ----------
    t
        (n,) times, evenly spaced, from 0.
    distance
        (n,) √(Δx² + Δy² + Δpx² + Δpy²), with momenta in units in which the unit of time of the well is 1; 0 where both states are
        exactly equal.
    """

    t: np.ndarray = field(metadata=TIME)
    distance: np.ndarray = field(metadata=LENGTH)
    chart: ClassVar = Chart("t", "distance", "t", "distance", logarithmic="y")


@checks_types(potential=Potential, execution=Execution)
def compute_separation(
    potential: Potential, first: Any, second: Any, t_max: float, *, execution: Execution = DEFAULT_EXECUTION
) -> Separation:
    """Compute the distance of two orbits at 2000 evenly spaced times.

    Each orbit is integrated on its own, and its dense output gives the states at common times. Small distances are therefore
    accurate to the rounding of the states, about 1e-16.

    Parameters
    ----------
    potential
        The `Potential`.
    first, second
        (4,) initial x, y, px, py; finite, dimensionless.
    t_max
        Last time, 0 < t_max ≤ 1e8, dimensionless; not after the escape of either orbit. A time above 2000 units of the well is
        reduced to 2000.
    execution
        How the computation runs.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If a state is not four finite numbers or `t_max` is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, compute_separation
    >>> first, second = (0.1, 0.0, 0.05, 0.6), (0.1 + 1e-9, 0.0, 0.05, 0.6)
    >>> distance = compute_separation(CASES["I"], first, second, t_max=15.0).distance
    >>> distance.size, round(float(distance[-1] / distance[0]))
    (2000, 235)
    """
    t_max = potential.checked_t_max(t_max)
    units = potential.units
    times = np.linspace(0.0, min(t_max / units.time, LONGEST_SEPARATION), _SAMPLES)
    kernels = potential.in_well_units.well.kernels
    paths = []
    for name, state in (("first", first), ("second", second)):
        start = checked_state(name, state) / units.state
        steps = trace_steps(kernels, start, float(times[-1]), len(potential.outcomes), execution)
        paths.append(sample_path(kernels, steps, times, execution))
    made_by = potential.describe_run(energy=float(potential.energy(first)))
    return units.restore(Separation(times, np.linalg.norm(paths[1] - paths[0], axis=0), made_by=made_by))
