"""The outcome and the steps of one orbit, integrated as in maps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.exits.exit_rows import exit_gates
from engine.foundations.execution import Execution
from engine.integrator.kernels.dense_output import trace_orbit
from engine.integrator.kernels.propagate import Exits
from engine.propagation.batch import OrbitBatch
from engine.propagation.classification import Outcomes, collect_outcomes
from engine.propagation.fates import Fate
from engine.systems.potential import Potential


@dataclass(frozen=True, eq=False)
class OrbitSteps:
    """An orbit in units of the well.

    Attributes
    ----------
    outcomes
        The `Outcomes` of this orbit, equal to the bit to those in a map.
    steps
        (m, 5) x, y, px, py, t at the start of each step; (0, 5) for a start outside.
    t_end
        Time of the escape, or t_max; 0 for a start outside.
    """

    outcomes: Outcomes
    steps: np.ndarray
    t_end: float


def record_orbit(potential: Potential, start: np.ndarray, curves: np.ndarray, t_max: float, execution: Execution) -> OrbitSteps:
    """Integrate one orbit until it escapes or reaches `t_max`, and keep its steps; all quantities are in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    start
        (4,) x, y, px, py.
    curves
        (channels, columns) exit curves at the energy of the start, see `exit_curves`.
    t_max
        Largest integration time, above 0, dimensionless.
    execution
        How to cancel the computation. The orbit is integrated in this thread.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    """
    # A batch of one orbit, and exit curves of one energy.
    batch = OrbitBatch.from_starts(start[None], np.zeros(1, np.int64))
    curve_rows = curves[None]
    batch.mark_outside(potential, np.arange(1), curve_rows, execution=execution.in_this_thread())
    pending = (batch.fate == Fate.NOT_COMPUTED).astype(np.uint8)
    orbits = batch.for_kernels(pending)
    exits = Exits(exit_gates(curve_rows), curve_rows, batch.curve_row)
    pieces = list(trace_orbit(potential.well.kernels, exits, orbits, t_max, execution))
    execution.raise_if_cancelled()
    outcomes = collect_outcomes(potential, potential.energy(start[None]), batch)
    if not pieces:
        return OrbitSteps(outcomes, np.empty((0, 5)), 0.0)
    return OrbitSteps(outcomes, np.concatenate([steps for steps, _ in pieces]), pieces[-1][1])
