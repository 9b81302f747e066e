"""Starts at the points of a slice, and the lowest energy at which they exist."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.integrator.kernels import slice_starts as kernel
from engine.slices.axes import MOMENTA, STATE, Coordinate, Direction
from engine.systems.potential import Potential

if TYPE_CHECKING:
    from engine.slices.slice import Slice


def compute_states(plane: Slice, potential: Potential, energy: Any, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """Return the starts at points of a slice, of shape (n, 4), see `start_states`."""
    if plane.parameter is not None:
        states = np.full((*np.shape(x), len(STATE)), np.nan)
        for mask, line, line_potential in _lines(plane, x, ordinate):
            line_energy = energy if np.ndim(energy) == 0 else energy[mask]
            states[mask] = compute_states(line, line_potential, line_energy, x[mask], ordinate[mask])
        return states
    start = _coordinates(plane, x, ordinate)
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
    """Return the lowest energy of a start at each point; with an axis h, minus the h of the point: positive if forbidden."""
    if plane.parameter is not None:
        required = np.full(np.shape(x), np.inf)
        for mask, line, line_potential in _lines(plane, x, ordinate):
            required[mask] = compute_required_energy(line, line_potential, x[mask], ordinate[mask])
        return required
    start = _coordinates(plane, x, ordinate)
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


def _coordinates(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> dict[Coordinate, np.ndarray]:
    """Return arrays of the coordinates of starts; the momenta determined by the energy are not set yet."""
    fixed: Mapping[Coordinate, float] = dict(plane.fixed)
    start = {coordinate: np.full_like(x, fixed.get(coordinate, 0.0)) for coordinate in (*STATE, *fixed)}
    # Coordinates are set first; directions move starts from there.
    for axis, along in sorted(zip(plane.axes, (x, ordinate), strict=True), key=lambda pair: isinstance(pair[0], Direction)):
        axis.move(start, along)
    return start


def _fixed_momentum(plane: Slice, start: Mapping[Coordinate, np.ndarray]) -> Any:
    """Return the momentum that the energy does not determine; 0 if the energy determines the speed."""
    if plane.decided is Coordinate.SPEED:
        return 0.0
    (momentum,) = (start[coordinate] for coordinate in MOMENTA if coordinate is not plane.decided)
    return momentum
