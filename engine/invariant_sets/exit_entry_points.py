"""Where orbits that come in through an exit first pierce the section y = 0: proof of which side of a torus the exits are on."""

from __future__ import annotations

import functools

import numpy as np

from engine.dynamics.lyapunov_orbits import LyapunovOrbit, channel_axes, find_lyapunov_orbits, find_outside_exits
from engine.dynamics.planes import Plane, required_energy
from engine.dynamics.section_points import find_section_points
from engine.execution import SerialExecutor
from engine.potentials.potential import Potential

# Starts over each exit: positions along the Lyapunov orbit, its ends left out, and directions about straight inward.
_POSITIONS = slice(10, -10, 10)
_ANGLES = np.radians([-60.0, -30.0, 0.0, 30.0, 60.0])
_LONGEST_WAY = 30.0


@functools.lru_cache(maxsize=256)
def find_entry_points(potential: Potential, energy: float) -> tuple[np.ndarray, ...]:
    """For each open channel the (n, 2) points x, px at which orbits that start over its exit, inward, first cross y = 0 upward.

    All states over one exit lie on one side of any torus of bounded orbits: such a torus never crosses the exit, and the states
    over it are connected. So one entry point tells on which side of the torus that exit lies.

    Returns
    -------
    In channel order; an array is empty where no start crosses y = 0 soon.
    """
    return tuple(_entries(potential, energy, orbit) for orbit in find_lyapunov_orbits(potential, energy))


def _entries(potential: Potential, energy: float, orbit: LyapunovOrbit) -> np.ndarray:
    x, y = np.repeat(orbit.half_path[_POSITIONS], _ANGLES.size, axis=0).T
    speed = np.sqrt(2.0 * np.maximum(energy - potential.value(x, y), 0.0))
    inward = -channel_axes(potential, orbit.channel)
    angle = np.arctan2(inward[1], inward[0]) + np.tile(_ANGLES, x.size // _ANGLES.size)
    states = np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])
    points: np.ndarray = find_section_points(potential, states, 1, _LONGEST_WAY, executor=SerialExecutor())[:, 0]
    points = points[_inside(potential, energy, points)]
    points.flags.writeable = False
    return points


def _inside(potential: Potential, energy: float, points: np.ndarray) -> np.ndarray:
    """Which points are real and within all exits; an orbit that has left again is followed by nobody."""
    x, px = points.T
    with np.errstate(invalid="ignore"):
        possible = required_energy(potential, Plane.X_PX, x, px) <= energy
    outside = find_outside_exits(potential, energy, np.where(possible, x, 0.0), np.zeros_like(x))
    inside: np.ndarray = possible & (outside == 0)
    return inside
