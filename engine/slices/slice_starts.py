"""The starts of the points of a slice, and the energy that they need."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.slices.axes import MOMENTA, STATE, Coordinate, Direction
from engine.systems.potential import Potential

if TYPE_CHECKING:
    from engine.slices.slice import Slice


def compute_states(plane: Slice, potential: Potential, energy: Any, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """(n, 4) the starts of points of a slice; parameters as in `start_states`."""
    if plane.parameter is not None:
        states = np.full((*np.shape(x), len(STATE)), np.nan)
        for here, line, each in _lines(plane, x, ordinate):
            states[here] = compute_states(line, each, energy if np.ndim(energy) == 0 else energy[here], x[here], ordinate[here])
        return states
    start = _coordinates(plane, x, ordinate)
    with np.errstate(over="ignore", invalid="ignore"):
        # An overflow far from the origin gives a forbidden start.
        left = plane.energies(energy, x, ordinate) - potential.value(start[Coordinate.X], start[Coordinate.Y])
        doubled = 2.0 * left - _square_of_others(plane, start)
    found = plane.sign * np.sqrt(np.where(doubled >= 0, doubled, np.nan))
    if plane.decided is Coordinate.SPEED:
        with np.errstate(invalid="ignore"):
            # At the centre of a body the speed is infinite.
            start[Coordinate.PX], start[Coordinate.PY] = _velocity(start, found)
    else:
        start[plane.decided] = found
    return np.column_stack([start[coordinate] for coordinate in STATE])


def compute_required_energy(plane: Slice, potential: Potential, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """The lowest energy at which a start exists; with an axis h, the energy missing there, positive where forbidden."""
    if plane.parameter is not None:
        required = np.full(np.shape(x), np.inf)
        for here, line, each in _lines(plane, x, ordinate):
            required[here] = compute_required_energy(line, each, x[here], ordinate[here])
        return required
    start = _coordinates(plane, x, ordinate)
    kinetic = 0.5 * _square_of_others(plane, start) - plane.energies(0.0, x, ordinate)
    lowest: np.ndarray = kinetic + potential.value(start[Coordinate.X], start[Coordinate.Y])
    return lowest


def _lines(plane: Slice, x: np.ndarray, ordinate: np.ndarray) -> Iterator[tuple[np.ndarray, Slice, Potential]]:
    """For each value of the parameter at which there is a system: where points have it, their slice, and their potential."""
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
    """Arrays of the coordinates of starts, where the momenta that the energy decides are not set yet."""
    held: Mapping[Coordinate, float] = dict(plane.fixed)
    start = {coordinate: np.full_like(x, held.get(coordinate, 0.0)) for coordinate in (*STATE, *held)}
    # Coordinates are set, directions move from there.
    for axis, along in sorted(zip(plane.axes, (x, ordinate), strict=True), key=lambda pair: isinstance(pair[0], Direction)):
        axis.move(start, along)
    return start


def _square_of_others(plane: Slice, start: Mapping[Coordinate, np.ndarray]) -> Any:
    """The square of the momentum that the energy does not decide; 0 if it decides both."""
    if plane.decided is Coordinate.SPEED:
        return 0.0
    (other,) = (start[momentum] for momentum in MOMENTA if momentum is not plane.decided)
    return other * other


def _velocity(start: Mapping[Coordinate, np.ndarray], speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """px and py of starts with an angle and a speed (n,)."""
    if Coordinate.THETA in start:
        angle = start[Coordinate.THETA]
        return speed * np.cos(angle), speed * np.sin(angle)
    x, y, angle = start[Coordinate.X], start[Coordinate.Y], start[Coordinate.BETA]
    radius = np.hypot(x, y)
    # At the origin, where no direction is radial, that of the +y axis is taken, which is its own mirror image under x → −x.
    away_x, away_y = np.where(radius > 0, (x, y) / np.where(radius > 0, radius, 1.0), np.array([[0.0], [1.0]]))
    cosine, sine = np.cos(angle), np.sin(angle)
    return speed * (cosine * away_x - sine * away_y), speed * (cosine * away_y + sine * away_x)
