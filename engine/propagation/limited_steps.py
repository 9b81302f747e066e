"""Many orbits without exits: their crossings of the surface of section, and their SALI from deviation vectors."""

from __future__ import annotations

import math

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.source.recurrence import TOLERANCE
from engine.propagation.fates import CHAOS_THRESHOLD
from engine.propagation.tiles import map_tiles
from engine.systems.potential import Potential

LOOSE_TOLERANCE = 10.0 * TOLERANCE
"""Tolerance of the steps of many orbits without exits; energies are conserved to 1e-11."""

ENERGY_TOLERANCE = 1e-9
"""Largest change of the energy along an orbit that is judged, relative to its energy above the bottom, or to the unit if that is
more.
"""

DEVIATION_VECTORS = read_only(np.array([[1.0, 2.0, 3.0, 4.0], [4.0, -3.0, 2.0, -1.0]]) / np.sqrt(30.0))
"""The initial deviation vectors, (2, 4), the same for all orbits, so that the SALI of an orbit is reproducible.

They are orthonormal, and no symmetry of a potential confines them to a subspace.
"""

# Number of intervals of Birkhoff averages between samples of SALI.
_SALI_INTERVALS = 8
# Rounding error of an energy, relative to its magnitude; it matters for a well on top of a large constant.
_ROUNDING = 1e-15
# Largest mean number of steps per unit of time. Orbits need about 3, and ten times as many far above the escape energy.
_MOST_STEPS_PER_TIME = 1000.0


def step_budget(duration: float) -> int:
    """Return the largest number of steps that an orbit may take in a time, above 0, in units of the well."""
    return math.ceil(_MOST_STEPS_PER_TIME * max(duration, 1.0))


def is_energy_conserved(potential: Potential, states: np.ndarray, energies: np.ndarray) -> np.ndarray:
    """Return whether states (n, 4) have the energies (n,) to within `ENERGY_TOLERANCE`; False for states that are not finite."""
    with np.errstate(all="ignore"):
        difference = np.abs(potential.energy(states) - energies)
        scale = np.maximum(energies - potential.well.bottom, 1.0)
        return difference <= ENERGY_TOLERANCE * scale + _ROUNDING * np.abs(energies)


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
    """Integrate orbits with their deviation vectors, and update their smallest SALI (Zotos 2014, eq. 9).

    An orbit whose SALI falls to `CHAOS_THRESHOLD` stops there.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    orbits
        (n, 13) as returned by `attach_deviations`.
    duration
        Integration time, above 0, dimensionless.
    execution
        How the computation runs. When it is cancelled, orbits not processed yet get NaN.

    Returns
    -------
    The orbits, (n, 13). The smallest SALI is NaN for an orbit that runs to infinity or takes too many steps.
    """
    return map_tiles(_propagate_tile, potential, orbits, duration, shape=orbits.shape[1:], execution=execution)


def _propagate_tile(potential: Potential, tile: np.ndarray, duration: float) -> np.ndarray:
    """Integrate the orbits of a tile (13, lanes) over a time, in place, and return them, of shape (lanes, 13)."""
    samples = math.ceil(duration / (_SALI_INTERVALS * potential.well.sample_interval))
    limits = LOOSE_TOLERANCE, duration / samples, samples, CHAOS_THRESHOLD, step_budget(duration)
    with np.errstate(all="ignore"):
        potential.well.kernels.follow_deviations(*limits, tile)
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
    limits = LOOSE_TOLERANCE, duration, step_budget(duration)
    # The kernel writes the points of each orbit and their number.
    potential.well.kernels.find_section_points(*limits, tile, points, counts)
    return points[..., :2]
