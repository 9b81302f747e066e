"""Starts at the points of a slice: a check that each point has one start, the starts, and the lowest energies of starts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.integrator.kernels import slice_starts as kernel
from engine.slices.axes import ANGLES, MOMENTA, STATE, Axis, Coordinate, Direction, ParameterAxis
from engine.systems.potential import Potential

if TYPE_CHECKING:
    from engine.slices.slice import Slice


def default_solved(axes: tuple[Axis, Axis], used: Sequence[Coordinate]) -> Coordinate:
    """Return the coordinate that the energy determines by default."""
    if any(angle in used for angle in ANGLES):
        return Coordinate.SPEED
    return Coordinate.PX if Coordinate.PY in {*used, *_oblique_coordinates(axes)} else Coordinate.PY


def check_coordinates(
    axes: tuple[Axis, Axis], used: Sequence[Coordinate], fixed: Sequence[tuple[Coordinate, float]], decided: Coordinate
) -> None:
    """Raise ValueError unless axes, fixed values and the determined coordinate give one start for each point.

    `used` are the coordinates that are axes or fixed.
    """
    if decided not in (*MOMENTA, Coordinate.SPEED):
        raise ValueError(f"solved={decided.key}: must be px, py or v")
    if problem := _repetition(axes, used, fixed, decided) or _contradiction(axes, used, decided):
        names = ", ".join([*(axis.key for axis in axes), *(c.key for c, _ in fixed), decided.key])
        raise ValueError(f"slice of {names}: {problem}")


def _repetition(
    axes: tuple[Axis, Axis], used: Sequence[Coordinate], fixed: Sequence[tuple[Coordinate, float]], decided: Coordinate
) -> str:
    """Return which rule a coordinate breaks that is used twice, or in a place where it cannot be; empty if there is none."""
    if Coordinate.SPEED in used:
        return "must have no axis and no fixed value of v, which only the energy decides"
    if len({*used, decided}) <= len(used) or any(c is Coordinate.H for c, _ in fixed):
        all_names = ", ".join(coordinate.key for coordinate in Coordinate if coordinate is not Coordinate.SPEED)
        return f"each of {all_names} must be used at most once"
    if len({axis.key for axis in axes}) < 2 or sum(isinstance(axis, ParameterAxis) for axis in axes) > 1:
        return "the axes must be different ones, at most one of them a parameter"
    return ""


def _contradiction(axes: tuple[Axis, Axis], used: Sequence[Coordinate], decided: Coordinate) -> str:
    """Return which rule the axes break together with the determined coordinate, or with each other; empty if there is none."""
    all_used = {*used, *_oblique_coordinates(axes)}
    angle_count = sum(angle in used for angle in ANGLES)
    if decided is Coordinate.SPEED and (any(momentum in all_used for momentum in MOMENTA) or angle_count > 1):
        return "with an angle the energy decides the speed; px, py and another angle must be left out"
    if decided is not Coordinate.SPEED and (angle_count or decided in all_used):
        return f"{decided.key}, which the energy decides, must not be set by an axis or an angle"
    if np.linalg.matrix_rank(_axis_directions(axes)) < sum(isinstance(axis, Direction) or axis in STATE for axis in axes):
        return "the directions of the axes must not be parallel"
    return ""


def _oblique_coordinates(axes: tuple[Axis, Axis]) -> set[Coordinate]:
    """Return the coordinates that change along oblique axes."""
    return {coordinate for axis in axes if isinstance(axis, Direction) for coordinate in axis.components}


def _axis_directions(axes: tuple[Axis, Axis]) -> np.ndarray:
    """Return the directions of the axes in (x, y, px, py), of shape (2, 4); zeros for axes that do not move the state."""
    components = [axis.components if isinstance(axis, Direction) else {axis: 1.0} for axis in axes]
    return np.array([[row.get(coordinate, 0.0) for coordinate in STATE] for row in components])


def compute_states(plane: Slice, potential: Potential, energy: Any, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """Return the starts at points of a slice, of shape (n, 4), see `start_states`."""
    if plane.parameter is not None:
        states = np.full((*np.shape(x), len(STATE)), np.nan)
        for mask, line, line_potential in _lines(plane, x, ordinate):
            line_energy = energy if np.ndim(energy) == 0 else energy[mask]
            states[mask] = compute_states(line, line_potential, line_energy, x[mask], ordinate[mask])
        return states
    start = _start_coordinates(plane, x, ordinate)
    # An overflow far from the origin gives a forbidden start. At the centre of a body, the speed is infinite.
    with np.errstate(over="ignore", invalid="ignore"):
        # In the mass times H, the kinetic energy is ½(px² + py²).
        value = potential.mass * potential.value(start[Coordinate.X], start[Coordinate.Y])
        energies = potential.mass * plane.energies(energy, x, ordinate)
        momentum = kernel.decided_momentum(energies, value, _fixed_momentum(plane, start), plane.sign)
        if plane.decided is not Coordinate.SPEED:
            start[plane.decided] = momentum
        elif Coordinate.THETA in start:
            start[Coordinate.PX], start[Coordinate.PY] = kernel.launch(momentum, start[Coordinate.THETA])
        else:
            position = start[Coordinate.X], start[Coordinate.Y]
            start[Coordinate.PX], start[Coordinate.PY] = kernel.launch_from_radius(*position, momentum, start[Coordinate.BETA])
    return np.column_stack([start[coordinate] for coordinate in STATE])


def compute_required_energy(plane: Slice, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """Return the lowest energy of a start at each point, see `Slice.required_energy`."""
    if plane.parameter is not None:
        required = np.full(np.shape(x), np.inf)
        for mask, line, line_potential in _lines(plane, x, ordinate):
            required[mask] = compute_required_energy(line, line_potential, x[mask], ordinate[mask])
        return required
    start = _start_coordinates(plane, x, ordinate)
    value = potential.mass * potential.value(start[Coordinate.X], start[Coordinate.Y])
    rest_energy = kernel.rest_energy(_fixed_momentum(plane, start), value) / potential.mass
    return rest_energy - plane.energies(0.0, x, ordinate)


def _lines(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> Iterator[tuple[np.ndarray, Slice, Potential]]:
    """Yield, for each value of the parameter that has a potential, the mask of its points, their slice and their potential."""
    axis, axis_index = plane.parameter, plane.parameter_axis
    assert axis is not None
    assert axis_index is not None
    values = np.asarray((x, ordinate)[axis_index])
    for value in np.unique(values).tolist():
        try:
            yield values == value, plane.line(value), axis.potential(value)
        except ValueError:
            continue


def _start_coordinates(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> dict[Coordinate, np.ndarray]:
    """Return arrays of the coordinates of starts; the momenta determined by the energy are not set yet."""
    fixed: Mapping[Coordinate, float] = dict(plane.fixed)
    start = {coordinate: np.full_like(x, fixed.get(coordinate, 0.0)) for coordinate in (*STATE, *fixed)}
    # Coordinates are set first; directions move starts from there.
    for axis, axis_values in sorted(zip(plane.axes, (x, ordinate), strict=True), key=lambda pair: isinstance(pair[0], Direction)):
        axis.set_along_axis(start, axis_values)
    return start


def _fixed_momentum(plane: Slice, start: Mapping[Coordinate, np.ndarray]) -> Any:
    """Return the momentum that the energy does not determine; 0 if the energy determines the speed."""
    if plane.decided is Coordinate.SPEED:
        return 0.0
    (momentum,) = (start[coordinate] for coordinate in MOMENTA if coordinate is not plane.decided)
    return momentum
