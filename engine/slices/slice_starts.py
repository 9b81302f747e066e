"""Starts at the points of a slice, and the energy that they need."""

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
        for here, line, each in _lines(plane, x, ordinate):
            states[here] = compute_states(line, each, energy if np.ndim(energy) == 0 else energy[here], x[here], ordinate[here])
        return states
    start = _coordinates(plane, x, ordinate)
    with np.errstate(over="ignore", invalid="ignore"):
        # An overflow far from the origin gives a forbidden start.
        # In the mass times H, the kinetic energy is ½(px² + py²).
        value = potential.mass * potential.value(start[Coordinate.X], start[Coordinate.Y])
        energies = potential.mass * plane.energies(energy, x, ordinate)
        found = kernel.decided_momentum(energies, value, _held_momentum(plane, start), plane.sign)
        # At the centre of a body the speed is infinite.
        if plane.decided is not Coordinate.SPEED:
            start[plane.decided] = found
        elif Coordinate.THETA in start:
            start[Coordinate.PX], start[Coordinate.PY] = kernel.launch(found, start[Coordinate.THETA])
        else:
            place = start[Coordinate.X], start[Coordinate.Y]
            start[Coordinate.PX], start[Coordinate.PY] = kernel.launch_from_radius(*place, found, start[Coordinate.BETA])
    return np.column_stack([start[coordinate] for coordinate in STATE])


def compute_required_energy(plane: Slice, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """Return the lowest energy of a start; with an axis h, relative to the h of its point: positive if forbidden."""
    if plane.parameter is not None:
        required = np.full(np.shape(x), np.inf)
        for here, line, each in _lines(plane, x, ordinate):
            required[here] = compute_required_energy(line, each, x[here], ordinate[here])
        return required
    start = _coordinates(plane, x, ordinate)
    value = potential.mass * potential.value(start[Coordinate.X], start[Coordinate.Y])
    at_rest = kernel.rest_energy(_held_momentum(plane, start), value) / potential.mass
    lowest: np.ndarray = at_rest - plane.energies(0.0, x, ordinate)
    return lowest


def _lines(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> Iterator[tuple[np.ndarray, Slice, Potential]]:
    """Yield the mask of the points, their slice and their potential for each value of the parameter that has a potential."""
    axis, place = plane.parameter, plane.parameter_axis
    assert axis is not None
    assert place is not None
    values = np.asarray((x, ordinate)[place])
    for value in np.unique(values).tolist():
        try:
            yield values == value, plane.line(value), axis.potential(value)
        except ValueError:
            continue


def _coordinates(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> dict[Coordinate, np.ndarray]:
    """Return arrays of the coordinates of starts; the momenta determined by the energy are not set yet."""
    held: Mapping[Coordinate, float] = dict(plane.fixed)
    start = {coordinate: np.full_like(x, held.get(coordinate, 0.0)) for coordinate in (*STATE, *held)}
    # Coordinates are set first; directions move starts from there.
    for axis, along in sorted(zip(plane.axes, (x, ordinate), strict=True), key=lambda pair: isinstance(pair[0], Direction)):
        axis.move(start, along)
    return start


def _held_momentum(plane: Slice, start: Mapping[Coordinate, np.ndarray]) -> Any:
    """Return the momentum that the energy does not determine; 0 if the energy determines the speed."""
    if plane.decided is Coordinate.SPEED:
        return 0.0
    (held,) = (start[momentum] for momentum in MOMENTA if momentum is not plane.decided)
    return held
