"""The places of an orbit on a slice of starts: of its start, and of its first crossing of the section."""

from __future__ import annotations

import math

import numpy as np

from engine import Coordinate, Potential, Slice
from plots.links.map_view import Start
from plots.pictures.orbit_curves import OrbitCurves

# Largest difference of a state from the start at its place, in units of the well: that of rounding.
_ROUNDING = 1e-9


def find_place(plane: Slice, potential: Potential, energy: float, state: tuple[float, ...]) -> Start | None:
    """Return the place at which a state starts on a slice of one potential at an energy; None if there is none.

    Parameters
    ----------
    plane
        The slice, without a parameter as an axis.
    potential
        The potential.
    energy
        h, dimensionless; without influence on a slice with an axis h.
    state
        x, y, px, py, dimensionless.
    """
    values, unit = np.array(state), potential.units.state
    known, fixed = _coordinates(potential, values), dict(plane.fixed)
    x, ordinate = (
        sum(change * (known[coordinate] - fixed.get(coordinate, 0.0)) for coordinate, change in axis.components.items())
        / sum(change**2 for change in axis.components.values())
        for axis in plane.axes
    )
    with np.errstate(all="ignore"):
        (start,) = plane.states(potential, energy, np.array([x]), np.array([ordinate]))
    return (x, ordinate) if np.allclose(start / unit, values / unit, rtol=0.0, atol=_ROUNDING) else None


def find_crossing(plane: Slice, potential: Potential, energy: float, curves: OrbitCurves) -> Start | None:
    """Return the place of the first crossing of the section by an orbit on a slice of the section; None if there is none.

    This is known for sections along a coordinate that are crossed in one direction, where the slice has this direction.

    Parameters
    ----------
    plane, potential, energy
        As in `find_place`.
    curves
        The orbit with its crossings.
    """
    orbit, section = curves.orbit, curves.orbit.section
    is_of_slice = section.plane == plane and section.columns_on(plane) is not None and section.is_of_positions
    is_other = orbit.potential != potential or abs(orbit.energy - energy) > _ROUNDING * potential.units.energy
    if is_other or not is_of_slice or section.direction.value == "both" or not len(curves.section):
        return None
    x, ordinate = curves.section[0].tolist()
    return x, ordinate


def _coordinates(potential: Potential, state: np.ndarray) -> dict[Coordinate, float]:
    """Return the coordinates of a state, as described in `Coordinate`."""
    x, y, px, py = state.tolist()
    theta, radial = math.atan2(py, px), math.atan2(y, x) if x or y else 0.5 * math.pi
    values = x, y, px, py, theta, math.remainder(theta - radial, 2.0 * math.pi), math.hypot(px, py)
    return dict(zip(Coordinate, (*values, float(potential.energy(state))), strict=True))
