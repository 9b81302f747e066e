"""The first orbit of a family that branches off another one."""

from __future__ import annotations

import numpy as np

from engine.periodic.closed_orbits import primitive_returns
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit, linearise
from engine.slices.sections.section import Section
from engine.systems.potential import Potential

# Smallest sine of the angle between a branch and its family.
_SMALLEST_ANGLE = 1e-3


def first_orbit_of_branch(orbit: PeriodicOrbit, periods: int, step: float) -> PeriodicOrbit | None:
    """Return an orbit at a distance from a special point, in a direction in which other orbits of that many periods meet it.

    None if it is not found. At the point, the equations have two null vectors: along the family and along the branch.
    """
    potential, section = orbit.potential.in_well_units, orbit.section.in_well_units(orbit.potential.units)
    once = orbit.trial
    direction = _direction_of_branch(potential, section, once, periods)
    if direction is None:
        return None
    trial = once.repeated(periods)
    closed = close_orbit(potential, section, trial.moved(trial.vector + step * direction), direction)
    if closed is None or (periods > 1 and primitive_returns(closed[0]) < len(closed[0].durations)):
        return None
    return PeriodicOrbit.from_trial(orbit.potential, orbit.section, closed[0])


def _direction_of_branch(potential: Potential, section: Section, once: Trial, periods: int) -> np.ndarray | None:
    """Return the null vector of the equations of a repeated orbit that is orthogonal to its family."""
    equations = linearise(potential, section, once)
    repeated = linearise(potential, section, once.repeated(periods))
    if equations is None or repeated is None:
        return None
    null_vectors = np.linalg.svd(repeated.jacobian)[2][-2:]
    along = _repeated_direction(once, np.linalg.svd(equations.jacobian)[2][-1], periods)
    across = null_vectors - np.outer(null_vectors @ along, along)
    lengths = np.linalg.norm(across, axis=1)
    best: np.ndarray = across[np.argmax(lengths)]
    return None if lengths.max() < _SMALLEST_ANGLE else best / lengths.max()


def _repeated_direction(once: Trial, direction: np.ndarray, periods: int) -> np.ndarray:
    """Return a direction of the unknowns of an orbit as one of the unknowns of the repeated orbit, a unit vector."""
    moved = once.moved(direction)
    along = moved.repeated(periods).vector
    return along / np.linalg.norm(along)
