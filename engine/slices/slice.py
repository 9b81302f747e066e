"""Slices of phase space, which assign a start to each point of a picture.

A slice has two axes, and fixed values of the coordinates that are not axes. An axis is a coordinate, an oblique direction, h, or
a parameter of the system. The energy determines one momentum, whose sign is fixed, or the speed if an angle is given. With an
axis h, every start has its own energy and exits; along a parameter, every start has its own potential.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.validation import LARGEST_NUMBER, checked_array, checked_number, short_repr
from engine.foundations.wording import format_number
from engine.integrator.kernels import slice_starts
from engine.slices.axes import (
    ANGLES,
    MOMENTA,
    POSITIONS,
    STATE,
    Axis,
    Coordinate,
    CoordinateName,
    Direction,
    Energy,
    ParameterAxis,
    checked_coordinate,
)
from engine.slices.slice_starts import check_coordinates, compute_required_energy, compute_states, default_solved
from engine.systems.potential import Potential
from engine.systems.system import System
from engine.systems.well_units import WellUnits


@dataclass(frozen=True, repr=False)
class Slice:
    """A two-dimensional set of starts.

    Parameters
    ----------
    abscissa, ordinate
        The two axes, which must differ: coordinates such as ``Coordinate.X`` or "x", `Direction`s, and at most one
        `ParameterAxis`.
    solved
        The coordinate that the energy determines: a momentum, or the speed if an angle is used. None stands for the speed if an
        angle is used, px if py is used, and otherwise py.
    sign
        Sign of the determined momentum, 1 or −1; 1 for the speed.
    fixed
        Values of the other coordinates of the state, dimensionless, as a mapping such as ``{"y": 0.1}`` or as pairs; 0 for
        coordinates that are not given.

    Raises
    ------
    ValueError
        If a coordinate is used twice, nothing is left for the energy to determine, two directions are parallel, a value is not
        finite, or the sign is not 1 or −1.
    """

    abscissa: Axis
    ordinate: Axis
    solved: Coordinate | None = None
    sign: int = 1
    fixed: tuple[tuple[Coordinate, float], ...] = ()

    # `__init__` also accepts types that it converts. The fields have the types of the stored values.
    if TYPE_CHECKING:

        def __init__(
            self,
            abscissa: Axis | str,
            ordinate: Axis | str,
            solved: CoordinateName | None = None,
            sign: int = 1,
            fixed: Mapping[str, float] | Mapping[Coordinate, float] | Iterable[tuple[CoordinateName, float]] = (),
        ) -> None: ...

    def __post_init__(self) -> None:
        self._check_types()
        used = [axis for axis in self.axes if isinstance(axis, Coordinate)] + [coordinate for coordinate, _ in self.fixed]
        if self.solved is None:
            object.__setattr__(self, "solved", default_solved(self.axes, used))
        check_coordinates(self.axes, used, self.fixed, self.decided)
        legal_signs = (1,) if self.decided is Coordinate.SPEED else (1, -1)
        if self.sign not in legal_signs:
            raise ValueError(f"sign={short_repr(self.sign)}: must be {' or '.join(map(str, legal_signs))}")
        values = {coordinate: checked_number(f"fixed {coordinate.key}", value) for coordinate, value in self.fixed}
        if self.decided is Coordinate.SPEED and not any(angle in used for angle in ANGLES):
            values[Coordinate.THETA] = 0.0
        # Zeros are left out, so that equal slices compare equal. An angle of 0 stays, because it shows which angle is fixed.
        pairs = sorted(((c, value) for c, value in values.items() if value or c in ANGLES), key=lambda pair: pair[0].key)
        object.__setattr__(self, "fixed", tuple(pairs))

    def _check_types(self) -> None:
        """Raise ValueError for a field of a wrong type. Names become coordinates, and `fixed` a tuple of pairs."""
        # Type checkers would report that the conversions of the declared types cannot happen.
        given: Any = self
        for name, axis in (("abscissa", given.abscissa), ("ordinate", given.ordinate)):
            if not isinstance(axis, Axis):
                object.__setattr__(self, name, checked_coordinate(name, axis, ", a Direction or a ParameterAxis"))
        if self.solved is not None:
            object.__setattr__(self, "solved", checked_coordinate("solved", self.solved))
        try:
            pairs = [(name, value) for name, value in (given.fixed.items() if isinstance(given.fixed, Mapping) else given.fixed)]
        except (TypeError, ValueError):
            raise ValueError(f"fixed={short_repr(self.fixed)}: must be a mapping such as {{'y': 0.1}}, or pairs") from None
        object.__setattr__(self, "fixed", tuple((checked_coordinate("fixed", name), value) for name, value in pairs))

    def __repr__(self) -> str:
        fixed = "".join(f"({coordinate}, {value!r}), " for coordinate, value in self.fixed)
        abscissa, ordinate = (str(axis) if isinstance(axis, Coordinate) else repr(axis) for axis in self.axes)
        return f"Slice({abscissa}, {ordinate}, {self.solved}, {self.sign}, ({fixed.rstrip()}))"

    @property
    def axes(self) -> tuple[Axis, Axis]:
        """Abscissa and ordinate."""
        return self.abscissa, self.ordinate

    @property
    def decided(self) -> Coordinate:
        """The coordinate that the energy determines: px, py or the speed. This is `solved`, which is never None here."""
        assert self.solved is not None
        return self.solved

    @property
    def axis_names(self) -> tuple[str, str]:
        """The names of abscissa and ordinate in files."""
        return self.abscissa.key, self.ordinate.key

    @property
    def axis_symbols(self) -> tuple[str, str]:
        """The symbols of abscissa and ordinate in texts and on axes."""
        return self.abscissa.symbol, self.ordinate.symbol

    @property
    def key(self) -> str:
        """A name for files, such as ``x_px`` or ``x_theta-y0.1``, with 6 significant digits of the fixed values."""
        fixed = "".join(f"-{coordinate.key}{value:.6g}" for coordinate, value in self.fixed)
        return "_".join(self.axis_names) + fixed + ("" if self.sign > 0 else "-negative")

    @property
    def title(self) -> str:
        """The name in texts, such as "(x, px)": axes, fixed values, and the determined momentum if it is not the usual one."""
        conditions = [f"{coordinate.symbol} = {format_number(value, 6)}" for coordinate, value in self.fixed]
        usual = default_solved(self.axes, [axis for axis in self.axes if isinstance(axis, Coordinate)])
        if self.sign < 0 or (self.decided is not usual and self.decided is not Coordinate.SPEED):
            conditions.append(f"{self.decided.symbol} {'>' if self.sign > 0 else '<'} 0")
        return ", ".join([f"({', '.join(self.axis_symbols)})", *conditions])

    @property
    def energy_axis(self) -> int | None:
        """0 if h is the abscissa, 1 if it is the ordinate; None if all starts have one energy."""
        return self.axes.index(Coordinate.H) if Coordinate.H in self.axes else None

    @property
    def parameter_axis(self) -> int | None:
        """0 if the abscissa is a parameter, 1 if the ordinate is; None if all starts have one potential."""
        return next((index for index, axis in enumerate(self.axes) if isinstance(axis, ParameterAxis)), None)

    @property
    def parameter(self) -> ParameterAxis | None:
        """The axis that is a parameter; None if there is none."""
        return next((axis for axis in self.axes if isinstance(axis, ParameterAxis)), None)

    @property
    def free_axes(self) -> tuple[bool, bool]:
        """For each axis, whether a start can be displaced along it at constant energy in the same potential."""
        return self.abscissa.is_free, self.ordinate.is_free

    @property
    def shows_positions(self) -> bool:
        """Whether the axes are x and y, so that paths and exits can be drawn in the slice."""
        return self.axes == POSITIONS

    def limiting_curve(self, mass: float) -> str:
        """Return the equation of the boundary of the forbidden region for a mass, such as "½px² + V(x, 0) = h" for 1."""
        factor = "½" if mass == 1.0 else f"{0.5 / mass:.6g} "
        variables = {c for axis in self.axes for c in (axis.components if isinstance(axis, Direction) else {axis})}
        symbols = {**{c: f"{value:.6g}" for c, value in self.fixed}, **{c: c.symbol for c in variables if c in STATE}}
        kinetic = "".join(
            f"{factor}{symbols[momentum] if momentum in variables else f'({symbols[momentum]})'}² + "
            for momentum in MOMENTA
            if momentum in symbols and momentum is not self.decided
        )
        arguments = "" if self.shows_positions else f"({', '.join(symbols.get(position, '0') for position in POSITIONS)})"
        return f"{kinetic}V{arguments} = h"

    def to_dict(self, units: WellUnits, *, backward: bool = False) -> dict[str, Any]:
        """Return the slice as plain data in units of a well, see `Slice` in modules/engine/system.js of the page.

        With `backward`, all starts have the opposite momenta.
        """
        scaled = self.in_well_units(units)
        sense = -1 if backward else 1
        return {
            "axes": list(self.axis_names),
            "units": list(self.axis_units(units)),
            "motion": [_to_columns(motion, sense) for motion in (dict(scaled.fixed), *(axis.components for axis in scaled.axes))],
            "decided": _decided_code(self),
            "sign": sense * self.sign,
            "mirrored": self.mirrored_axes,
        }

    def axis_units(self, units: WellUnits) -> tuple[float, float]:
        """Return the unit of each axis, see `Coordinate.unit`."""
        return self.abscissa.unit(units), self.ordinate.unit(units)

    def restore[Computed](self, result: Computed, units: WellUnits) -> Computed:
        """Convert a result from units of the well to those of the potential; its `x` and `ordinate` are places on this slice."""
        x_unit, ordinate_unit = self.axis_units(units)
        x, ordinate = x_unit * result.x, ordinate_unit * result.ordinate  # type: ignore[attr-defined]
        return replace(units.restore(result), x=x, ordinate=ordinate)  # type: ignore[type-var]

    def in_well_units(self, units: WellUnits) -> Slice:
        """Return the slice in units of a well: the slice itself if it has neither fixed values nor directions."""
        if not self.fixed and not any(isinstance(axis, Direction) for axis in self.axes):
            return self
        fixed = tuple((coordinate, value / coordinate.unit(units)) for coordinate, value in self.fixed)
        abscissa, ordinate = (axis.in_well_units(units) for axis in self.axes)
        return Slice(abscissa, ordinate, self.solved, self.sign, fixed)

    def checked_energy(self, energy: Any) -> Energy:
        """Return an energy of this slice: one finite number, or the pair (low, high) with an axis h."""
        if self.energy_axis is None:
            return checked_number("energy", energy, f"one finite number on {self.title}, at most {LARGEST_NUMBER:g} in magnitude")
        values = checked_array("energy", energy).ravel()
        if values.size != 2 or not (np.all(np.abs(values) <= LARGEST_NUMBER) and values[0] < values[1]):
            raise ValueError(
                f"energy={short_repr(energy)}: on {self.title} must be a pair (low, high) of finite numbers with low < high"
            )
        return float(values[0]), float(values[1])

    def energies(self, energy: Any, x: Any, ordinate: Any) -> Any:
        """Return the energy of points of the slice: `energy`, or their coordinate on an axis h."""
        return energy if self.energy_axis is None else (x, ordinate)[self.energy_axis]

    def states(self, potential: Potential, energy: Any, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """Return the starts of points of the slice, of shape (n, 4), see `start_states`."""
        return compute_states(self, potential, energy, x, ordinate)

    def required_energy(self, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """Return the lowest energy of a start at each point, of the shape of `x`.

        With an axis h, this energy is relative to the h of the point, so it is positive at forbidden points.
        """
        return compute_required_energy(self, potential, x, ordinate)

    def of_system(self, system: System) -> Slice:
        """Return the slice with its parameter in another system; ValueError if that system lacks the parameter or its range."""
        # A system that is equal may lack a potential that `system` has already derived.
        if self.parameter is None or self.parameter.system is system:
            return self
        return self._with_axes(*(replace(axis, system=system) if isinstance(axis, ParameterAxis) else axis for axis in self.axes))

    def check_one_potential(self, name: str) -> None:
        """Raise ValueError if an axis is a parameter of the system. The message begins with `name`, the wrong argument."""
        if self.parameter is not None:
            raise ValueError(f"{name}: is on {self.title}; must be on a slice of one potential, without a parameter as axis")

    def line(self, value: float) -> Slice:
        """Return the slice, of one potential, at one value of the parameter that is an axis."""
        return self._with_axes(*(axis.at(value) if isinstance(axis, ParameterAxis) else axis for axis in self.axes))

    def _with_axes(self, abscissa: Axis, ordinate: Axis) -> Slice:
        """Return the slice with other axes. A `Plane` becomes a `Slice`."""
        return Slice(abscissa, ordinate, self.solved, self.sign, self.fixed)

    def system_at(self, system: System, x: float, ordinate: float) -> System:
        """Return the system of a point: `system`, or the system at the point's value of a parameter."""
        axis = self.parameter
        return system if axis is None else system.with_parameter(axis.key, (x, ordinate)[self.parameter_axis or 0])

    def potential_at(self, potential: Potential, x: float, ordinate: float) -> Potential:
        """Return the potential of a point: `potential`, or the potential at the point's value of a parameter.

        Raises ValueError if the system has no potential at this value.
        """
        return potential if self.parameter is None else self.system_at(self.parameter.system, x, ordinate).potential

    def energy_groups(self, rows: int, columns: int) -> np.ndarray:
        """Return the index of the energy of each pixel, (rows · columns,): the pixel's index along an axis h, otherwise 0."""
        groups = np.zeros((rows, columns), np.int64)
        if self.energy_axis == 0:
            groups += np.arange(columns)
        elif self.energy_axis == 1:
            groups += np.arange(rows)[:, None]
        return groups.ravel()

    @property
    def mirrored_axes(self) -> tuple[bool, bool] | None:
        """For each axis, whether its sign changes under x → −x; None if the mirror image is a different slice."""
        parities = [axis.parity for axis in self.axes]
        # A fixed 0 is its own mirror image even if x → −x changes the sign of the coordinate.
        fixed_parities = [coordinate.parity for coordinate, value in self.fixed if value or coordinate.parity != -1]
        if None in parities or any(parity != 1 for parity in (self.decided.parity, *fixed_parities)):
            return None
        return parities[0] == -1, parities[1] == -1

    def find_mirror_images(self, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray | None:
        """Find, for each pixel, the pixel whose orbit is its exact mirror image under x → −x.

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
        if mirrored is None or not any(mirrored) or not potential.well.mirror_in_x:
            return None
        if any(flips and not np.array_equal(axis, -axis[::-1]) for flips, axis in zip(mirrored, (x, ordinate), strict=True)):
            return None
        pixels = np.arange(x.size * ordinate.size).reshape(ordinate.size, x.size)
        images: np.ndarray = np.flip(pixels, tuple(1 - axis for axis in (0, 1) if mirrored[axis]))
        return images.ravel()


def _to_columns(values: Mapping[Coordinate, float], sense: int) -> list[float]:
    """Return coordinates in the columns of `engine.integrator.kernels.slice_starts`; missing coordinates are 0.

    Momenta are multiplied by `sense`. An angle stays, because the sign of the speed turns the velocity.
    """
    values_by_column = {
        "angle" if coordinate in ANGLES else coordinate.key: sense * value if coordinate in MOMENTA else value
        for coordinate, value in values.items()
    }
    return [values_by_column.get(name, 0.0) for name in ("x", "y", "px", "py", "angle", "h")]


def _decided_code(plane: Slice) -> int:
    """Return what the energy determines, as a code of `engine.integrator.kernels.slice_starts`."""
    if plane.decided is not Coordinate.SPEED:
        return slice_starts.PX if plane.decided is Coordinate.PX else slice_starts.PY
    used = {*plane.axes, *(coordinate for coordinate, _ in plane.fixed)}
    return slice_starts.LAUNCHED_FROM_RADIUS if Coordinate.BETA in used else slice_starts.LAUNCHED
