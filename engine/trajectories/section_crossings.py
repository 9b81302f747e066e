"""Surface of section: points (x, px) at which an orbit crosses y = 0 upward (py > 0)."""

from __future__ import annotations

import numpy as np

from engine.potentials.compiled import kernels_of
from engine.potentials.potential import Potential
from engine.taylor.kernels.dense_output import find_crossings
from engine.trajectories.trajectory import Orbit
from engine.validation import checks_types


@checks_types(potential=Potential, orbit=Orbit)
def find_section_crossings(potential: Potential, orbit: Orbit) -> np.ndarray:
    """Find the upward crossings of y = 0 from the samples of an orbit; the start is not counted.

    Between two samples on either side of y = 0 the Taylor series of the first is used.

    Parameters
    ----------
    potential
        The `Potential` of the orbit.
    orbit
        An `Orbit` from `integrate_orbit`.

    Returns
    -------
    (n, 2) x and px in order of time, dimensionless; n equals `Orbit.crossings`.

    Examples
    --------
    >>> from escape_explorer import CASES, find_section_crossings, integrate_orbit
    >>> orbit = integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), t_max=20.0)
    >>> find_section_crossings(CASES["II"], orbit).round(4)
    array([[ 0.1162, -0.042 ],
           [ 0.1585, -0.0726],
           [ 0.2122, -0.0821]])
    """
    units = potential.units
    path = np.stack([orbit.x, orbit.y, orbit.px, orbit.py]) / units.state[:, None]
    points = find_crossings(kernels_of(potential.in_well_units), path, orbit.t / units.time)
    return points * [units.length, units.momentum]
