"""The function that `Orbit.find_section_crossings` replaces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from engine.foundations.validation import checks_types, warn_of_method
from engine.systems.potential import Potential
from engine.trajectories.trajectory import Orbit


@checks_types(potential=Potential, orbit=Orbit)
def find_section_crossings(potential: Potential, orbit: Orbit) -> np.ndarray:
    """Deprecated: use `Orbit.find_section_crossings`; an orbit has its potential.

    Raises
    ------
    ValueError
        If the potential is not that of the orbit.

    Examples
    --------
    >>> from escape_explorer import CASES, integrate_orbit
    >>> integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=20.0).find_section_crossings().round(4)
    array([[ 0.1162, -0.042 ],
           [ 0.1585, -0.0726],
           [ 0.2122, -0.0821]])
    """
    if orbit.potential is not None:
        potential.check_same_motion(orbit.potential, "orbit")
    warn_of_method("find_section_crossings(potential, orbit)", "orbit.find_section_crossings()")
    return replace(orbit, potential=potential).find_section_crossings()
