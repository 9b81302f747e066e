"""The axes of a sweep: the energy, the Jacobi constant, or a parameter of the system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any

from engine.foundations.validation import short_repr
from engine.slices.axes import Coordinate, ParameterAxis
from engine.slices.slice import Slice
from engine.slices.slice_text import write_slice
from engine.systems.potential import Potential

AXIS_SEPARATOR = ", "
"""Text between the axes of a sweep in an attribute."""

# Largest number of axes of a sweep.
_MOST_AXES = 2


class EnergyAxis(Enum):
    """A quantity that sets the energy of the maps of a sweep. Functions accept its name, such as "jacobi", in its place.

    `H` is the energy h, and `JACOBI` the Jacobi constant C of a rotating frame, see `Potential.jacobi_constant`.
    """

    H = "h"
    JACOBI = "jacobi"

    @property
    def key(self) -> str:
        """The name in files and on the command line."""
        return self.value

    @property
    def symbol(self) -> str:
        """The symbol in texts and on axes."""
        return {"jacobi": "C"}.get(self.value, self.value)

    def energy(self, potential: Potential, value: float) -> float:
        """Return h at a value of the quantity; ValueError for a Jacobi constant in a frame that does not rotate."""
        return value if self is EnergyAxis.H else float(potential.jacobi_energy(value))


type SweepAxis = ParameterAxis | EnergyAxis
"""An axis of a sweep."""


def checked_axes(along: Any) -> tuple[SweepAxis, ...]:
    """Return the axes of a sweep, given as one axis, as a pair of axes, or as None for the energy; ValueError for others."""
    given = along if isinstance(along, tuple | list) else [EnergyAxis.H if along is None else along]
    axes = tuple(map(_checked_axis, given))
    energies = [axis for axis in axes if isinstance(axis, EnergyAxis)]
    if not 1 <= len(axes) <= _MOST_AXES or len(energies) > 1 or len({axis.key for axis in axes}) < len(axes):
        legal = "one axis, or a pair of different axes of which at most one is h or jacobi"
        raise ValueError(f"along={', '.join(axis.key for axis in axes) or '()'}: must be {legal}")
    if len({axis.system for axis in axes if isinstance(axis, ParameterAxis)}) > 1:
        raise ValueError(f"along={', '.join(axis.key for axis in axes)}: both parameters must be of the same system")
    return axes


def axis_names(attributes: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the names of the axes of a sweep from the attributes of its dataset."""
    return tuple(str(attributes["axis"]).split(AXIS_SEPARATOR))


def coarse_to_fine(values: Sequence[float]) -> list[float]:
    """Return the values in another order: the ends first, and then repeatedly the midpoints."""
    count = len(values)
    order = [0, count - 1]
    # The smallest power of 2 above the last index.
    step = 1 << (count - 1).bit_length()
    while step > 1:
        step //= 2
        order += range(step, count, 2 * step)
    # `dict.fromkeys` drops repeated indices.
    return [values[index] for index in dict.fromkeys(order)]


def write_axes(axes: tuple[SweepAxis, ...]) -> str:
    """Return axes as text for attributes, which do not mention the energy h."""
    texts = [write_slice(Slice(Coordinate.X, axis))[0] if isinstance(axis, ParameterAxis) else axis.key for axis in axes]
    return "; ".join(text for text in texts if text != EnergyAxis.H.key)


def _checked_axis(axis: Any) -> SweepAxis:
    if isinstance(axis, ParameterAxis):
        return axis
    try:
        return EnergyAxis(axis)
    except ValueError:
        legal = ", ".join(each.key for each in EnergyAxis)
        raise ValueError(f"along={short_repr(axis)}: must be one of {legal}, a ParameterAxis, or a pair of these") from None
