"""The window that shows the whole interior of a slice: all starts that are neither forbidden nor outside."""

from __future__ import annotations

import functools
import math

import numpy as np

from engine.exits.interior import find_outside_in_well_units
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.slices.axes import (
    ANGLES,
    MOMENTA,
    Axis,
    Coordinate,
    Direction,
    Energy,
    ParameterAxis,
    common_energy,
    highest_energy,
    scaled_energy,
)
from engine.slices.slice import Slice
from engine.slices.window import Window
from engine.systems.forms.form import NO_POINTS, NotIsolatedError, UndecidedError
from engine.systems.potential import Potential
from engine.systems.well_units import WellUnits

# Margin of the default window on each side, as a share of the size of the interior.
_MARGIN = 0.03
# If the sides of an interior, in units of the well, differ by more than this factor, each side of the window has its own scale.
_LARGEST_ASPECT = 4.0
# For a system with gaps, near which momenta are unbounded, the window shows the momenta of this share of points between edges.
_SHOWN_MOMENTA = 0.9
# Number of positions from which the range of momenta is found. Lines have four times as many points, rays half as many.
_SCAN_POINTS = 801
# First radius of the search for the interior, in units of the distance of the nearest exit saddle from the origin. The radius
# is doubled while the interior reaches further.
_SEARCH_LENGTHS = 4.0
# Doubling ends at the latest when the radius exceeds this many times the distance of the outermost exit saddle.
_SEARCH_SADDLE_DISTANCES = 2.0
# For systems whose saddles are not exits, the radius in units of the distance of the outermost body or critical point.
_SEARCH_BODY_DISTANCES = 2.5
# Number of rays from the origin on which the interior is searched.
_RAYS = 180
# Points along a side of the lattice on which the interior of an oblique slice is searched.
_SCAN_SIDE = 201
# Number of lattices, each around the interior found on the last.
_SCANS = 3
# Number of values of a parameter at which the interior is searched.
_VALUES = 9
# Number of tested points of a line of pixels.
_LINE_POINTS = 65
# The middle of a window is at 0 if it is closer to 0 than this share of the window.
_CENTRE_TOLERANCE = 1e-9
_EMPTY = "must be at least about 1e-5 above the minimum of the well; fixed values must lie inside the well"

Range = tuple[float, float]


@functools.lru_cache(maxsize=1024)
def default_window(potential: Potential, plane: Slice, energy: Energy) -> Window:
    """Find a window that shows the whole interior: all starts that are neither forbidden nor outside.

    On a slice of one energy, the window is a square in units of the well, unless the interior is much longer than wide.

    Parameters
    ----------
    potential
        The potential.
    plane
        The slice.
    energy
        h, dimensionless; on a slice with an axis h the pair (lowest, highest).

    Raises
    ------
    ValueError
        If there is no interior at this energy.
    """
    found, problem = [], None
    for each in _potentials(potential, plane):
        try:
            found += _axis_ranges(each, plane, energy)
        except ValueError as error:
            # The potentials at other values of the parameter may have exits.
            problem = error
    if problem is not None and not found:
        raise problem
    if not found:
        raise ValueError(f"energy={highest_energy(energy)}: the interior is empty on {plane.title}; {_EMPTY}")
    x_low, ordinate_low = np.min(found, axis=0)[:, 0].tolist()
    x_high, ordinate_high = np.max(found, axis=0)[:, 1].tolist()
    if any(map(_is_whole, plane.axes)) or isinstance(energy, tuple):
        return Window(
            *_edges(plane.abscissa, energy, x_low, x_high), *_edges(plane.ordinate, energy, ordinate_low, ordinate_high)
        )
    x_unit, unit = (_exact_unit(axis, potential) for axis in plane.axes)
    sides = (x_high - x_low) / x_unit, (ordinate_high - ordinate_low) / unit
    if max(sides) > _LARGEST_ASPECT * min(sides):
        return Window(*_widened((x_low, x_high)), *_widened((ordinate_low, ordinate_high)))
    window = _square_window(x_low / x_unit, x_high / x_unit, ordinate_low / unit, ordinate_high / unit)
    return window.scaled(x_unit, unit)


def map_window(potential: Potential, plane: Slice, energy: Energy, resolution: tuple[int, int]) -> Window:
    """Find the default window of a map, shifted by half a pixel if a line of pixels would lie on a line of symmetry.

    An orbit with x = px = 0 in a potential even in x stays on x = 0 for ever, by symmetry alone. Such starts have measure zero,
    but a column of them would count in shares and show a line that is not a property of the basins. The same holds for y.

    Parameters
    ----------
    potential, plane, energy
        Potential, slice, and h or its range (lowest, highest).
    resolution
        (columns, rows) of the map.
    """
    window = default_window(potential, plane, energy)
    edges = list(window.ranges)
    for place, (low, high) in enumerate(edges):
        if _is_centred(low, high, resolution[place]) and _on_symmetry_line(potential, plane, energy, place, edges[1 - place]):
            half = 0.5 * (high - low) / resolution[place]
            edges[place] = low + half, high + half
    return Window(*edges[0], *edges[1])


def _is_centred(low: float, high: float, count: int) -> bool:
    """Return whether the middle one of several pixels is at 0, to rounding."""
    return count > 1 and count % 2 == 1 and abs(low + high) < _CENTRE_TOLERANCE * (high - low)


def _on_symmetry_line(potential: Potential, plane: Slice, energy: Energy, place: int, others: Range) -> bool:
    """Return whether all starts at 0 on axis `place`, and in `others` on the other axis, stay on x = 0 or y = 0."""
    line = plane if plane.parameter is None else plane.line(plane.parameter.low)
    points = [np.linspace(*others, _LINE_POINTS)] * 2
    points[place] = np.zeros(_LINE_POINTS)
    states = line.states(potential, common_energy(energy), *points)
    states = states[np.isfinite(states).all(axis=1)]
    symmetries = ((potential.well.mirror_in_x, [0, 2]), (potential.well.mirror_in_y, [1, 3]))
    return bool(states.size) and any(symmetric and not states[:, pair].any() for symmetric, pair in symmetries)


def _exact_unit(axis: Axis, potential: Potential) -> float:
    """Return the unit of an axis with the exact unit of time, so that the shape of a square does not depend on user units."""
    mass = potential.mass
    units = WellUnits(potential.units.length, potential.well.exact_time_unit / math.sqrt(mass), mass)
    if isinstance(axis, Direction):
        return 1.0 / float(np.hypot.reduce([value / c.unit(units) for c, value in axis.components.items()]))
    return axis.unit(units)


def _potentials(potential: Potential, plane: Slice) -> list[Potential]:
    """Return the potentials whose interiors a window shows: those along a parameter, otherwise the potential of the map."""
    axis = plane.parameter
    if axis is None:
        return [potential]
    return [axis.potential(value) for value in np.linspace(axis.low, axis.high, _VALUES).tolist()]


def _axis_ranges(potential: Potential, plane: Slice, energy: Energy) -> list[list[Range]]:
    """Return the ranges of both axes over the interior of a slice, as a list of one pair; an empty list without an interior."""
    units = potential.units
    well, level, scaled = potential.in_well_units, highest_energy(energy) / units.energy, plane.in_well_units(units)
    if any(isinstance(axis, Direction) for axis in plane.axes):
        found = _scanned_ranges(well, scaled, scaled_energy(energy, 1.0 / units.energy))
    else:
        positions = _position_ranges(well, scaled, level)
        momenta = _momentum_range(well, level, positions)
        _check_fixed_momentum(potential, energy, plane, positions)
        found = [positions.get(axis, momenta) if isinstance(axis, Coordinate) else momenta for axis in scaled.axes]
    if any(not low < high for low, high in found):
        return []
    return [[(low * unit, high * unit) for (low, high), unit in zip(found, plane.axis_units(units), strict=True)]]


def _is_whole(axis: Axis) -> bool:
    """Return whether the default window shows all of an axis, independent of the interior."""
    return isinstance(axis, ParameterAxis) or axis in (*ANGLES, Coordinate.H)


def _edges(axis: Axis, energy: Energy, low: float, high: float) -> Range:
    """Return the edges of a window along an axis on which the interior has this range."""
    if isinstance(axis, ParameterAxis):
        return axis.low, axis.high
    if axis in ANGLES:
        return -np.pi, np.pi
    if axis is Coordinate.H and isinstance(energy, tuple):
        return energy
    return _widened((low, high))


def _scanned_ranges(potential: Potential, plane: Slice, energy: Energy) -> list[Range]:
    """Search a lattice for the ranges of both axes over the interior of a slice with a direction, in units of the well."""
    reach = 2.0 * _search_radius(potential, highest_energy(energy))
    reaches = [reach * _exact_unit(axis, potential) for axis in plane.axes]
    ranges = [_edges(axis, energy, -each, each) for axis, each in zip(plane.axes, reaches, strict=True)]
    for _ in range(_SCANS):
        sides = [np.linspace(low, high, _SCAN_SIDE) for low, high in ranges]
        points = [side.ravel() for side in np.meshgrid(*sides)]
        states = plane.states(potential, highest_energy(energy), *points)
        exists = np.flatnonzero(np.isfinite(states).all(axis=1))
        inside = exists[find_outside_in_well_units(potential, highest_energy(energy), *states[exists, :2].T) == 0]
        if not inside.size:
            return [(0.0, 0.0), (0.0, 0.0)]
        for place, axis in enumerate(plane.axes):
            if not _is_whole(axis):
                step, along = sides[place][1] - sides[place][0], points[place][inside]
                ranges[place] = float(along.min() - step), float(along.max() + step)
    return ranges


def _position_ranges(potential: Potential, plane: Slice, energy: float) -> dict[Coordinate, Range]:
    """Return the ranges of x and y over the interior of a slice. A coordinate that is not an axis has its value as both ends."""
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


def _check_fixed_momentum(potential: Potential, energy: Energy, plane: Slice, ranges: dict[Coordinate, Range]) -> None:
    """Raise ValueError if a fixed momentum exceeds the kinetic energy between these positions, in units of the well."""
    units, level = potential.units, highest_energy(energy) / potential.units.energy
    x, y = np.meshgrid(*(np.linspace(*ranges[coordinate], _SCAN_SIDE) for coordinate in (Coordinate.X, Coordinate.Y)))
    largest = units.momentum * float(np.sqrt(2.0 * max(level - np.nanmin(potential.in_well_units.value(x, y)), 0.0)))
    for coordinate, value in plane.fixed:
        if coordinate in MOMENTA and abs(value) > largest:
            raise ValueError(
                f"{coordinate.key}={value:.6g}: no start on {plane.title} has a real {plane.decided.key} at "
                f"energy={highest_energy(energy):.6g}; must be at most {largest:.4g} in magnitude"
            )


def _momentum_range(potential: Potential, energy: float, ranges: dict[Coordinate, Range]) -> Range:
    """Return the range of a momentum of starts between these positions; near gaps, where momenta are unbounded, it is cut off."""
    x, y = (np.linspace(*ranges[coordinate], _SCAN_POINTS) for coordinate in (Coordinate.X, Coordinate.Y))
    value = potential.value(x, y)
    bottom = np.quantile(value[np.isfinite(value)], 1.0 - _SHOWN_MOMENTA) if potential.gaps else np.min(value)
    momentum = float(np.sqrt(2.0 * max(energy - bottom, 0.0)))
    return -momentum, momentum


def _widened(interval: Range) -> Range:
    low, high = interval
    margin = _MARGIN * (high - low)
    return low - margin, high + margin


def _square_window(x_low: float, x_high: float, low: float, high: float) -> Window:
    half = 0.5 * max(x_high - x_low, high - low) * (1.0 + 2.0 * _MARGIN)
    x, ordinate = 0.5 * (x_low + x_high), 0.5 * (low + high)
    return Window(x - half, x + half, ordinate - half, ordinate + half)


def _run_around_middle(allowed: np.ndarray) -> slice:
    """Return the run of True values around the middle of an array."""
    middle = allowed.size // 2
    blocked = np.flatnonzero(~allowed)
    low = blocked[blocked < middle].max(initial=-1) + 1
    high = blocked[blocked > middle].min(initial=allowed.size)
    return slice(low, high)


def _interior_interval(potential: Potential, energy: float, axis: Coordinate, held: dict[Coordinate, float]) -> np.ndarray:
    """Return x or y of the interior on a line of constant y or x, of shape (n,), to about a thousandth of the radius."""
    radius = _search_radius(potential, energy)
    line = np.linspace(-radius, radius, 4 * _SCAN_POINTS)
    x, y = (line if axis is coordinate else np.full_like(line, held[coordinate]) for coordinate in (Coordinate.X, Coordinate.Y))
    allowed = _is_inside(potential, energy, x, y)
    return line[allowed if potential.escape_radius is not None else _run_around_middle(allowed)]


def _is_inside(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return whether points are allowed and not beyond an exit; gaps in an interior count as inside."""
    outside = find_outside_in_well_units(potential, energy, x, y)
    gaps = [number for number, end in enumerate(potential.ends, potential.channels + 1) if end in potential.gaps]
    inside: np.ndarray = ~(potential.value(x, y) > energy) & np.isin(outside, [0, *gaps])
    return inside


def _search_radius(potential: Potential, energy: float) -> float:
    """Return a radius that contains the interior, unless the energy is many times the escape energy."""
    if potential.escape_radius is not None:
        return _shown_radius(potential, potential.escape_radius)
    distances = np.hypot(*potential.saddles.T)
    # The units of the well are rounded. They are not used here, so that the edges found do not depend on the user's units.
    nearest, outermost = (float(distances.min()), float(distances.max())) if distances.size else (1.0, 0.0)
    radius = _SEARCH_LENGTHS * nearest
    # The search does not begin at the outermost saddle, which may be so far away that the points miss the interior.
    while radius < _SEARCH_SADDLE_DISTANCES * outermost and _interior_on_rays(potential, energy, radius)[2][:, -1].any():
        radius *= 2.0
    return radius


def _interior_on_rays(potential: Potential, energy: float, farthest: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return x, y and whether points on rays from the origin are inside, (rays, n). In a well, a ray ends where it leaves."""
    angle = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    radius = np.linspace(0.0, farthest, _SCAN_POINTS // 2)
    x, y = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    inside = _is_inside(potential, energy, x, y)
    return x, y, inside if potential.escape_radius is not None else np.logical_and.accumulate(inside, axis=1)


def _shown_radius(potential: Potential, escape_radius: float) -> float:
    """Return a radius that contains the bodies and critical points of a system with an escape radius, with some margin."""
    places = [*_known_critical_points(potential).tolist(), *((end.x, end.y) for end in potential.ends)]
    outermost = max((float(np.hypot(*place)) for place in places), default=0.0)
    return min(_SEARCH_BODY_DISTANCES * outermost or escape_radius, escape_radius)


def _known_critical_points(potential: Potential) -> np.ndarray:
    """Return the critical points, (n, 2); none if they form a curve or are not found within the limit on the work."""
    try:
        return potential.critical_points
    except (NotIsolatedError, UndecidedError):
        return NO_POINTS


def _interior_points(potential: Potential, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y of the points of rays from the origin that are inside, and of the exits, each of shape (n,)."""
    x, y, inside = _interior_on_rays(potential, energy, _search_radius(potential, energy))
    x, y = x[inside], y[inside]
    if x.size == 0 or not x.min() < x.max():
        return np.empty(0), np.empty(0)
    orbits = find_orbits_in_well_units(potential, energy)
    return np.concatenate([x, *(orbit.x for orbit in orbits)]), np.concatenate([y, *(orbit.y for orbit in orbits)])


def _rounded_range(coordinate: np.ndarray) -> Range:
    """Return the smallest and the largest value, to 12 decimals, so that the window of a symmetric interior is symmetric."""
    if not coordinate.size:
        return 0.0, 0.0
    return round(float(coordinate.min()), 12), round(float(coordinate.max()), 12)
