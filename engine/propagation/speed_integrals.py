"""Integrals of a power of the speed along many orbits."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_shapes import exit_gates
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.source.recurrence import ROWS, TIME_ROW, TOLERANCE
from engine.propagation.tiles import map_tiles
from engine.systems.potential import Potential

# Number of tiles that a worker computes in one call. A call takes less than 0.1 s, so cancellation takes effect soon.
_TILES_PER_TASK = 8
# Number of integrator steps of a tile in one call, which takes some milliseconds.
_STEPS_PER_TILE = 100


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
        (energies, outcomes, columns) exits, see `exit_curves`.
    states
        (n, 4) x, y, px, py inside the exits, finite.
    curve_row
        (n,) the row of `curves` of each orbit.
    duration
        Largest duration of an orbit, above 0, dimensionless.
    power
        Exponent of the speed, above 0.
    execution
        How the computation runs. When it is cancelled, orbits not processed yet get NaN.

    Returns
    -------
    (n,) the integrals; NaN for orbits whose steps become too short.
    """
    gates = exit_gates(curves)
    curve_column = np.asarray(curve_row)[:, None]
    # For each orbit: its rows for the kernel, and its integral so far. The time of an orbit that has ended is infinite.
    orbits = np.column_stack([states, np.zeros((len(states), ROWS + 1 - states.shape[1]))])
    pending = np.arange(len(orbits))
    while pending.size:
        pending_orbits = np.column_stack([orbits[pending], curve_column[pending]])
        orbits[pending] = map_tiles(
            _integrate_tile, potential, pending_orbits, curves, gates, duration, power,
            shape=(ROWS + 1,), execution=execution, tiles_per_task=_TILES_PER_TASK,
        )  # fmt: skip
        if execution.is_cancelled:
            orbits[pending[~np.isposinf(orbits[pending, TIME_ROW])], -1] = np.nan
            break
        pending = pending[np.isfinite(orbits[pending, TIME_ROW])]
    return orbits[:, -1]


def _integrate_tile(
    potential: Potential, tile: np.ndarray, curves: np.ndarray, gates: np.ndarray, duration: float, power: float
) -> np.ndarray:
    """Return orbits and their integrals after some steps, of shape (lanes, ROWS + 1); called in a worker.

    `tile`, (ROWS + 2, lanes), holds the `ROWS` rows of the orbits, their integrals so far, and their rows of `curves`.
    """
    orbits, integral, curve_row = tile[:ROWS].copy(), tile[ROWS].copy(), tile[ROWS + 1].astype(np.int64)
    # The kernel changes the orbits and their integrals in place.
    with np.errstate(invalid="ignore"):
        potential.well.kernels.integrate_speed(
            TOLERANCE, duration, power, _STEPS_PER_TILE, gates, curves, curve_row, orbits, integral
        )
    return np.column_stack([orbits.T, integral])
