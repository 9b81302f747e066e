"""Whether orbits can leave a well for infinity without passing an exit: at this energy its exits do not define who escapes.

With the exits as barriers, the region of motion around the origin must be bounded (`engine.systems.landscape.hill_component`). A
potential can have a channel to infinity that no saddle closes: two wells below V(∞), or a bond that breaks.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.forms.stored_points import stored_points
from engine.systems.landscape.hill_component import Barrier
from engine.systems.potential import Potential

# Largest |s| of a barrier. The straight lines beyond the ends of an exit continue it through the forbidden region.
_FARTHEST_POSITION = 1.25


def leads_to_infinity(potential: Potential, energy: float, orbits: Sequence[LyapunovOrbit]) -> bool:
    """Return whether the region of motion is unbounded inside the exits over these orbits, in units of the well."""
    curves = [orbit.curve for orbit in orbits]

    def find() -> np.ndarray:
        return np.array(potential.well.component_search.is_open(energy, [_exit_barrier(curve) for curve in curves]))

    return bool(stored_points("open_well", (potential.form, energy, [curve.tolist() for curve in curves]), find))


def _exit_barrier(curve: np.ndarray) -> Barrier:
    """Return the barrier along an exit, given by its row."""
    farthest = min(float(curve[geometry.REACH]), _FARTHEST_POSITION)

    def locate(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        distance, position = np.empty(x.size), np.empty(x.size)
        # The kernel writes distances and positions.
        geometry.locate_points(curve, x.ravel(), y.ravel(), distance, position)
        return distance.reshape(x.shape), position.reshape(x.shape) / farthest

    return Barrier(locate)
