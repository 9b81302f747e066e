"""Integrals of a power of the speed along many orbits."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_rows import exit_gates
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.source.recurrence import TOLERANCE
from engine.propagation.fixed_step_batches import map_tiles
from engine.systems.compiled import kernels_of
from engine.systems.potential import Potential

# A tile takes some milliseconds.
_TILES_PER_TASK = 8


def integrate_speed(
    potential: Potential,
    curves: np.ndarray,
    states: np.ndarray,
    curve_row: np.ndarray,
    duration: float,
    power: float,
    *,
    execution: Execution = DEFAULT_EXECUTION,
) -> np.ndarray:
    """Integrate |v|^power over time along orbits, each up to a duration or until it crosses an exit.

    The result of each orbit is bit-identical for every executor. All quantities are in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well.
    curves
        (energies, exits, columns) exit curves, see `exit_curves`.
    states
        (n, 4) x, y, px, py inside the exits, finite.
    curve_row
        (n,) the row of `curves` of each orbit.
    duration
        Above 0, dimensionless.
    power
        Exponent of the speed, above 0.
    execution
        How the computation runs. When it is cancelled, orbits not processed yet get NaN.

    Returns
    -------
    (n,) the integrals; NaN for orbits whose steps become too short.
    """
    orbits, gates = np.column_stack([states, curve_row]), exit_gates(curves)
    return map_tiles(
        _integrate_tile, potential, orbits, curves, gates, duration, power, execution=execution, tiles_per_task=_TILES_PER_TASK
    )


def _integrate_tile(
    potential: Potential, tile: np.ndarray, curves: np.ndarray, gates: np.ndarray, duration: float, power: float
) -> np.ndarray:
    """(lanes,) integrals of a tile (5, lanes) of states and rows of curves; runs in a worker."""
    integral = np.zeros(tile.shape[1])
    curve_row = tile[4].astype(np.int64)
    with np.errstate(invalid="ignore"):
        kernels_of(potential).integrate_speed(TOLERANCE, duration, power, gates, curves, curve_row, tile[:4].copy(), integral)
    return integral
