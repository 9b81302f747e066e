"""Compiling ahead of time, so that nobody waits for it later."""

from __future__ import annotations

import numpy as np

from engine.map_specs import MapSpec
from engine.maps import compute_map
from engine.orbits import integrate_orbit
from engine.planes import Plane, start_states
from engine.potentials import Potential
from engine.quasi_periodicity import count_agreeing_digits
from engine.regularity_maps import judge_bounded_orbits
from engine.sections import find_section_points
from engine.stable_manifolds import find_stable_manifolds

_SHORT = 10.0


def prepare_kernels(potential: Potential) -> None:
    """Compile every kernel of a potential, or load it from the cache, by running it once on next to nothing.

    Parameters
    ----------
    potential
        Any `Potential` with a saddle; the first time on a machine this takes some 20 s.
    """
    find_stable_manifolds(potential, 1.01 * potential.escape_energy, 1)
    # Nothing leaves, so that there are bounded orbits to judge.
    energy = 0.5 * potential.escape_energy
    spec = MapSpec(potential, Plane.X_PX, energy, (2, 2), t_max=_SHORT)
    judge_bounded_orbits(compute_map(spec))
    start = start_states(potential, Plane.X_PX, energy, np.zeros(1), np.zeros(1))
    integrate_orbit(potential, start[0], _SHORT)
    count_agreeing_digits(potential, start, _SHORT)
    find_section_points(potential, start, 1, _SHORT)
