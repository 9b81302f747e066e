"""Section points of orbits that enter through an exit, which show on which side of an invariant torus each exit lies."""

from __future__ import annotations

import functools

import numpy as np

from engine.exits.interior import find_outside_in_well_units
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.propagation.limited_steps import find_section_points
from engine.slices.planes import SECTION
from engine.systems.potential import Potential

# Samples of the path of a Lyapunov orbit at which orbits start: every tenth, except near its ends.
_PATH_SAMPLES = slice(10, -10, 10)
# Angles of the velocities of these orbits to the inward direction, in radians.
_VELOCITY_ANGLES = np.radians([-60.0, -30.0, 0.0, 30.0, 60.0])
# Longest time to the first crossing of the section, in units of the well.
_LONGEST_ENTRY_TIME = 30.0


@functools.lru_cache(maxsize=256)
def find_entry_points(potential: Potential, energy: float) -> tuple[np.ndarray, ...]:
    """Find where orbits that enter through each open exit first cross y = 0 upward.

    The states on one exit are connected, and a torus of bounded orbits never crosses an exit. Therefore all states on one exit
    lie on the same side of such a torus, and a single entry point shows which side.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    energy
        h in units of the well, finite.

    Returns
    -------
    For each open channel, in channel order, a read-only (n, 2) array of x and px; empty where no orbit crosses y = 0 by t = 30.

    Raises
    ------
    ValueError
        If the frame rotates, or exits are not defined at this energy.
    """
    potential.check_at_rest("entry points of exits")
    return tuple(_entry_points(potential, energy, orbit) for orbit in find_orbits_in_well_units(potential, energy))


def _entry_points(potential: Potential, energy: float, orbit: LyapunovOrbit) -> np.ndarray:
    states = _inward_states(potential, energy, orbit)
    execution = DEFAULT_EXECUTION.in_this_thread()
    points: np.ndarray = find_section_points(potential, states, 1, _LONGEST_ENTRY_TIME, execution=execution)[:, 0]
    return read_only(points[_is_interior(potential, energy, points)])


def _inward_states(potential: Potential, energy: float, orbit: LyapunovOrbit) -> np.ndarray:
    """Return states on the path of a Lyapunov orbit with inward momenta, of shape (n, 4)."""
    x, y = np.repeat(orbit.half_path[_PATH_SAMPLES], _VELOCITY_ANGLES.size, axis=0).T
    speed = np.sqrt(2.0 * np.maximum(energy - potential.value(x, y), 0.0))
    inward = -orbit.outward
    angle = np.arctan2(inward[1], inward[0]) + np.tile(_VELOCITY_ANGLES, x.size // _VELOCITY_ANGLES.size)
    return np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def _is_interior(potential: Potential, energy: float, points: np.ndarray) -> np.ndarray:
    """Return whether each point (n, 2) is allowed and inside all exits; False for NaN and for orbits that left again."""
    x, px = points.T
    with np.errstate(invalid="ignore"):
        is_allowed = SECTION.required_energy(potential, x, px) <= energy
    outside = find_outside_in_well_units(potential, energy, np.where(is_allowed, x, 0.0), np.zeros_like(x))
    return is_allowed & (outside == 0)
