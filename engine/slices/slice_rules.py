"""Conditions on the coordinates of a slice under which each point is one start."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.slices.axes import ANGLES, MOMENTA, STATE, Axis, Coordinate, Direction, ParameterAxis


def momentum_left(axes: tuple[Axis, Axis], used: Sequence[Coordinate]) -> Coordinate:
    """Return the coordinate that the energy determines by default."""
    if any(angle in used for angle in ANGLES):
        return Coordinate.SPEED
    components = {c for axis in axes if isinstance(axis, Direction) for c in axis.components}
    return Coordinate.PX if Coordinate.PY in {*used, *components} else Coordinate.PY


def check_coordinates(
    axes: tuple[Axis, Axis], used: Sequence[Coordinate], fixed: Sequence[tuple[Coordinate, float]], decided: Coordinate
) -> None:
    """Raise ValueError unless axes, fixed values and the determined coordinate give one start for each point.

    `used` are the coordinates that are axes or fixed.
    """
    if decided not in (*MOMENTA, Coordinate.SPEED):
        raise ValueError(f"solved={decided.key}: must be px, py or v")
    all_names = ", ".join(coordinate.key for coordinate in Coordinate if coordinate is not Coordinate.SPEED)
    names = ", ".join([*(axis.key for axis in axes), *(c.key for c, _ in fixed), decided.key])
    if Coordinate.SPEED in used:
        raise ValueError(f"slice of {names}: must have no axis and no fixed value of v, which only the energy decides")
    if len({*used, decided}) <= len(used) or any(c is Coordinate.H for c, _ in fixed):
        raise ValueError(f"slice of {names}: each of {all_names} must be used at most once")
    if len({axis.key for axis in axes}) < 2 or sum(isinstance(axis, ParameterAxis) for axis in axes) > 1:
        raise ValueError(f"slice of {names}: the axes must be different ones, at most one of them a parameter")
    components = {c for axis in axes if isinstance(axis, Direction) for c in axis.components}
    all_used = {*used, *components}
    angle_count = sum(angle in used for angle in ANGLES)
    if decided is Coordinate.SPEED and (any(momentum in all_used for momentum in MOMENTA) or angle_count > 1):
        raise ValueError(
            f"slice of {names}: with an angle the energy decides the speed; px, py and another angle must be left out"
        )
    if decided is not Coordinate.SPEED and (angle_count or decided in all_used):
        raise ValueError(f"slice of {names}: {decided.key}, which the energy decides, must not be set by an axis or an angle")
    if np.linalg.matrix_rank(_rows_of(axes)) < sum(_moves_state(axis) for axis in axes):
        raise ValueError(f"slice of {names}: the directions of the axes must not be parallel")


def _moves_state(axis: Axis) -> bool:
    return isinstance(axis, Direction) or axis in STATE


def _rows_of(axes: tuple[Axis, Axis]) -> np.ndarray:
    """Return the directions of the axes in (x, y, px, py), of shape (2, 4); zeros for axes of other kinds."""
    components = [axis.components if isinstance(axis, Direction) else {axis: 1.0} for axis in axes]
    return np.array([[row.get(coordinate, 0.0) for coordinate in STATE] for row in components])
