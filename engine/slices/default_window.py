"""The window that shows the whole interior of a slice: all starts that are neither forbidden nor outside."""

from __future__ import annotations

import functools

import numpy as np

from engine.slices.axes import Energy, common_energy, highest_energy
from engine.slices.interior_ranges import MARGIN, Range, exact_unit, find_axis_ranges, is_whole, widened, window_edges
from engine.slices.slice import Slice
from engine.slices.window import Window
from engine.systems.potential import Potential

# Largest ratio of the sides of an interior, in units of the well, at which both sides of the window have the same scale.
_LARGEST_ASPECT = 4.0
# Number of values of a parameter at which the interior is searched.
_PARAMETER_VALUES = 9
# Number of tested points of a line of pixels.
_LINE_POINTS = 65
# Largest magnitude of the sum of the edges of a window centred on 0, as a share of its length.
_CENTRE_TOLERANCE = 1e-9
# Condition for an interior, for messages.
_CONDITION = "must be at least about 1e-5 above the minimum of the well; fixed values must lie inside the well"


@functools.lru_cache(maxsize=1024)
def default_window(potential: Potential, plane: Slice, energy: Energy) -> Window:
    """Find a window that shows the whole interior.

    On a slice of one energy, the window is a square in units of the well, unless one side of the interior is much longer than the
    other.

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
    ranges, last_error = [], None
    for member in _shown_potentials(potential, plane):
        try:
            if (axis_ranges := find_axis_ranges(member, plane, energy)) is not None:
                ranges.append(axis_ranges)
        except ValueError as error:
            # The potentials at other values of the parameter may have exits.
            last_error = error
    if last_error is not None and not ranges:
        raise last_error
    if not ranges:
        raise ValueError(f"energy={highest_energy(energy)}: the interior is empty on {plane.title}; {_CONDITION}")
    lower_ends, upper_ends = np.min(ranges, axis=0)[:, 0].tolist(), np.max(ranges, axis=0)[:, 1].tolist()
    x_range, ordinate_range = zip(lower_ends, upper_ends, strict=True)
    if any(map(is_whole, plane.axes)) or isinstance(energy, tuple):
        return Window(*window_edges(plane.abscissa, energy, x_range), *window_edges(plane.ordinate, energy, ordinate_range))
    units = [exact_unit(axis, potential) for axis in plane.axes]
    sides = [(high - low) / unit for (low, high), unit in zip((x_range, ordinate_range), units, strict=True)]
    if max(sides) > _LARGEST_ASPECT * min(sides):
        return Window(*widened(x_range), *widened(ordinate_range))
    x, ordinate = ((low / unit, high / unit) for (low, high), unit in zip((x_range, ordinate_range), units, strict=True))
    return _square_window(*x, *ordinate).scaled(*units)


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
    for axis, (low, high) in enumerate(edges):
        if _is_centred(low, high, resolution[axis]) and _on_symmetry_line(potential, plane, energy, axis, edges[1 - axis]):
            half_pixel = 0.5 * (high - low) / resolution[axis]
            edges[axis] = low + half_pixel, high + half_pixel
    return Window(*edges[0], *edges[1])


def _is_centred(low: float, high: float, count: int) -> bool:
    """Return whether the middle one of several pixels is at 0, to rounding."""
    return count > 1 and count % 2 == 1 and abs(low + high) < _CENTRE_TOLERANCE * (high - low)


def _on_symmetry_line(potential: Potential, plane: Slice, energy: Energy, axis: int, other_range: Range) -> bool:
    """Return whether all starts at 0 on `axis` (0 or 1), and in a range on the other axis, stay on x = 0 or y = 0."""
    # Along a parameter, one potential decides for all.
    line = plane if plane.parameter is None else plane.line(plane.parameter.low)
    points = [np.linspace(*other_range, _LINE_POINTS)] * 2
    points[axis] = np.zeros(_LINE_POINTS)
    states = line.states(potential, common_energy(energy), *points)
    states = states[np.isfinite(states).all(axis=1)]
    # The columns of x and px, and of y and py.
    symmetries = ((potential.well.mirror_in_x, [0, 2]), (potential.well.mirror_in_y, [1, 3]))
    return bool(states.size) and any(is_even and not states[:, columns].any() for is_even, columns in symmetries)


def _shown_potentials(potential: Potential, plane: Slice) -> list[Potential]:
    """Return the potentials whose interiors a window shows: potentials along a parameter, or the potential of the map."""
    axis = plane.parameter
    if axis is None:
        return [potential]
    return [axis.potential(value) for value in np.linspace(axis.low, axis.high, _PARAMETER_VALUES).tolist()]


def _square_window(x_low: float, x_high: float, ordinate_low: float, ordinate_high: float) -> Window:
    """Return the square around a rectangle, with the margin of the default window on each side."""
    half_side = 0.5 * max(x_high - x_low, ordinate_high - ordinate_low) * (1.0 + 2.0 * MARGIN)
    x, ordinate = 0.5 * (x_low + x_high), 0.5 * (ordinate_low + ordinate_high)
    return Window(x - half_side, x + half_side, ordinate - half_side, ordinate + half_side)
