"""Slices as two texts for addresses and the command line: axes, "x,epsilon=0.5:2", and fixed values, "y=0.1,py=-"."""

from __future__ import annotations

from engine.foundations.validation import short_repr
from engine.slices.axes import STATE, Axis, Coordinate, Direction, ParameterAxis
from engine.slices.planes import Plane, checked_slice
from engine.slices.slice import Slice
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import System

AXIS_NAMES = tuple(coordinate.key for coordinate in Coordinate if coordinate is not Coordinate.SPEED)
"""Names of the coordinates that can be axes."""

_COORDINATES = {coordinate.key: coordinate for coordinate in Coordinate}
# Keys of coordinates and parameters, by the other names that are accepted.
_ALIASES = {
    **{coordinate.symbol: coordinate.key for coordinate in Coordinate},
    **{parameter.symbol: key for key, parameter in WELL_PARAMETERS.items()},
    "eps": "epsilon",
}
_SIGNS = {"+": 1, "-": -1}
# Number of values in the text of a parameter.
_RANGE_SIZE = 2
# Number of values in the text of a direction.
_COMPONENT_COUNT = len(STATE)


def write_slice(plane: Slice) -> tuple[str, str]:
    """Return the texts of a slice at full precision, from which `read_slice` restores it.

    Returns
    -------
    The axes, or the key of a named slice, and the fixed values. The second text is empty if all fixed values, the determined
    momentum and its sign are the defaults.
    """
    if isinstance(plane, Plane):
        return plane.key, ""
    parts = [f"{coordinate.key}={value!r}" for coordinate, value in plane.fixed]
    if plane != Slice(plane.abscissa, plane.ordinate, fixed=plane.fixed):
        parts.append(f"{plane.decided.key}={'+' if plane.sign > 0 else '-'}")
    return ",".join(map(_write_axis, plane.axes)), ",".join(parts)


def read_slice(axes: str, fixed_values: str, system: System) -> Slice:
    """Return the slice given by two texts, in which parameters of `system` can be axes.

    Parameters
    ----------
    axes
        The key of a named slice, "x_px", or abscissa and ordinate, "x,theta": x, y, px, py, theta, beta, h, a parameter of the
        system with its range, "epsilon=0.5:2", or a direction with its components along x, y, px and py, "u=1:0.3:0:0".
    fixed_values
        Values of the other coordinates, "y=0.1,px=0", by default 0; "py=-" if the energy determines py, with a negative sign.
    system
        The system of the picture.

    Raises
    ------
    ValueError
        If a text is not legal; the message names the part, its value and the legal values.
    """
    if axes in {plane.key for plane in Plane}:
        if fixed_values:
            raise ValueError(f"fix={short_repr(fixed_values)}: must be left out for {axes}; give two axes such as x,py instead")
        return checked_slice(axes)
    if axes.count(",") != 1:
        keys = ", ".join(plane.key for plane in Plane)
        raise ValueError(f"axes={short_repr(axes)}: must be one of {keys}, or two axes such as x,py")
    abscissa, ordinate = (_read_axis(text, system) for text in axes.split(","))
    fixed: list[tuple[Coordinate, float]] = []
    solved, sign = None, 1
    for part in fixed_values.split(",") if fixed_values else ():
        name, _, value = part.partition("=")
        coordinate = _COORDINATES.get(_without_alias(name))
        if coordinate is None:
            raise ValueError(f"fix={short_repr(part)}: must be one of {', '.join(_COORDINATES)} with a number, such as y=0.1")
        if value in _SIGNS:
            solved, sign = coordinate, _SIGNS[value]
        else:
            fixed.append((coordinate, _read_number("fix", part, value)))
    return checked_slice(Slice(abscissa, ordinate, solved, sign, tuple(fixed)))


def default_range(system: System, name: str) -> tuple[float, float]:
    """Return a legal range of a parameter: from half to twice its value in the system, or from −1 to 1 if this value is 0."""
    value = system.value_of(name)
    low, high = sorted((0.5 * value, 2.0 * value)) if value else (-1.0, 1.0)
    lowest, highest = system.range_of(name)
    return max(low, lowest), min(high, highest)


def _write_axis(axis: Axis) -> str:
    if isinstance(axis, ParameterAxis):
        return f"{axis.key}={axis.low!r}:{axis.high!r}"
    if isinstance(axis, Direction):
        return f"{axis.key}={':'.join(repr(getattr(axis, coordinate.key)) for coordinate in STATE)}"
    return axis.key


def _read_axis(text: str, system: System) -> Axis:
    name, _, numbers = text.partition("=")
    key = _without_alias(name)
    if key in AXIS_NAMES and not numbers:
        return _COORDINATES[key]
    values = [_read_number("axes", text, number) for number in numbers.split(":")] if numbers else []
    if key in system.parameter_names and len(values) in (0, _RANGE_SIZE):
        low, high = values or default_range(system, key)
        return ParameterAxis(key, low, high, system)
    if len(values) == _COMPONENT_COUNT:
        return Direction(key, *values)
    legal = ", ".join([*AXIS_NAMES, *system.parameter_names])
    raise ValueError(f"axes={short_repr(text)}: must be one of {legal}, or a name with a range or with four components")


def _without_alias(name: str) -> str:
    stripped = name.strip()
    return _ALIASES.get(stripped, stripped)


def _read_number(parameter: str, text: str, number: str) -> float:
    """Return the number in a part of a text; ValueError, with the name of the parameter, if the part is not a number."""
    try:
        return float(number)
    except ValueError:
        raise ValueError(f"{parameter}={short_repr(text)}: {short_repr(number)} must be a number") from None
