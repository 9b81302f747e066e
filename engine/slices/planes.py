"""The named slices, and the starts at points of a slice."""

from __future__ import annotations

from enum import Enum
from typing import Any

import numpy as np

from engine.foundations.validation import checked_array, checked_finite, checks_types, short_repr
from engine.slices.axes import Coordinate
from engine.slices.slice import Slice
from engine.systems.potential import Potential


class Plane(Slice, Enum):
    """The named slices. Coordinates that are not axes are 0, and the momentum determined by the energy is positive.

    The first three slices are from Zotos (2014), the fourth is the section of Hénon & Heiles (1964), Astron. J. 69, 73. In the
    last slice, of Aguirre, Vallejo & Sanjuán (2001), Phys. Rev. E 64, 066208, orbits start at right angles to the radius.
    """

    X_Y = Coordinate.X, Coordinate.Y
    X_PX = Coordinate.X, Coordinate.PX
    X_H = Coordinate.X, Coordinate.H
    Y_PY = Coordinate.Y, Coordinate.PY
    TANGENTIAL = Coordinate.X, Coordinate.Y, Coordinate.SPEED, 1, ((Coordinate.BETA, 0.5 * np.pi),)

    @property
    def key(self) -> str:
        """The name in addresses, in file names and on the command line."""
        return self.name.lower()


SPACE = Plane.X_Y
"""The plane of the positions, in which V, paths and exits are drawn."""

ENERGY_SURFACE = Slice(*SPACE.axes, Coordinate.SPEED)
"""The positions with the speed that the energy determines; with all directions of the velocity, they are the energy surface."""

SECTION = Plane.X_PX
"""The slice of the states on the surface of section, y = 0 upward, at which crossings are counted (Zotos 2014)."""


def checked_slice(value: Any) -> Slice:
    """Return a slice, given as a `Slice`, as the title or key of a named slice, "(x, px)" or "x_px", or by two names, "x,py"."""
    if isinstance(value, Slice):
        return next((plane for plane in Plane if _fields(plane) == _fields(value)), value)
    planes_by_name = {name: plane for plane in Plane for name in (plane.title, plane.key)}
    if isinstance(value, str) and value in planes_by_name:
        return planes_by_name[value]
    if isinstance(value, str) and value.count(",") == 1:
        abscissa, ordinate = (name.strip() for name in value.split(","))
        return checked_slice(Slice(abscissa, ordinate))
    legal = ", ".join(plane.key for plane in Plane)
    raise ValueError(f"plane={short_repr(value)}: must be a Slice, one of {legal}, or two coordinates such as 'x,py'")


def _fields(plane: Slice) -> tuple[Any, ...]:
    """Return the fields of a slice, because a `Plane` and a `Slice` with equal fields are not equal."""
    return plane.abscissa, plane.ordinate, plane.solved, plane.sign, plane.fixed


@checks_types(potential=Potential)
def start_states(
    potential: Potential, plane: Slice | str, energy: float | np.ndarray, x: float | np.ndarray, ordinate: float | np.ndarray
) -> np.ndarray:
    """Return the initial conditions of points of a slice.

    Parameters
    ----------
    potential
        The potential.
    plane
        The slice, such as a `Plane`.
    energy
        h, finite, a number or (n,); ignored on a slice with an axis h.
    x, ordinate
        Coordinates on the slice, (n,) or one number each.

    Returns
    -------
    x, y, px, py of each start, of shape (n, 4); n = 1 for numbers. The momentum determined by the energy is NaN where a start is
    forbidden.

    Raises
    ------
    ValueError
        If a parameter is of a wrong type, an energy is not finite, or the coordinates differ in shape.

    Examples
    --------
    >>> import numpy as np
    >>> from escape_explorer import CASES, Plane, start_states
    >>> start_states(CASES["III"], Plane.X_PX, 0.45, np.array([0.0, 0.9]), np.array([0.3, 0.5])).round(4)
    array([[0. , 0. , 0.3, 0.9],
           [0.9, 0. , 0.5, nan]])
    """
    xs, ordinates = checked_array("x", x), checked_array("ordinate", ordinate)
    if xs.shape != ordinates.shape:
        raise ValueError(f"ordinate of shape {ordinates.shape}: must be shaped like x, {xs.shape}")
    checked = checked_slice(plane)
    energies = (
        checked_array("energy", energy) if checked.energy_axis is not None else np.asarray(checked_finite("energy", energy))
    )
    if checked.energy_axis is None and energies.ndim and energies.shape != xs.shape:
        raise ValueError(f"energy of shape {energies.shape}: must be a number, or shaped like x, {xs.shape}")
    # [()] turns an array without dimensions into a number.
    return checked.states(potential, energies[()], xs[()], ordinates[()])
