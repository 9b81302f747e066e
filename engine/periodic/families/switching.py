"""The orbits of other families that meet a family at a special point."""

from __future__ import annotations

import numpy as np

from engine.periodic.closed_orbits import primitive_returns
from engine.periodic.family_parameter import FamilyParameter
from engine.periodic.shooting import SINGULAR, Equations, Trial, close_orbit, crosses_section, linearise

# Directions from which branches are sought around an orbit of which all nearby orbits close.
_DIRECTIONS = 12
# Largest number of corrections of a direction, and the last correction, in steps.
_MOST_CORRECTIONS, _LAST_CORRECTION = 10, 1e-3
# Largest distance of the first orbit of a branch from the special point, and distance within which two orbits are the same, in
# steps.
_FARTHEST, _SAME = 10.0, 0.01
# Smallest share of the largest singular value that fixes an orbit.
_DETERMINED = 10.0 * SINGULAR


def first_orbits_of_branches(
    parameter: FamilyParameter, orbit: Trial, neighbours: tuple[Trial, Trial], periods: int, dimensions: int, step: float
) -> list[Trial]:
    """Return an orbit of each branch that is found at a distance from a special point.

    At the point, the equations of the repeated orbit have null vectors along the family and across it. Orbits of the branches
    are sought from places at this distance, in directions across the family.

    Parameters
    ----------
    parameter
        The parameter of the family.
    orbit
        The orbit at the special point.
    neighbours
        The members of its family before and after it.
    periods
        Number of periods of the family after which the orbits of the branches close.
    dimensions
        Number of null vectors across the family: 1, or 2 where all nearby orbits close after these periods.
    step
        The distance, in units of the well.
    """
    trial = orbit.repeated(periods)
    secant = neighbours[1].repeated(periods).numbers - neighbours[0].repeated(periods).numbers
    found: list[Trial] = []
    across = _null_vectors_across(parameter, trial, secant, dimensions)
    for direction in _directions(across, periods):
        closed = _branch_near(parameter, trial, across, step * direction)
        is_new = closed is not None and not any(_is_same(closed, known, _SAME * step) for known in found)
        if closed is not None and is_new and (periods == 1 or primitive_returns(closed) == len(closed.durations)):
            found.append(closed)
    return found


def _branch_near(parameter: FamilyParameter, trial: Trial, across: np.ndarray, offset: np.ndarray) -> Trial | None:
    """Return the orbit of a branch at the distance of an offset from an orbit, near this offset; None if it is not found.

    The corrections keep the orbit in a plane at right angles to a direction. That of the branch is found by repetition.
    """
    step = float(np.linalg.norm(offset))
    potential, section, _ = parameter.at(trial.value)
    for _ in range(_MOST_CORRECTIONS):
        shares = across @ offset
        direction = shares @ across / np.linalg.norm(shares)
        closed = close_orbit(parameter, trial.moved(trial.vector + offset), direction)
        if closed is None or not _is_determined(closed[1]) or not crosses_section(potential, section, closed[0]):
            return None
        distance = closed[0].vector - trial.vector
        if np.linalg.norm(distance) > _FARTHEST * step:
            return None
        offset = distance * (step / np.linalg.norm(across @ distance))
        if np.linalg.norm(across @ offset - shares * (step / np.linalg.norm(shares))) < _LAST_CORRECTION * step:
            return closed[0]
    return None


def _is_determined(equations: Equations) -> bool:
    """Return whether the equations have one null vector only, along the family of a closed orbit.

    Very near a resonance m : n with a large n, all orbits around the orbit close within rounding errors.
    """
    singular_values = np.linalg.svd(equations.jacobian)[1]
    return bool(singular_values[-2] > _DETERMINED * singular_values[0])


def _is_same(orbit: Trial, other: Trial, distance: float) -> bool:
    """Return whether the returns of two orbits are within a distance, from whichever they are counted."""
    states, others = orbit.states[orbit.returns], other.states[other.returns]
    return any(bool(np.abs(states - np.roll(others, k, axis=0)).max() < distance) for k in range(len(states)))


def _null_vectors_across(parameter: FamilyParameter, trial: Trial, secant: np.ndarray, dimensions: int) -> np.ndarray:
    """Return null vectors of the equations that are orthogonal to each other and to the family; none without equations."""
    equations = linearise(parameter, trial)
    if equations is None:
        return np.empty((0, trial.vector.size))
    null_vectors = np.linalg.svd(equations.jacobian)[2][-1 - dimensions :]
    # The secant has no numbers for nodes between returns.
    shares = np.linalg.lstsq(null_vectors[:, trial.is_of_returns].T, secant, rcond=None)[0]
    return np.linalg.svd(shares[None])[2][1:] @ null_vectors


def _directions(across: np.ndarray, periods: int) -> np.ndarray:
    """Return unit vectors in which branches are sought: both directions of one vector, or directions in the plane of two.

    To count the same orbit from another return rotates the plane by a multiple of 2π / periods. This angle is covered.
    """
    if len(across) < 2:
        return np.vstack([across, -across])
    angles = np.arange(_DIRECTIONS) * (2.0 * np.pi / (periods * _DIRECTIONS))
    return np.column_stack([np.cos(angles), np.sin(angles)]) @ across
