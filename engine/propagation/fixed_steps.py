"""Many orbits with fixed steps: their crossings of the surface of section, and their SALI from deviation vectors."""

from __future__ import annotations

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.propagation.tiles import map_tiles
from engine.systems.potential import Potential

DEVIATION_VECTORS = read_only(np.array([[1.0, 2.0, 3.0, 4.0], [4.0, -3.0, 2.0, -1.0]]) / np.sqrt(30.0))
"""The initial deviation vectors, (2, 4), the same for all orbits, so that the SALI of an orbit is reproducible.

They are orthonormal, and no symmetry of a potential confines them to a subspace.
"""


def attach_deviations(states: np.ndarray) -> np.ndarray:
    """Return n states (n, 4), each with the initial deviation vectors and infinity as the smallest SALI, of shape (n, 13)."""
    vectors = np.broadcast_to(DEVIATION_VECTORS.ravel(), (len(states), DEVIATION_VECTORS.size))
    return np.column_stack([states, vectors, np.full(len(states), np.inf)])


def propagate_deviations(
    potential: Potential,
    orbits: np.ndarray,
    duration: float,
    *,
    execution: Execution = DEFAULT_EXECUTION,
) -> np.ndarray:
    """Integrate orbits with their deviation vectors at a fixed step, and update their smallest SALI (Zotos 2014, eq. 9).

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    orbits
        (n, 13) as returned by `attach_deviations`.
    duration
        Integration time, dimensionless, rounded to a number of steps, at least one.
    execution
        How the computation runs. When it is cancelled, orbits not processed yet get NaN.

    Returns
    -------
    The orbits, (n, 13). The smallest SALI of an orbit no longer changes once its coordinates have become infinite.
    """
    steps = max(1, round(duration / potential.well.fixed_step))
    return map_tiles(_propagate_tile, potential, orbits, steps, shape=orbits.shape[1:], execution=execution)


def _propagate_tile(potential: Potential, tile: np.ndarray, steps: int) -> np.ndarray:
    """Integrate the orbits of a tile (13, lanes) by some steps, in place, and return them, of shape (lanes, 13)."""
    with np.errstate(invalid="ignore"):
        potential.well.kernels.fixed_step_sali(potential.well.fixed_step, steps, tile[:4], tile[4:8], tile[8:12], tile[12])
    return tile.T


def find_section_points(
    potential: Potential,
    states: np.ndarray,
    count: int,
    duration: float,
    *,
    execution: Execution = DEFAULT_EXECUTION,
) -> np.ndarray:
    """Find the first `count` upward crossings of y = 0 of each orbit, not counting the start.

    Exits are not detected: after an orbit has escaped, its points are missing or meaningless.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    states
        (n, 4) x, y, px, py, finite.
    count
        Largest number of points per orbit, at least 1.
    duration
        Integration time, dimensionless.
    execution
        How the computation runs. When it is cancelled, the points of orbits not yet computed stay NaN.

    Returns
    -------
    (n, count, 2) x and px; NaN for points that were not found.
    """
    return map_tiles(trace_section_points, potential, states, count, duration, shape=(count, 2), execution=execution)


def trace_section_points(potential: Potential, tile: np.ndarray, count: int, duration: float) -> np.ndarray:
    """Apply `find_section_points` to a tile (4, lanes) of whole SIMD vectors, which is changed; called in a worker."""
    # x, px and time of each point.
    points = np.full((tile.shape[1], count, 3), np.nan)
    counts = np.zeros(tile.shape[1], np.int64)
    steps = int(np.ceil(duration / potential.well.fixed_step))
    # The kernel writes the points of each orbit and their number.
    potential.well.kernels.find_section_points(potential.well.fixed_step, steps, tile, points, counts)
    return points[..., :2]
