"""Compiling ahead of time, so that nobody waits for it later."""

from __future__ import annotations

import numpy as np

from engine.dynamics.compiled import kernels_of
from engine.dynamics.lyapunov_orbits import find_lyapunov_orbits
from engine.dynamics.planes import Plane, start_states
from engine.dynamics.section_points import find_section_points
from engine.invariant_sets.birkhoff_averages import count_agreeing_digits
from engine.invariant_sets.stable_manifolds import find_stable_manifolds
from engine.maps.compute import compute_map
from engine.maps.regularity import compute_regularity
from engine.maps.spec import MapSpec
from engine.potentials.potential import Potential
from engine.trajectories.trajectory import integrate_orbit

_SHORT = 10.0


# What the first picture of a map, and the exits that it needs, are computed by.
_FOR_MAPS = ("step", "jets", "potential_value", "propagate", "shoot")


def is_ready_for_maps(potential: Potential) -> bool:
    """Whether a map can begin at once: nothing needs to be compiled, as for other coefficients of a potential computed before."""
    kernels = kernels_of(potential)
    return all(getattr(kernels, name).signatures for name in _FOR_MAPS)


def prepare_for_maps(potential: Potential) -> None:
    """Compile what the first picture of a map needs, or load it from the cache.

    Parameters
    ----------
    potential
        Any `Potential` with an exit; a structure not met before takes some seconds.
    """
    if is_ready_for_maps(potential):
        return
    find_lyapunov_orbits(potential, 1.01 * potential.escape_energy)
    compute_map(MapSpec(potential, Plane.X_PX, 1.01 * potential.escape_energy, (2, 2), t_max=_SHORT))


def prepare_kernels(potential: Potential) -> None:
    """Compile every kernel of a potential, or load it from the cache, by running it once on next to nothing.

    Parameters
    ----------
    potential
        Any `Potential` with a saddle; the first time on a machine this takes some seconds.
    """
    prepare_for_maps(potential)
    find_stable_manifolds(potential, 1.01 * potential.escape_energy, 1)
    # Nothing leaves, so that there are bounded orbits to judge.
    energy = 0.5 * potential.escape_energy
    spec = MapSpec(potential, Plane.X_PX, energy, (2, 2), t_max=_SHORT)
    compute_regularity(compute_map(spec))
    start = start_states(potential, Plane.X_PX, energy, np.zeros(1), np.zeros(1))
    integrate_orbit(potential, start[0], _SHORT)
    count_agreeing_digits(potential, start, _SHORT)
    find_section_points(potential, start, 1, _SHORT)
