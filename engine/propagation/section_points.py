"""Crossings of the surface of section y = 0, py > 0, by fixed-step integration."""

from __future__ import annotations

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.propagation.fixed_step_batches import map_tiles
from engine.systems.potential import Potential


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
        The `Potential`.
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
