"""The ranges of the axes of a slice over its interior: all starts that are neither forbidden nor outside."""

from __future__ import annotations

import math

import numpy as np

from engine.exits.interior import find_joined_points, find_outside_in_well_units
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.slices.axes import (
    ANGLES,
    MOMENTA,
    POSITIONS,
    Axis,
    Coordinate,
    Direction,
    Energy,
    ParameterAxis,
    highest_energy,
    scaled_energy,
)
from engine.slices.slice import Slice
from engine.systems.forms.form import NO_POINTS, NotIsolatedError, UndecidedError
from engine.systems.landscape.hill_component import FARTHEST
from engine.systems.potential import Potential
from engine.systems.well_units import WellUnits

MARGIN = 0.03
"""Margin of the default window on each side, as a share of the size of the interior."""

# In a system with gaps, near which momenta are unbounded: share of the positions whose momenta the window shows.
_SHOWN_MOMENTA_SHARE = 0.9
# Number of positions along an axis from which the range of momenta is found; lines have four times as many points, rays half.
_SCAN_POINTS = 801
# First radius of the search for the interior, in units of the distance of the nearest exit saddle from the origin. The radius is
# doubled while the interior extends to it.
_SEARCH_LENGTHS = 4.0
# Radius at which doubling ends in any case, in units of the distance of the outermost exit saddle.
_SEARCH_SADDLE_DISTANCES = 2.0
# Radius for systems whose saddles are not exits, in units of the distance of the outermost body or critical point.
_SEARCH_BODY_DISTANCES = 2.5
# Number of rays from the origin on which the interior is searched.
_RAYS = 180
# Number of steps of a lattice by which a part of the interior must exceed the ranges of the points on rays, which are not exact.
_FEWEST_STEPS = 2
# Number of blocks of a ray whose points are tested together.
_BLOCKS = 16
# Number of points along a side of the lattice on which the interior of an oblique slice is searched.
_LATTICE_SIDE = 201
# Number of lattices, each around the interior found on the preceding lattice.
_LATTICES = 3

Range = tuple[float, float]
"""The lower and the upper end of an interval."""


def find_axis_ranges(potential: Potential, plane: Slice, energy: Energy) -> list[Range] | None:
    """Return the ranges of both axes over the interior of a slice; None without an interior."""
    units = potential.units
    scaled_potential, scaled_plane = potential.in_well_units, plane.in_well_units(units)
    if any(isinstance(axis, Direction) for axis in plane.axes):
        ranges = _scanned_ranges(scaled_potential, scaled_plane, scaled_energy(energy, 1.0 / units.energy))
    else:
        highest = highest_energy(energy) / units.energy
        positions = _position_ranges(scaled_potential, scaled_plane, highest)
        momenta = _momentum_range(scaled_potential, highest, positions)
        _check_fixed_momentum(potential, energy, plane, positions)
        # For an axis that the window shows whole, this range is not used.
        ranges = [positions.get(axis, momenta) if isinstance(axis, Coordinate) else momenta for axis in scaled_plane.axes]
    if any(not low < high for low, high in ranges):
        return None
    return [(low * unit, high * unit) for (low, high), unit in zip(ranges, plane.axis_units(units), strict=True)]


def is_whole(axis: Axis) -> bool:
    """Return whether the default window shows all of an axis, independent of the interior."""
    return isinstance(axis, ParameterAxis) or axis in (*ANGLES, Coordinate.H)


def window_edges(axis: Axis, energy: Energy, interval: Range) -> Range:
    """Return the edges of a window along an axis on which the interior has this range."""
    if isinstance(axis, ParameterAxis):
        return axis.low, axis.high
    if axis in ANGLES:
        return -np.pi, np.pi
    if axis is Coordinate.H and isinstance(energy, tuple):
        return energy
    return widened(interval)


def widened(interval: Range) -> Range:
    """Return a range with the margin of the default window on each side."""
    low, high = interval
    margin = MARGIN * (high - low)
    return low - margin, high + margin


def exact_unit(axis: Axis, potential: Potential) -> float:
    """Return the unit of an axis with the unrounded unit of time, so that the shape of a window is the same in all user units."""
    mass = potential.mass
    units = WellUnits(potential.units.length, potential.well.exact_time_unit / math.sqrt(mass), mass)
    if isinstance(axis, Direction):
        return 1.0 / float(np.hypot.reduce([value / c.unit(units) for c, value in axis.components.items()]))
    return axis.unit(units)


def _scanned_ranges(potential: Potential, plane: Slice, energy: Energy) -> list[Range]:
    """Search a lattice for the ranges of both axes over the interior of a slice with a direction, in units of the well."""
    radius = 2.0 * _search_radius(potential, highest_energy(energy))
    half_sides = [radius * exact_unit(axis, potential) for axis in plane.axes]
    ranges = [window_edges(axis, energy, (-half_side, half_side)) for axis, half_side in zip(plane.axes, half_sides, strict=True)]
    for _ in range(_LATTICES):
        sides = [np.linspace(low, high, _LATTICE_SIDE) for low, high in ranges]
        points = [side.ravel() for side in np.meshgrid(*sides)]
        states = plane.states(potential, highest_energy(energy), *points)
        real_starts = np.flatnonzero(np.isfinite(states).all(axis=1))
        inside = real_starts[find_outside_in_well_units(potential, highest_energy(energy), *states[real_starts, :2].T) == 0]
        if not inside.size:
            return [(0.0, 0.0), (0.0, 0.0)]
        for index, axis in enumerate(plane.axes):
            if not is_whole(axis):
                step = sides[index][1] - sides[index][0]
                inner_values = points[index][inside]
                ranges[index] = float(inner_values.min() - step), float(inner_values.max() + step)
    return ranges


def _position_ranges(potential: Potential, plane: Slice, energy: float) -> dict[Coordinate, Range]:
    """Return the ranges of x and y over the interior of a slice; both ends of a coordinate that is not an axis are its value."""
    if set(POSITIONS) == set(plane.axes):
        points = _interior_points(potential, energy)
        return dict(zip(POSITIONS, map(_rounded_range, points), strict=True))
    fixed = dict.fromkeys(POSITIONS, 0.0) | dict(plane.fixed)
    return {
        coordinate: _rounded_range(_interior_interval(potential, energy, coordinate, fixed))
        if coordinate in plane.axes
        else (fixed[coordinate], fixed[coordinate])
        for coordinate in POSITIONS
    }


def _check_fixed_momentum(potential: Potential, energy: Energy, plane: Slice, ranges: dict[Coordinate, Range]) -> None:
    """Raise ValueError if a fixed momentum exceeds the largest momentum in `ranges`, those of x and y in units of the well."""
    units = potential.units
    highest = highest_energy(energy) / units.energy
    x, y = np.meshgrid(*(np.linspace(*ranges[coordinate], _LATTICE_SIDE) for coordinate in POSITIONS))
    largest = units.momentum * float(np.sqrt(2.0 * max(highest - np.nanmin(potential.in_well_units.value(x, y)), 0.0)))
    for coordinate, value in plane.fixed:
        if coordinate in MOMENTA and abs(value) > largest:
            raise ValueError(
                f"{coordinate.key}={value:.6g}: no start on {plane.title} has a real {plane.decided.key} at "
                f"energy={highest_energy(energy):.6g}; must be at most {largest:.4g} in magnitude"
            )


def _momentum_range(potential: Potential, energy: float, ranges: dict[Coordinate, Range]) -> Range:
    """Return the range of px and py in the ranges of x and y, limited for a system with gaps, near which it is unbounded."""
    x, y = (np.linspace(*ranges[coordinate], _SCAN_POINTS) for coordinate in POSITIONS)
    value = potential.value(x, y)
    bottom = np.quantile(value[np.isfinite(value)], 1.0 - _SHOWN_MOMENTA_SHARE) if potential.gaps else np.min(value)
    momentum = float(np.sqrt(2.0 * max(energy - bottom, 0.0)))
    return -momentum, momentum


def _interior_interval(potential: Potential, energy: float, axis: Coordinate, fixed: dict[Coordinate, float]) -> np.ndarray:
    """Return the values of `axis`, x or y, of interior points on the line where the other coordinate is fixed, of shape (n,)."""
    radius = _search_radius(potential, energy)
    line = np.linspace(-radius, radius, 4 * _SCAN_POINTS)
    x, y = (line if axis is coordinate else np.full_like(line, fixed[coordinate]) for coordinate in POSITIONS)
    if not potential.escapes_over_saddles:
        return line[_without_outside(potential, energy, x, y, _is_allowed(potential, energy, x, y))]
    middle = line.size // 2
    sides = (np.s_[None, middle - 1 :: -1], np.s_[None, middle + 1 :])
    before, after = (np.count_nonzero(_inside_from_middle(potential, energy, x[side], y[side])) for side in sides)
    seen = line[middle - before : middle + 1 + after]
    points, distance = find_joined_points(potential, energy, radius)
    along, across = POSITIONS.index(axis), 1 - POSITIONS.index(axis)
    points = points[:, np.abs(points[across] - fixed[POSITIONS[across]]) < 0.5 * distance]
    points[across] = fixed[POSITIONS[across]]
    hidden = points[:, _extends(points[along], seen, distance) & _is_allowed(potential, energy, *points)]
    hidden = hidden[:, find_outside_in_well_units(potential, energy, *hidden) == 0]
    return np.concatenate([seen, hidden[along] - distance, hidden[along] + distance])


def _extends(values: np.ndarray, seen: np.ndarray, distance: float) -> np.ndarray:
    """Return which coordinates of lattice points are beyond the range of coordinates that rays from the origin reach."""
    margin = _FEWEST_STEPS * distance
    return (values < seen.min(initial=np.inf) - margin) | (values > seen.max(initial=-np.inf) + margin)


def _is_allowed(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return whether V ≤ h at points, or V is undefined, as at the centre of a gap."""
    return ~(potential.value(x, y) > energy)


def _without_outside(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray, allowed: np.ndarray) -> np.ndarray:
    """Return which of the allowed points are not beyond an exit; gaps in an interior count as inside."""
    outside = find_outside_in_well_units(potential, energy, x[allowed], y[allowed])
    gap_numbers = [number for number, end in enumerate(potential.ends, potential.channels + 1) if end in potential.gaps]
    inside = allowed.copy()
    inside[allowed] = np.isin(outside, [0, *gap_numbers])
    return inside


def _search_radius(potential: Potential, energy: float) -> float:
    """Return a radius that contains the interior; with exits, unless the energy is many times the escape energy."""
    if potential.escape_radius is not None:
        return _shown_radius(potential, potential.escape_radius)
    distances = np.hypot(*potential.saddles.T)
    # The rounded units of the well are not used here, so that the edges do not depend on the user's units.
    nearest, outermost = (float(distances.min()), float(distances.max())) if distances.size else (1.0, FARTHEST)
    radius = _SEARCH_LENGTHS * nearest
    # The search does not begin at the outermost saddle, which may be so far away that all points miss the interior.
    while radius < _SEARCH_SADDLE_DISTANCES * outermost and _interior_on_rays(potential, energy, radius)[2][:, -1].any():
        radius *= 2.0
    return radius


def _interior_on_rays(potential: Potential, energy: float, farthest: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x, y and whether points on rays from the origin are inside, each of shape (rays, n).

    Without an escape radius, no point of a ray beyond its first point outside is inside.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    radius = np.linspace(0.0, farthest, _SCAN_POINTS // 2)
    x, y = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    if not potential.escapes_over_saddles:
        return x, y, _without_outside(potential, energy, x, y, _is_allowed(potential, energy, x, y))
    return x, y, _inside_from_middle(potential, energy, x, y)


def _inside_from_middle(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return which points on rays outward, of shape (rays, n), come before the first forbidden or outside point of their ray."""
    inside = np.logical_and.accumulate(_is_allowed(potential, energy, x, y), axis=1)
    # Points beyond an exit take longest to test, so that each ray is tested up to the end of the block in which it ends.
    length = math.ceil(x.shape[1] / _BLOCKS)
    for begin in range(0, x.shape[1], length):
        block = np.s_[:, begin : begin + length]
        if begin:
            inside[block] &= inside[:, begin - 1 : begin]
        if not inside[block].any():
            inside[:, begin:] = False
            break
        inside[block] = np.logical_and.accumulate(_without_outside(potential, energy, x[block], y[block], inside[block]), axis=1)
    return inside


def _shown_radius(potential: Potential, escape_radius: float) -> float:
    """Return a radius that contains the bodies and critical points of a system with an escape radius, with some margin."""
    positions = [*_known_critical_points(potential).tolist(), *((end.x, end.y) for end in potential.ends)]
    outermost = max((float(np.hypot(*position)) for position in positions), default=0.0)
    return min(_SEARCH_BODY_DISTANCES * outermost, escape_radius) if outermost else escape_radius


def _known_critical_points(potential: Potential) -> np.ndarray:
    """Return the critical points, (n, 2); none if they form a curve or are not found within the limit on the work."""
    try:
        return potential.critical_points
    except (NotIsolatedError, UndecidedError):
        return NO_POINTS


def _interior_points(potential: Potential, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y of points inside, and of the points of the Lyapunov orbits, (n,) each.

    The points are those on rays from the origin, and beyond their ranges those of a lattice, as in a bent well.
    """
    radius = _search_radius(potential, energy)
    x, y, inside = _interior_on_rays(potential, energy, radius)
    x, y = x[inside], y[inside]
    if x.size == 0 or not x.min() < x.max():
        return np.empty(0), np.empty(0)
    orbits = find_orbits_in_well_units(potential, energy)
    x, y = np.concatenate([x, *(orbit.x for orbit in orbits)]), np.concatenate([y, *(orbit.y for orbit in orbits)])
    if not potential.escapes_over_saddles:
        return x, y
    points, distance = find_joined_points(potential, energy, radius)
    points = points[:, _extends(points[0], x, distance) | _extends(points[1], y, distance)]
    hidden = points[:, find_outside_in_well_units(potential, energy, *points) == 0]
    x, y = (np.concatenate([seen, each - distance, each + distance]) for seen, each in zip((x, y), hidden, strict=True))
    return x, y


def _rounded_range(values: np.ndarray) -> Range:
    """Return the smallest and the largest value, to 12 decimals, so that the window of a symmetric interior is symmetric."""
    if not values.size:
        return 0.0, 0.0
    return round(float(values.min()), 12), round(float(values.max()), 12)
