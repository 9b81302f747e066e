"""Exits over saddles as rows of numbers for the kernels of `integrator.kernels.exit_geometry`, with their reach and their gates.

An exit is a graph u = f(s) in the axes of a saddle (`brake_orbits.Axes`), with s = (q − middle)/half_width, from −1 to 1. An
exit closes one channel, and exits do not meet.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from engine.exits.saddle_orbits.brake_orbits import Axes
from engine.integrator.kernels import exit_geometry as geometry
from engine.integrator.source.section_numbers import UPWARD, SectionNumbers
from engine.systems.landscape.mirror_images import Signs
from engine.systems.potential import Potential
from engine.systems.well_units import nearest_power_of_two

# Largest |s| of a barrier along an exit. The straight lines beyond its ends continue it through the forbidden region.
_FARTHEST_POSITION = 1.25
# Largest distance of a curve from the path that it follows, in units of the well.
_LARGEST_FIT_ERROR = 1e-9
# Smallest |s| − 1 of samples on the straight lines beyond the ends of an exit, see `find_reach`.
_FIRST_BEYOND = 1e-3
# Length of these lines, in units of the distance of the saddle from the origin or, if larger, of the half width of the exit. An
# orbit can cross a line far from the exit: in a long well, and beyond the exit.
_FARTHEST_BEYOND = 200.0
# Number of samples along one of these lines.
_SAMPLES_BEYOND = 4000
# Half the length of the line across a closed saddle, in units of the saddle's distance from the origin.
_CLOSED_HALF_WIDTH = 1e-3
# Distance of this line beyond the saddle, in the same unit. An orbit at rest on the saddle starts inside in spite of rounding.
_CLOSED_OFFSET = 1e-9
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
    up to half the way to the nearer of these two points, or to the end of the lines.
    """
    axes = axes_of(curve)
    farthest = _FARTHEST_BEYOND * max(float(np.hypot(*axes.origin)) / curve[geometry.HALF_WIDTH], 1.0)
    beyond = np.geomspace(_FIRST_BEYOND, farthest, _SAMPLES_BEYOND)
    nearest = farthest
    for end, slope in ((-1.0, curve[geometry.SLOPE_LOW]), (1.0, curve[geometry.SLOPE_HIGH])):
        u = chebyshev.chebval(end, curve[geometry.COEFFICIENTS :]) + slope * end * beyond
        q = curve[geometry.MIDDLE] + curve[geometry.HALF_WIDTH] * end * (1.0 + beyond)
        is_inside = potential.value(*axes.points(u, q)) <= energy
        nearest = beyond[is_inside].min(initial=nearest)
    return 1.0 + 0.5 * float(nearest)


def find_barrier_end(curve: np.ndarray) -> float:
    """Return the largest |s| of the barrier along an exit: a little beyond its ends, and within its reach."""
    return min(float(curve[geometry.REACH]), _FARTHEST_POSITION)


def points_along(curve: np.ndarray, positions: np.ndarray) -> np.ndarray:
    """Return the points of an exit at m values of s, of shape (2, m)."""
    points = np.empty((2, positions.size))
    # The kernel writes into `points`.
    geometry.exit_points(curve, positions, points)
    return points


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


def axes_of(curve: np.ndarray) -> Axes:
    """Return the axes of an exit."""
    return Axes(curve[geometry.ORIGIN_X : geometry.ORIGIN_Y + 1], curve[geometry.OUTWARD_X : geometry.OUTWARD_Y + 1])
