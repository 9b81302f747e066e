"""The first orbit of a family that branches off another one."""

from __future__ import annotations

import numpy as np

from engine.periodic.closed_orbits import primitive_returns
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit, linearise
from engine.slices.sections.section import Section
from engine.systems.potential import Potential


def first_orbit_of_branch(
    orbit: PeriodicOrbit, neighbours: tuple[PeriodicOrbit, PeriodicOrbit], periods: int, step: float
) -> PeriodicOrbit | None:
    """Return an orbit at a distance from a special point, in a direction in which other orbits of that many periods meet it.

    None if it is not found. At the point, the equations have two null vectors: along the family and along the branch. At a
    touching point there is a third one, along another branch, which is not followed.

    Parameters
    ----------
    orbit
        The orbit at the special point.
    neighbours
        The members of its family before and after it.
    periods
        Number of periods of the family after which the orbits of the branch close.
    step
        The distance, in units of the well.
    """
    potential, section = orbit.potential.in_well_units, orbit.section.in_well_units(orbit.potential.units)
    trial = orbit.trial.repeated(periods)
    secant = _numbers(neighbours[1], periods) - _numbers(neighbours[0], periods)
    direction = _direction_of_branch(potential, section, trial, secant)
    if direction is None:
        return None
    closed = close_orbit(potential, section, trial.moved(trial.vector + step * direction), direction)
    if closed is None or (periods > 1 and primitive_returns(closed[0]) < len(closed[0].durations)):
        return None
    return PeriodicOrbit.from_trial(orbit.potential, orbit.section, closed[0])


def _numbers(orbit: PeriodicOrbit, periods: int) -> np.ndarray:
    """Return the states at the returns, the times between them and the energy of a repeated orbit, in units of the well."""
    units = orbit.potential.units
    durations = np.diff(orbit.time, append=orbit.period) / units.time
    states = (orbit.states / units.state).ravel()
    return np.concatenate([np.tile(states, periods), np.tile(durations, periods), [orbit.energy / units.energy]])


def _direction_of_branch(potential: Potential, section: Section, trial: Trial, secant: np.ndarray) -> np.ndarray | None:
    """Return the null vector of the equations of a repeated orbit that is orthogonal to its family, a unit vector."""
    equations = linearise(potential, section, trial)
    if equations is None:
        return None
    null_vectors = np.linalg.svd(equations.jacobian)[2][-2:]
    # The secant has no numbers for nodes between returns.
    is_return = np.isin(np.arange(len(trial.states)), trial.returns)
    is_in_secant = np.concatenate([np.repeat(is_return, 4), np.ones(len(trial.durations) + 1, bool)])
    shares = np.linalg.lstsq(null_vectors[:, is_in_secant].T, secant, rcond=None)[0]
    # A vector of the plane of both null vectors that is orthogonal to the family.
    across: np.ndarray = np.array([-shares[1], shares[0]]) @ null_vectors
    return across / np.linalg.norm(across)
