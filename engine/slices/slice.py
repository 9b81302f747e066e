"""Slices of phase space: which starts the points of a picture are.

A slice names two coordinates as axes and holds the others. The energy decides one momentum, whose sign the slice fixes. Along
an axis h every start has an energy of its own, and so have its exits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np

from engine.potentials.potential import Potential
from engine.potentials.well_units import WellUnits
from engine.results.arrays import read_only
from engine.validation import LARGEST_NUMBER, checked_array, checked_number, short_repr


class Coordinate(Enum):
    """A coordinate that an axis of a slice can have; the value is its symbol."""

    X = "x"
    Y = "y"
    PX = "px"
    PY = "py"
    H = "h"

    def unit(self, units: WellUnits) -> float:
        """The unit of the coordinate in which it is a number of the size of the well."""
        return {"x": units.length, "y": units.length, "px": units.momentum, "py": units.momentum, "h": units.energy}[self.value]


Energy = float | tuple[float, float]
"""The energy of a map: h, or on a slice with an axis h its range (low, high)."""

_POSITIONS = (Coordinate.X, Coordinate.Y)
_MOMENTA = (Coordinate.PX, Coordinate.PY)
# The coordinates whose sign changes under x → −x.
_MIRRORED = (Coordinate.X, Coordinate.PX)


@dataclass(frozen=True, repr=False)
class Slice:
    """A two-dimensional set of starts.

    Parameters
    ----------
    abscissa, ordinate
        The coordinates of the axes: two different ones, at most one of them a momentum.
    solved
        The momentum that the energy decides; not an axis.
    sign
        Sign of that momentum, 1 or −1.
    fixed
        ((coordinate, value), …): values of the other coordinates of the state, dimensionless; 0 for those left out.

    Raises
    ------
    ValueError
        If a coordinate is used twice, a value is not finite, or the sign is not 1 or −1.
    """

    abscissa: Coordinate
    ordinate: Coordinate
    solved: Coordinate = Coordinate.PY
    sign: int = 1
    fixed: tuple[tuple[Coordinate, float], ...] = ()

    def __post_init__(self) -> None:
        if self.solved not in _MOMENTA:
            raise ValueError(f"solved={self.solved.value}: must be px or py")
        if self.sign not in (1, -1):
            raise ValueError(f"sign={short_repr(self.sign)}: must be 1 or -1")
        used = [*self.axes, self.solved, *(coordinate for coordinate, _ in self.fixed)]
        if len(set(used)) < len(used) or Coordinate.H in used[2:]:
            raise ValueError(f"slice of {', '.join(c.value for c in used)}: each of x, y, px, py, h must be used at most once")
        # Zeros are left out, so that equal slices compare equal.
        values = ((coordinate, checked_number(f"fixed {coordinate.value}", value)) for coordinate, value in self.fixed)
        kept = sorted(((coordinate, value) for coordinate, value in values if value), key=lambda pair: pair[0].value)
        object.__setattr__(self, "fixed", tuple(kept))

    def __repr__(self) -> str:
        held = "".join(f"({coordinate}, {value!r}), " for coordinate, value in self.fixed)
        return f"Slice({self.abscissa}, {self.ordinate}, {self.solved}, {self.sign}, ({held.rstrip()}))"

    @property
    def axes(self) -> tuple[Coordinate, Coordinate]:
        """Abscissa and ordinate."""
        return self.abscissa, self.ordinate

    @property
    def axis_names(self) -> tuple[str, str]:
        """The symbols of abscissa and ordinate."""
        return self.abscissa.value, self.ordinate.value

    @property
    def key(self) -> str:
        """The name of the axes in addresses and on the command line, such as ``x_px``."""
        return "_".join(self.axis_names)

    @property
    def title(self) -> str:
        """The name in texts, such as "(x, px)"."""
        held = "".join(f", {coordinate.value} = {value:.6g}" for coordinate, value in self.fixed)
        return f"({', '.join(self.axis_names)}){held}"

    @property
    def energy_axis(self) -> int | None:
        """0 if h is the abscissa, 1 if it is the ordinate; None if all starts have one energy."""
        return self.axes.index(Coordinate.H) if Coordinate.H in self.axes else None

    @property
    def free_axes(self) -> tuple[bool, bool]:
        """For each axis, whether a start can be displaced along it at constant energy."""
        return self.abscissa is not Coordinate.H, self.ordinate is not Coordinate.H

    @property
    def shows_positions(self) -> bool:
        """Whether the axes are x and y, so that paths and exits can be drawn in the slice."""
        return self.axes == _POSITIONS

    @property
    def limiting_curve(self) -> str:
        """The equation of the boundary of the forbidden region, such as "½px² + V(x, 0) = h"."""
        other = next(momentum for momentum in _MOMENTA if momentum is not self.solved)
        symbols = {**{c: f"{value:.6g}" for c, value in self.fixed}, **{axis: axis.value for axis in self.axes}}
        kinetic = f"½{symbols[other] if other in self.axes else f'({symbols[other]})'}² + " if other in symbols else ""
        place = "" if self.shows_positions else f"({', '.join(symbols.get(position, '0') for position in _POSITIONS)})"
        return f"{kinetic}V{place} = h"

    def to_dict(self) -> dict[str, Any]:
        """The slice as plain data: names of the axes, values of other coordinates, and the momentum that the energy decides."""
        held = {coordinate.value: 0.0 for coordinate in (*_POSITIONS, *_MOMENTA)} | {c.value: value for c, value in self.fixed}
        fixed = {name: value for name, value in held.items() if name not in (*self.axis_names, self.solved.value)}
        return {"axes": list(self.axis_names), "fixed": fixed, "decided": self.solved.value, "sign": self.sign}

    def axis_units(self, units: WellUnits) -> tuple[float, float]:
        """The units of both axes in which their coordinates are numbers of the size of the well."""
        return self.abscissa.unit(units), self.ordinate.unit(units)

    def restore[Computed](self, result: Computed, units: WellUnits) -> Computed:
        """As `WellUnits.restore`, for a result whose `x` and `ordinate`, numbers or arrays, are positions on this slice."""
        if units == WellUnits():
            return result
        x_unit, ordinate_unit = self.axis_units(units)
        x, ordinate = x_unit * result.x, ordinate_unit * result.ordinate  # type: ignore[attr-defined]
        for coordinate in (x, ordinate):
            if isinstance(coordinate, np.ndarray):
                read_only(coordinate)
        return replace(units.restore(result), x=x, ordinate=ordinate)  # type: ignore[type-var]

    def in_well_units(self, units: WellUnits) -> Slice:
        """The same slice with its fixed values in units of a well; itself if it has none."""
        if not self.fixed:
            return self
        fixed = tuple((coordinate, value / coordinate.unit(units)) for coordinate, value in self.fixed)
        return Slice(self.abscissa, self.ordinate, self.solved, self.sign, fixed)

    def checked_energy(self, energy: Any) -> Energy:
        """An energy of this slice: one finite number, or the pair (low, high) along an axis h."""
        if self.energy_axis is None:
            return checked_number("energy", energy, f"one finite number on {self.title}")
        values = checked_array("energy", energy).ravel()
        if values.size != 2 or not (np.all(np.abs(values) <= LARGEST_NUMBER) and values[0] < values[1]):
            raise ValueError(
                f"energy={short_repr(energy)}: on {self.title} must be a pair (low, high) of finite numbers with low < high"
            )
        return float(values[0]), float(values[1])

    def energies(self, energy: Any, x: Any, ordinate: Any) -> Any:
        """The energy of points of the slice: `energy`, or their coordinate on an axis h."""
        return energy if self.energy_axis is None else (x, ordinate)[self.energy_axis]

    def states(self, potential: Potential, energy: Any, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """(n, 4) the starts of points of the slice; parameters as in `start_states`."""
        state = self._coordinates(x, ordinate)
        (other,) = (state[momentum] for momentum in _MOMENTA if momentum is not self.solved)
        with np.errstate(over="ignore", invalid="ignore"):
            # An overflow far from the origin gives a forbidden start.
            left = self.energies(energy, x, ordinate) - potential.value(state[Coordinate.X], state[Coordinate.Y])
            doubled = 2.0 * left - other * other
        state[self.solved] = self.sign * np.sqrt(np.where(doubled >= 0, doubled, np.nan))
        return np.column_stack([state[coordinate] for coordinate in (*_POSITIONS, *_MOMENTA)])

    def required_energy(self, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """The lowest energy at which a start exists; with an axis h, the energy missing there, positive where forbidden."""
        state = self._coordinates(x, ordinate)
        (other,) = (state[momentum] for momentum in _MOMENTA if momentum is not self.solved)
        kinetic = 0.5 * other**2 - self.energies(0.0, x, ordinate)
        required: np.ndarray = kinetic + potential.value(state[Coordinate.X], state[Coordinate.Y])
        return required

    def energy_groups(self, rows: int, columns: int) -> np.ndarray:
        """(rows · columns,) the number of the energy of each pixel, in row-major order: its place along an axis h, else 0."""
        groups = np.zeros((rows, columns), np.int64)
        if self.energy_axis == 0:
            groups += np.arange(columns)
        elif self.energy_axis == 1:
            groups += np.arange(rows)[:, None]
        return groups.ravel()

    @property
    def mirrored_axes(self) -> tuple[bool, bool] | None:
        """For each axis, whether its sign changes under x → −x; None if this mirror image of the slice is another one."""
        held = [coordinate for coordinate, _ in self.fixed]
        if self.solved in _MIRRORED or any(coordinate in _MIRRORED for coordinate in held):
            return None
        return self.abscissa in _MIRRORED, self.ordinate in _MIRRORED

    def find_mirror_images(self, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray | None:
        """For each pixel, the pixel whose orbit is its exact mirror image under x → −x.

        Parameters
        ----------
        potential
            The potential.
        x, ordinate
            (columns,), (rows,) pixel centres.

        Returns
        -------
        (rows · columns,) pixel indices in row-major order; None if the potential, the slice or the grid is not symmetric.
        """
        mirrored = self.mirrored_axes
        if mirrored is None or not any(mirrored) or not potential.mirror_in_x:
            return None
        if any(flips and not np.array_equal(axis, -axis[::-1]) for flips, axis in zip(mirrored, (x, ordinate), strict=True)):
            return None
        pixels = np.arange(x.size * ordinate.size).reshape(ordinate.size, x.size)
        images: np.ndarray = np.flip(pixels, tuple(1 - axis for axis in (0, 1) if mirrored[axis]))
        return images.ravel()

    def _coordinates(self, x: np.ndarray, ordinate: np.ndarray) -> dict[Coordinate, np.ndarray]:
        """Arrays of all coordinates of the state but the solved one, and of h where it is an axis."""
        held: Mapping[Coordinate, float] = dict(self.fixed)
        state = {coordinate: np.full_like(x, held.get(coordinate, 0.0)) for coordinate in (*_POSITIONS, *_MOMENTA)}
        return state | {self.abscissa: x, self.ordinate: ordinate}


class Plane(Slice, Enum):
    """The named slices. Coordinates that are not axes are 0, and the momentum that the energy decides is positive.

    The first three are those of Zotos (2014), the last one is the section of Hénon & Heiles (1964), Astron. J. 69, 73.
    """

    X_Y = Coordinate.X, Coordinate.Y
    X_PX = Coordinate.X, Coordinate.PX
    X_H = Coordinate.X, Coordinate.H
    Y_PY = Coordinate.Y, Coordinate.PY, Coordinate.PX


SPACE = Plane.X_Y
"""The plane of the positions, in which V, paths and exits are drawn."""


def common_energy(energy: Energy) -> float | None:
    """h of all starts of a map; None on a slice with an axis h."""
    return None if isinstance(energy, tuple) else energy


def highest_energy(energy: Energy) -> float:
    """The highest h of a map."""
    return energy[1] if isinstance(energy, tuple) else energy


def scaled_energy(energy: Energy, factor: float) -> Energy:
    """The energy of a map in other units."""
    return (factor * energy[0], factor * energy[1]) if isinstance(energy, tuple) else factor * energy


def checked_slice(value: Any) -> Slice:
    """A slice, given as one or by the title or the key of a named one: "(x, px)" or "x_px"."""
    if isinstance(value, Slice):
        return next((plane for plane in Plane if _fields(plane) == _fields(value)), value)
    for plane in Plane if isinstance(value, str) else ():
        if value in (plane.title, plane.key):
            return plane
    raise ValueError(f"plane={short_repr(value)}: must be a Slice or one of {', '.join(plane.title for plane in Plane)}")


def _fields(chosen: Slice) -> tuple[Any, ...]:
    return chosen.abscissa, chosen.ordinate, chosen.solved, chosen.sign, chosen.fixed


def start_states(
    potential: Potential, plane: Slice, energy: float | np.ndarray, x: np.ndarray, ordinate: np.ndarray
) -> np.ndarray:
    """The initial conditions of points of a slice.

    Parameters
    ----------
    potential
        The potential.
    plane
        The slice, such as a `Plane`.
    energy
        h, a number or (n,); ignored on a slice with an axis h.
    x, ordinate
        (n,) coordinates on the slice.

    Returns
    -------
    (n, 4) x, y, px, py; the momentum that the energy decides is NaN where the start is forbidden.

    Examples
    --------
    >>> import numpy as np
    >>> from engine import CASES, Plane, start_states
    >>> start_states(CASES["III"], Plane.X_PX, 0.45, np.array([0.0, 0.9]), np.array([0.3, 0.5])).round(4)
    array([[0. , 0. , 0.3, 0.9],
           [0.9, 0. , 0.5, nan]])
    """
    return checked_slice(plane).states(potential, energy, x, ordinate)
