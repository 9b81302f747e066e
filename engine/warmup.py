"""Compile kernels ahead of time, or load them from the kernel cache."""

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

# Integration time, in units of the well, of the calls that trigger compilation.
_T_MAX = 10.0

# Kernels of the first frame of a map and of the Lyapunov orbits it needs.
_MAP_KERNELS = ("step", "jets", "potential_value", "propagate", "shoot")


def is_ready_for_maps(potential: Potential) -> bool:
    """Whether the kernels of maps are compiled; potentials that differ only in coefficients share kernels."""
    kernels = kernels_of(potential.in_well_units)
    return all(getattr(kernels, name).signatures for name in _MAP_KERNELS)


def prepare_for_maps(potential: Potential) -> None:
    """Compile the kernels for the first frame of a map, or load them from the cache.

    Parameters
    ----------
    potential
        Any `Potential` with an exit. Compilation takes some seconds.
    """
    if is_ready_for_maps(potential):
        return
    find_lyapunov_orbits(potential, 1.01 * potential.escape_energy)
    compute_map(MapSpec(potential, Plane.X_PX, 1.01 * potential.escape_energy, (2, 2), t_max=_T_MAX * potential.units.time))


def prepare_kernels(potential: Potential) -> None:
    """Compile all kernels of a potential, or load them from the cache, by calling each with minimal input.

    Parameters
    ----------
    potential
        Any `Potential` with an exit. Compilation takes some seconds, once per machine.
    """
    prepare_for_maps(potential)
    find_stable_manifolds(potential, 1.01 * potential.escape_energy, 1)
    # Below the escape energy all orbits are bounded, as `compute_regularity` needs.
    energy = 0.5 * potential.escape_energy
    spec = MapSpec(potential, Plane.X_PX, energy, (2, 2), t_max=_T_MAX * potential.units.time)
    compute_regularity(compute_map(spec))
    start = start_states(potential, Plane.X_PX, energy, np.zeros(1), np.zeros(1))
    integrate_orbit(potential, start[0], _T_MAX * potential.units.time)
    well, well_start = potential.in_well_units, start / potential.units.state
    count_agreeing_digits(well, well_start, _T_MAX)
    find_section_points(well, well_start, 1, _T_MAX)
