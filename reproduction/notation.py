"""Names of slices and axes as in the paper, in Matplotlib's math notation."""

from __future__ import annotations

from engine import Coordinate, Slice

_SYMBOLS = {
    Coordinate.X: "x", Coordinate.Y: "y", Coordinate.PX: r"\dot{x}", Coordinate.PY: r"\dot{y}", Coordinate.H: "h"
}  # fmt: skip


def axis_label(axis: Coordinate) -> str:
    """Name of an axis."""
    return f"${_SYMBOLS[axis]}$"


def plane_label(plane: Slice) -> str:
    """Name of a slice by its axes."""
    return f"$({_SYMBOLS[plane.abscissa]}, {_SYMBOLS[plane.ordinate]})$"
