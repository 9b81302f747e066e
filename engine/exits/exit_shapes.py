"""Exits over saddles as rows of numbers for the kernels of `integrator.kernels.exit_geometry`: closed channels, curves, lines.

An exit is a graph u = f(s) in the axes of a saddle (`brake_orbits.Axes`), with s = (q − middle)/half_width, from −1 to 1. An
exit closes one channel, and exits do not meet.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from engine.exits.saddle_orbits.brake_orbits import Axes, saddle_axes
from engine.foundations.root_finding import bisect
from engine.integrator.kernels import exit_geometry as geometry
from engine.integrator.source.section_numbers import UPWARD, SectionNumbers
from engine.systems.landscape.closed_energy import ridge_bend
from engine.systems.landscape.mirror_images import Signs
from engine.systems.potential import Potential
from engine.systems.well_units import nearest_power_of_two

# Largest distance of a curve from the path that it follows, in units of the well.
_LARGEST_FIT_ERROR = 1e-9
# Smallest |s| − 1 of samples on the straight lines beyond the ends of an exit, see `find_reach`.
_FIRST_BEYOND = 1e-3
# Length of these lines, in units of the distance of the saddle from the origin or, if larger, of the half width of the exit.
_FARTHEST_BEYOND = 2.0
# Number of samples along one of these lines.
_SAMPLES_BEYOND = 400
# Half the length of the line across a closed saddle, in units of the saddle's distance from the origin.
_CLOSED_HALF_WIDTH = 1e-3
# Distance of this line beyond the saddle, in the same unit. An orbit at rest on the saddle starts inside in spite of rounding.
_CLOSED_OFFSET = 1e-9
# Number of steps in which walls are followed from the saddle to the line.
_WALL_STEPS = 32
# Walls are searched up to this multiple of the distance of the saddle from the origin.
_FARTHEST_WALL = 5.0
# Number of points at which a wall is searched.
_WALL_POINTS = 400
# Number of bisections between two of these points.
_BISECTIONS = 60
# Number of points along an exit for drawings.
_LINE_POINTS = 41
# Largest change of a wall's position in a step, in units of the channel's width; a larger change can be a jump to another wall.
_LARGEST_WALL_STEP = 0.25
# Largest distance between ends of two orbits that count as the same end, in units of the well.
_END_TOLERANCE = 1e-6
# Distance of a gate from the exit, in units of the distance of the saddle from the origin, rounded to a power of 2.
_GATE_MARGIN = 1e-3
# Columns that a reflection of x or y multiplies by its sign.
_X_COLUMNS = [geometry.ORIGIN_X, geometry.OUTWARD_X, geometry.BEARING_X]
_Y_COLUMNS = [geometry.ORIGIN_Y, geometry.OUTWARD_Y, geometry.BEARING_Y]


def closed_channel(axes: Axes, saddle: np.ndarray) -> np.ndarray:
    """Return the row of a closed channel, (columns,): a short straight line just beyond the origin of the axes."""
    curve = np.zeros(geometry.CURVE_COLUMNS)
    curve[geometry.ORIGIN_X : geometry.OUTWARD_Y + 1] = *axes.origin, *axes.outward
    curve[geometry.BEARING_X : geometry.BEARING_Y + 1] = saddle / np.hypot(*saddle)
    curve[geometry.HALF_WIDTH] = _CLOSED_HALF_WIDTH * np.hypot(*saddle)
    curve[geometry.REACH] = 1.0
    curve[geometry.COEFFICIENTS] = _CLOSED_OFFSET * np.hypot(*saddle)
    return curve


def absent_channel(axes: Axes, saddle: np.ndarray) -> np.ndarray:
    """Return a row that no orbit crosses, (columns,), for a channel that is part of another exit, or whose exit is unknown."""
    curve = closed_channel(axes, saddle)
    curve[geometry.REACH] = -1.0
    return curve


def line_across(potential: Potential, energy: float, channel: int, edge: float) -> np.ndarray | None:
    """Return the row of the exit u = edge + a q² between the walls of a channel, in the axes of the saddle; a is `ridge_bend`.

    The walls are followed from the saddle to the exit. The result is None if the walls do not reach the exit.
    """
    axes = saddle_axes(potential, channel)
    bend = ridge_bend(potential.form, *axes)
    walls = _find_walls(potential, energy, axes, np.linspace(0.0, edge, _WALL_STEPS + 1), bend)
    widths = walls[:, 1] - walls[:, 0]
    # NaN marks a missing wall, and `not … <` rejects it.
    if not np.all(np.abs(np.diff(walls, axis=0)) < _LARGEST_WALL_STEP * widths[1:, None]):
        return None
    low, high = walls[-1]
    curve = closed_channel(axes, potential.saddles[channel - 1])
    curve[geometry.SHAPE] = geometry.LINE
    middle, half_width = 0.5 * (low + high), 0.5 * (high - low)
    curve[geometry.MIDDLE : geometry.HALF_WIDTH + 1] = middle, half_width
    curve[geometry.SLOPE_LOW : geometry.SLOPE_HIGH + 1] = 2.0 * bend * half_width * np.array([low, high])
    # u as a sum of Chebyshev polynomials of s = (q − middle)/half_width.
    constant = edge + bend * (middle * middle + 0.5 * half_width * half_width)
    linear, quadratic = 2.0 * bend * middle * half_width, 0.5 * bend * half_width * half_width
    curve[geometry.COEFFICIENTS : geometry.COEFFICIENTS + 3] = constant, linear, quadratic
    curve[geometry.REACH] = find_reach(potential, energy, curve)
    return curve


def curve_along(axes: Axes, saddle: np.ndarray, path: np.ndarray) -> np.ndarray | None:
    """Return the row of a path (2, n) as a graph u = f(s), s ∈ [−1, 1]; None unless it is a smooth graph. Its reach is unset."""
    u, q = axes.coordinates(path)
    middle, half_width = 0.5 * (q[0] + q[-1]), 0.5 * (q[-1] - q[0])
    s = (q - middle) / half_width
    if np.any(np.diff(s) <= 0):
        return None
    basis = chebyshev.chebvander(s, geometry.CURVE_DEGREE)
    fit = np.linalg.lstsq(basis, u, rcond=None)[0]
    if np.max(np.abs(basis @ fit - u)) > _LARGEST_FIT_ERROR:
        return None
    end_slopes = chebyshev.chebval([-1.0, 1.0], chebyshev.chebder(fit))
    curve = closed_channel(axes, saddle)
    curve[geometry.SHAPE] = geometry.CURVE
    curve[geometry.MIDDLE : geometry.SLOPE_HIGH + 1] = middle, half_width, *end_slopes
    curve[geometry.COEFFICIENTS :] = fit
    return curve


def mirrored_curve(curve: np.ndarray, signs: Signs) -> np.ndarray:
    """Return the row of the mirror image of an exit. In the axes of the mirrored saddle, a reflection changes the sign of q."""
    mirrored = curve.copy()
    for sign, columns in zip(signs, (_X_COLUMNS, _Y_COLUMNS), strict=True):
        mirrored[columns] *= sign
    if math.prod(signs) < 0.0:
        mirrored[geometry.MIDDLE] *= -1.0
        mirrored[[geometry.SLOPE_LOW, geometry.SLOPE_HIGH]] = -curve[[geometry.SLOPE_HIGH, geometry.SLOPE_LOW]]
        # The odd Chebyshev polynomials change their signs with q.
        mirrored[geometry.COEFFICIENTS + 1 :: 2] *= -1.0
    return mirrored


def reversed_curve(curve: np.ndarray) -> np.ndarray:
    """Return the row of the same curve across a channel with its inner and outer sides exchanged."""
    # u, q and s change their signs.
    reversed_row = curve.copy()
    reversed_row[[geometry.OUTWARD_X, geometry.OUTWARD_Y, geometry.MIDDLE]] *= -1.0
    reversed_row[[geometry.SLOPE_LOW, geometry.SLOPE_HIGH]] = curve[[geometry.SLOPE_HIGH, geometry.SLOPE_LOW]]
    reversed_row[geometry.COEFFICIENTS :: 2] *= -1.0
    return reversed_row


def find_reach(potential: Potential, energy: float, curve: np.ndarray) -> float:
    """Return the largest |s| at which a crossing counts.

    Beyond each end, the straight line that continues the exit leads through the wall to a first point with V ≤ h. Crossings count
    up to half the way to the nearer of these two points.
    """
    reach = np.inf
    axes = _axes_of(curve)
    farthest = _FARTHEST_BEYOND * max(float(np.hypot(*axes.origin)) / curve[geometry.HALF_WIDTH], 1.0)
    beyond = np.geomspace(_FIRST_BEYOND, farthest, _SAMPLES_BEYOND)
    for end, slope in ((-1.0, curve[geometry.SLOPE_LOW]), (1.0, curve[geometry.SLOPE_HIGH])):
        u = chebyshev.chebval(end, curve[geometry.COEFFICIENTS :]) + slope * end * beyond
        q = curve[geometry.MIDDLE] + curve[geometry.HALF_WIDTH] * end * (1.0 + beyond)
        is_inside = potential.value(*axes.points(u, q)) <= energy
        reach = min(reach, 1.0 + 0.5 * beyond[is_inside].min(initial=np.inf))
    return float(reach)


def exit_gates(curves: np.ndarray, section: SectionNumbers = UPWARD) -> np.ndarray:
    """Return the gates of exits (…, outcomes, columns), of shape (outcomes + rows, 3). No orbit ends before it passes a gate.

    A gate is cheap to test. For a channel, it is the line a x + b y = c slightly inside the exits at all energies; for a circle,
    it is the centre and the radius. The rows of the section at which crossings are counted follow, see
    `engine.integrator.kernels.propagate.Exits`.
    """
    outcomes, columns = curves.shape[-2:]
    rows = curves.reshape(math.prod(curves.shape[:-2]), outcomes, columns)
    gates = np.ascontiguousarray(rows[0][:, [geometry.ORIGIN_X, geometry.ORIGIN_Y, geometry.HALF_WIDTH]])
    is_line = rows[0, :, geometry.SHAPE] <= geometry.LINE
    gates[is_line] = _lines_inside(rows[:, is_line])
    return np.concatenate([gates, np.reshape(section.rows, (len(section.rows), 3))]) if section.rows else gates


def _lines_inside(rows: np.ndarray) -> np.ndarray:
    """Return lines across channels, slightly inside their exits (energies, channels, columns), of shape (channels, 3)."""
    # The array axes of u, q, x and y are energies, channels and points.
    s = np.linspace(-1.0, 1.0, 201)
    u = chebyshev.chebval(s, np.moveaxis(rows[..., geometry.COEFFICIENTS :], -1, 0))
    q = rows[..., geometry.MIDDLE, None] + rows[..., geometry.HALF_WIDTH, None] * s
    origin_x, origin_y, outward_x, outward_y = np.moveaxis(rows[..., geometry.ORIGIN_X : geometry.OUTWARD_Y + 1, None], 2, 0)
    x, y = origin_x + u * outward_x - q * outward_y, origin_y + u * outward_y + q * outward_x
    normals = rows[0, :, geometry.OUTWARD_X : geometry.OUTWARD_Y + 1]
    innermost = (normals[:, :1] * x + normals[:, 1:] * y).min(axis=(0, -1))
    saddles = rows[0, :, geometry.ORIGIN_X : geometry.ORIGIN_Y + 1]
    lengths = np.array([nearest_power_of_two(distance) for distance in np.hypot(*saddles.T).tolist()])
    return np.column_stack([normals, innermost - _GATE_MARGIN * lengths])


def line_points(curve: np.ndarray) -> np.ndarray:
    """Return x and y along an exit from `line_across`, from wall to wall, of shape (41, 2)."""
    s = np.linspace(-1.0, 1.0, _LINE_POINTS)
    u, q = chebyshev.chebval(s, curve[geometry.COEFFICIENTS :]), curve[geometry.MIDDLE] + curve[geometry.HALF_WIDTH] * s
    return _axes_of(curve).points(u, q).T


def _axes_of(curve: np.ndarray) -> Axes:
    return Axes(curve[geometry.ORIGIN_X : geometry.ORIGIN_Y + 1], curve[geometry.OUTWARD_X : geometry.OUTWARD_Y + 1])


def _find_walls(potential: Potential, energy: float, axes: Axes, offset: np.ndarray, bend: float) -> np.ndarray:
    """Find the q of the walls on both sides of q = 0 on n parabolas u = offset + bend q², of shape (n, 2); NaN without a wall."""

    def is_beyond(q: np.ndarray) -> np.ndarray:
        """Return whether V > energy at q (n, 2, m)."""
        return potential.value(*axes.points(offset[:, None, None] + bend * q * q, q)) > energy

    # The points are denser near the saddle.
    grid = np.linspace(0.0, 1.0, _WALL_POINTS) ** 2 * _FARTHEST_WALL * float(np.hypot(*axes.origin))
    q = np.broadcast_to(np.array([-1.0, 1.0])[:, None] * grid, (offset.size, 2, grid.size))
    with np.errstate(all="ignore"):
        # Index of the first point beyond a wall; 0 without a wall, as q = 0 is between the walls.
        first = np.argmax(is_beyond(q), axis=-1)[..., None]
        low, high = np.take_along_axis(q, np.maximum(first - 1, 0), -1), np.take_along_axis(q, first, -1)
        low, high = bisect(is_beyond, low, high, _BISECTIONS)
    return np.where(first > 0, 0.5 * (low + high), np.nan)[..., 0]


def paths_meet(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether two paths, (n, 2) and (m, 2), intersect, or have the same ends and thus are the same path."""
    return count_crossings(one, other) > 0 or bool(np.abs(one[[0, -1]] - other[[0, -1]]).max() < _END_TOLERANCE)


def count_crossings(one: np.ndarray, other: np.ndarray) -> int:
    """Return how often two polygonal lines, (n, 2) and (m, 2), intersect."""
    if np.any(one.max(axis=0) < other.min(axis=0)) or np.any(other.max(axis=0) < one.min(axis=0)):
        return 0

    def sides(line: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return whether each point lies to the left of each segment of a line, of shape (segments, points)."""
        segment, offset = np.diff(line, axis=0)[:, None], points - line[:-1, None]
        return segment[..., 0] * offset[..., 1] > segment[..., 1] * offset[..., 0]

    # Two segments intersect if the ends of each lie on different sides of the other.
    other_sides, one_sides = sides(one, other), sides(other, one).T
    return int(np.count_nonzero((other_sides[:, 1:] != other_sides[:, :-1]) & (one_sides[1:] != one_sides[:-1])))


def closes_channel(potential: Potential, energy: float, channel: int, path: np.ndarray) -> bool:
    """Return whether a path (2, n) between two points at rest separates the origin from the outside of one channel, and no other.

    The path crosses an odd number of times the line of steepest descent over the saddle of the channel, from the origin to the
    outside, and the lines of other open channels an even number of times. These numbers do not change if the ends of the path
    move along the zero-velocity curve, because V is below h on the lines. All quantities are in units of the well.
    """
    lines = potential.well.exit_lines
    return all(
        count_crossings(path.T, lines[other - 1]) % 2 == (other == channel) for other in potential.well.open_channels(energy)
    )
