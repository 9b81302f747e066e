"""The axes of a slice, and the energy or range of energies of a map."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from engine.foundations.validation import check_type, checked_number, short_repr
from engine.systems.parameters import symbol_of
from engine.systems.potential import Potential
from engine.systems.system import System
from engine.systems.well_units import WellUnits, nearest_power_of_two


class Coordinate(Enum):
    """A coordinate of a start. The value of each member is its name, such as "px", which functions accept in its place.

    `THETA` is the angle of the velocity from the +x axis, px = v cos θ, py = v sin θ. `BETA` is the angle of the velocity from
    the outward radial direction, or at the origin from the +y axis: 0 is radially outward, π/2 tangential, counterclockwise.
    `SPEED` is v, which is always determined by the energy. `H` is the energy h.
    """

    X = "x"
    Y = "y"
    PX = "px"
    PY = "py"
    THETA = "theta"
    BETA = "beta"
    SPEED = "v"
    H = "h"

    @classmethod
    def _missing_(cls, value: object) -> Coordinate | None:
        """Return the coordinate with a symbol, for ``Coordinate("θ")``."""
        return next((coordinate for coordinate in cls if coordinate.symbol == value), None)

    @property
    def key(self) -> str:
        """The name in addresses, in files and on the command line."""
        return self.value

    @property
    def symbol(self) -> str:
        """The symbol in texts and on axes."""
        return {"theta": "θ", "beta": "β"}.get(self.value, self.value)

    @property
    def parity(self) -> int | None:
        """1 if x → −x leaves the coordinate unchanged, −1 if its sign changes, None otherwise."""
        return {"x": -1, "px": -1, "beta": -1, "theta": None}.get(self.value, 1)

    @property
    def is_free(self) -> bool:
        """Whether starts can be displaced along the axis at constant energy."""
        return self is not Coordinate.H

    def unit(self, units: WellUnits) -> float:
        """Return the unit of the coordinate, in which values inside the well are of order 1."""
        lengths = dict.fromkeys(("x", "y"), units.length)
        momenta = dict.fromkeys(("px", "py", "v"), units.momentum)
        return {**lengths, **momenta, "h": units.energy}.get(self.value, 1.0)

    @property
    def components(self) -> dict[Coordinate, float]:
        """Change of each coordinate of a start per unit along the axis, without zeros."""
        return {self: 1.0}

    def in_well_units(self, units: WellUnits) -> Coordinate:
        """Return the coordinate itself. Only the values along the axis have a unit."""
        return self

    def set_along_axis(self, start: MutableMapping[Coordinate, np.ndarray], axis_values: np.ndarray) -> None:
        """Set this coordinate of n starts, in place, to the values along the axis, of shape (n,)."""
        start[self] = axis_values


# Groups of coordinates; `STATE` has the order of the columns of states.
POSITIONS = (Coordinate.X, Coordinate.Y)
MOMENTA = (Coordinate.PX, Coordinate.PY)
ANGLES = (Coordinate.THETA, Coordinate.BETA)
STATE = (*POSITIONS, *MOMENTA)

# Magnitudes of a parameter below this share of the axis's range are rounding errors, too small for a coefficient, and count as 0.
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Direction:
    """An oblique axis: a direction in (x, y, px, py) along which starts move from the fixed values of the slice.

    Parameters
    ----------
    key
        Name of the direction, an identifier such as "u".
    x, y, px, py
        Change of each coordinate of a start per unit along the axis, from -1e9 to 1e9, not all 0.

    Raises
    ------
    ValueError
        If the name is not an identifier or is the name of a coordinate, a component is not finite or beyond ±1e9, or all are 0.
    """

    key: str
    x: float = 0.0
    y: float = 0.0
    px: float = 0.0
    py: float = 0.0

    is_free: ClassVar = True
    """Starts can be displaced along the direction at constant energy."""

    def __post_init__(self) -> None:
        check_type("key", self.key, str)
        if not self.key.isidentifier() or self.key in {coordinate.value for coordinate in Coordinate}:
            raise ValueError(f"direction {short_repr(self.key)}: its name must be an identifier that is not a coordinate")
        for coordinate in STATE:
            value = checked_number(f"direction {self.key}: {coordinate.value}", getattr(self, coordinate.value))
            object.__setattr__(self, coordinate.value, value)
        if not self.components:
            raise ValueError(f"direction {self.key}: one of x, y, px, py must not be 0")

    @property
    def components(self) -> dict[Coordinate, float]:
        """The components that are not 0."""
        return {coordinate: value for coordinate in STATE if (value := getattr(self, coordinate.value))}

    @property
    def symbol(self) -> str:
        """The symbol in texts and on axes."""
        return self.key

    @property
    def parity(self) -> int | None:
        """The common parity of the components, see `Coordinate.parity`; None if they differ."""
        parities = {coordinate.parity for coordinate in self.components}
        return parities.pop() if len(parities) == 1 else None

    def unit(self, units: WellUnits) -> float:
        """Return the unit of the values along the axis, a power of 2. In this unit, values inside the well are of order 1."""
        scaled_components = [value / coordinate.unit(units) for coordinate, value in self.components.items()]
        return 1.0 / nearest_power_of_two(float(np.hypot.reduce(scaled_components)))

    def in_well_units(self, units: WellUnits) -> Direction:
        """Return the direction with both the states and the axis in units of the well."""
        unit = self.unit(units)
        return Direction(self.key, **{c.value: value * unit / c.unit(units) for c, value in self.components.items()})

    def set_along_axis(self, start: MutableMapping[Coordinate, np.ndarray], axis_values: np.ndarray) -> None:
        """Displace n starts, in place, along the direction by the values along the axis, of shape (n,)."""
        for coordinate, component in self.components.items():
            start[coordinate] = start[coordinate] + component * axis_values


class _SystemAxis:
    """An axis along which the system varies while starts do not change."""

    key: str

    components: ClassVar[Mapping[Coordinate, float]] = MappingProxyType({})
    """Empty, because starts do not change."""

    parity: ClassVar = 1
    """x → −x leaves parameters unchanged."""

    is_free: ClassVar = False
    """Starts cannot be displaced along a parameter, because another value is another system."""

    @property
    def symbol(self) -> str:
        """The symbol in texts and on axes."""
        return symbol_of(self.key)

    def unit(self, units: WellUnits) -> float:
        """Return 1: parameters are not scaled."""
        return 1.0

    def in_well_units(self, units: WellUnits) -> Self:
        """Return the axis itself."""
        return self

    def set_along_axis(self, start: MutableMapping[Coordinate, np.ndarray], axis_values: np.ndarray) -> None:
        """Leave starts unchanged."""


@dataclass(frozen=True)
class ParameterAxis(_SystemAxis):
    """An axis along which a parameter of a system varies, with a potential at each value.

    Parameters
    ----------
    key
        Name of the parameter: omega_1, omega_2, epsilon, or a letter of the system's formula.
    low, high
        Range of the parameter in the default window, dimensionless, low < high, within `System.range_of`.
    system
        The system, or its potential. An exit of this system has the same number at every value of the parameter; other exits
        have the next numbers.

    Raises
    ------
    ValueError
        If the system has no such parameter, or the range is empty or not legal. Only `potential` checks whether the system has a
        potential at a value, because the check takes seconds for some formulas.
    """

    key: str
    low: float
    high: float
    system: System

    # `__init__` also accepts types that it converts. The fields have the types of the stored values.
    if TYPE_CHECKING:

        def __init__(self, key: str, low: float, high: float, system: System | Potential) -> None: ...

    def __post_init__(self) -> None:
        if isinstance(self.system, Potential):
            object.__setattr__(self, "system", _system_of(self.system))
        if not isinstance(self.system, System):
            raise ValueError(f"system={short_repr(self.system)}: must be a System, or the potential of one")
        names = self.system.parameter_names
        if self.key not in names:
            legal = f"a parameter of the system: {', '.join(names)}" if names else "a parameter of the system, which has none"
            raise ValueError(f"parameter {short_repr(self.key)}: must be {legal}")
        low, high = (checked_number(f"parameter {self.key}", value) for value in (self.low, self.high))
        if not low < high:
            raise ValueError(f"parameter {self.key} from {low:g} to {high:g}: the lower end must be below the upper end")
        object.__setattr__(self, "low", low)
        object.__setattr__(self, "high", high)
        lowest, highest = self.system.range_of(self.key)
        if low < lowest or high > highest:
            raise ValueError(f"parameter {self.key} from {low:g} to {high:g}: must be between {lowest:g} and {highest:g}")

    def system_at(self, value: float) -> System:
        """Return the system at a value of the parameter."""
        is_zero = abs(value) < _ROUNDING * (self.high - self.low)
        return self.system.with_parameter(self.key, 0.0 if is_zero else value)

    def potential(self, value: float) -> Potential:
        """Return the potential at a value of the parameter; raise ValueError if the system has none there."""
        return self.system_at(value).potential

    def at(self, value: float) -> HeldParameter:
        """Return the parameter held at one value, as an axis of a row or column of a map."""
        return HeldParameter(self.key, value)


@dataclass(frozen=True)
class HeldParameter(_SystemAxis):
    """A parameter held at one value, as an axis of a single row or column of a map along the parameter.

    Parameters
    ----------
    key
        Name of the parameter.
    value
        Value of the parameter, dimensionless.
    """

    key: str
    value: float


def _system_of(potential: Potential) -> System:
    """Return the system that made a potential; ValueError if there is none."""
    if potential.system is None:
        raise ValueError(
            f"system={potential.name}: the parameters of this potential are not known; must be a System, such as "
            "System.from_formula(text, b=0.5), or its potential"
        )
    return potential.system


Axis = Coordinate | Direction | ParameterAxis | HeldParameter
"""An axis of a slice."""

type CoordinateName = Coordinate | str
"""A coordinate as functions accept it: a `Coordinate`, or its name or symbol."""


def checked_coordinate(name: str, value: Any, other_values: str = "") -> Coordinate:
    """Return a `CoordinateName` as a coordinate; ValueError for anything else, with `other_values` that are legal."""
    try:
        return Coordinate(value)
    except ValueError:
        legal = ", ".join(coordinate.key for coordinate in Coordinate)
        raise ValueError(f"{name}={short_repr(value)}: must be one of {legal}{other_values}") from None


Energy = float | tuple[float, float]
"""The energy of a map: h, or its range (low, high) on a slice with an axis h."""


def common_energy(energy: Energy) -> float | None:
    """Return h of all starts of a map; None on a slice with an axis h."""
    return None if isinstance(energy, tuple) else energy


def highest_energy(energy: Energy) -> float:
    """Return the highest h of a map."""
    return energy[1] if isinstance(energy, tuple) else energy


def scaled_energy(energy: Energy, factor: float) -> Energy:
    """Return the energy of a map, multiplied by a factor that converts its unit."""
    return (factor * energy[0], factor * energy[1]) if isinstance(energy, tuple) else factor * energy
