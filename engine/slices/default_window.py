"""The window that shows the whole interior of a slice: all starts that are neither forbidden nor outside."""

from __future__ import annotations

import functools

import numpy as np

from engine.exits.interior import find_outside_channels
from engine.exits.lyapunov_orbits import find_lyapunov_orbits
from engine.potentials.potential import Potential
from engine.slices.slice import Coordinate, Energy, Slice, checked_slice, highest_energy
from engine.slices.window import Window

# Margin of the default window on each side, as a share of the size of the interior.
_MARGIN = 0.03
_SCAN_POINTS = 801
# The interior is searched up to this distance from the origin: in units of the well, and of the distance of the
# outermost exit saddle.
_SEARCH_LENGTHS = 4.0
_SEARCH_SADDLE_DISTANCES = 2.0
_RAYS = 180

Range = tuple[float, float]


def default_window(potential: Potential, plane: Slice, energy: Energy) -> Window:
    """A window that shows the whole interior: all starts that are neither forbidden nor outside.

    Parameters
    ----------
    potential
        The potential.
    plane
        The slice, such as a `Plane`.
    energy
        h, dimensionless; on a slice with an axis h the pair (lowest, highest).

    Returns
    -------
    The window; on a slice of one energy it is a square in units of the well.

    Raises
    ------
    ValueError
        If an energy is out of range, or there is no interior at this energy.

    Examples
    --------
    >>> from engine import CASES, Plane, default_window
    >>> window = default_window(CASES["III"], Plane.X_PX, 0.45)
    >>> round(window.x_low, 4), round(window.x_high, 4)
    (-1.0056, 1.0056)
    """
    chosen = checked_slice(plane)
    return _default_window(potential, chosen, chosen.checked_energy(energy))


@functools.lru_cache(maxsize=1024)
def _default_window(potential: Potential, plane: Slice, energy: Energy) -> Window:
    units, highest = potential.units, highest_energy(energy)
    well, well_energy = potential.in_well_units, highest / units.energy
    ranges = _position_ranges(well, plane.in_well_units(units), well_energy)
    if any(not ranges[axis][0] < ranges[axis][1] for axis in plane.axes if axis in ranges):
        raise ValueError(f"energy={highest}: the interior is empty; must be at least about 1e-5 above the minimum of the well")
    momenta = _momentum_range(well, well_energy, ranges)
    first, second = (ranges.get(axis, momenta) for axis in plane.axes)
    if isinstance(energy, tuple):
        edges = [_widened(first, plane.axis_units(units)[0]), _widened(second, plane.axis_units(units)[1])]
        edges[plane.axes.index(Coordinate.H)] = energy
        return Window(*edges[0], *edges[1])
    return _square_window(*first, *second).scaled(*plane.axis_units(units))


def _position_ranges(potential: Potential, plane: Slice, energy: float) -> dict[Coordinate, Range]:
    """The ranges of x and y over the interior of a slice; of a coordinate that is no axis, its value twice."""
    if {Coordinate.X, Coordinate.Y} == set(plane.axes):
        points = _interior_points(potential, energy)
        return dict(zip((Coordinate.X, Coordinate.Y), map(_rounded_range, points), strict=True))
    held = {Coordinate.X: 0.0, Coordinate.Y: 0.0} | dict(plane.fixed)
    return {
        coordinate: _rounded_range(_interior_interval(potential, energy, coordinate, held))
        if coordinate in plane.axes
        else (held[coordinate], held[coordinate])
        for coordinate in (Coordinate.X, Coordinate.Y)
    }


def _momentum_range(potential: Potential, energy: float, ranges: dict[Coordinate, Range]) -> Range:
    """The range of a momentum of the starts between these positions."""
    x, y = (np.linspace(*ranges[coordinate], _SCAN_POINTS) for coordinate in (Coordinate.X, Coordinate.Y))
    momentum = float(np.sqrt(2.0 * max(energy - np.min(potential.value(x, y)), 0.0)))
    return -momentum, momentum


def _widened(interval: Range, unit: float) -> Range:
    low, high = interval
    margin = _MARGIN * (high - low)
    return unit * (low - margin), unit * (high + margin)


def _square_window(x_low: float, x_high: float, low: float, high: float) -> Window:
    half = 0.5 * max(x_high - x_low, high - low) * (1.0 + 2.0 * _MARGIN)
    x, ordinate = 0.5 * (x_low + x_high), 0.5 * (low + high)
    return Window(x - half, x + half, ordinate - half, ordinate + half)


def _run_around_middle(allowed: np.ndarray) -> slice:
    """The run of True values around the middle of an array."""
    middle = allowed.size // 2
    blocked = np.flatnonzero(~allowed)
    low = blocked[blocked < middle].max(initial=-1) + 1
    high = blocked[blocked > middle].min(initial=allowed.size)
    return slice(low, high)


def _interior_interval(potential: Potential, energy: float, axis: Coordinate, held: dict[Coordinate, float]) -> np.ndarray:
    """(n,) x or y of the interior on the line on which the other one is held, with a resolution of about a thousandth."""
    radius = _search_radius(potential)
    line = np.linspace(-radius, radius, 4 * _SCAN_POINTS)
    x, y = (line if axis is coordinate else np.full_like(line, held[coordinate]) for coordinate in (Coordinate.X, Coordinate.Y))
    outside = find_outside_channels(potential, energy, x, y)
    return line[_run_around_middle((potential.value(x, y) <= energy) & (outside == 0))]


def _search_radius(potential: Potential) -> float:
    """A radius that contains the interior, unless the energy is many times the escape energy."""
    outermost = float(np.hypot(*potential.saddles.T).max(initial=0.0))
    return max(_SEARCH_LENGTHS, _SEARCH_SADDLE_DISTANCES * outermost)


def _interior_points(potential: Potential, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """(n,) x and y of points of the interior of the (x, y) plane, on rays that start at the origin, and of the exits."""
    angle = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    radius = np.linspace(0.0, _search_radius(potential), _SCAN_POINTS // 2)
    x, y = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    outside = find_outside_channels(potential, energy, x, y)
    inside = np.logical_and.accumulate((potential.value(x, y) <= energy) & (outside == 0), axis=1)
    x, y = x[inside], y[inside]
    if x.size == 0 or not x.min() < x.max():
        return np.empty(0), np.empty(0)
    orbits = find_lyapunov_orbits(potential, energy)
    return np.concatenate([x, *(orbit.x for orbit in orbits)]), np.concatenate([y, *(orbit.y for orbit in orbits)])


def _rounded_range(coordinate: np.ndarray) -> Range:
    """The smallest and the largest value, to 12 decimals, so that the window of a symmetric interior is symmetric."""
    if not coordinate.size:
        return 0.0, 0.0
    return round(float(coordinate.min()), 12), round(float(coordinate.max()), 12)
