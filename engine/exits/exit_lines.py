"""Exits in rotating frames: parabolas across a channel from wall to wall, just outside the Lyapunov orbit."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from engine.exits.exit_shapes import axes_of, closed_channel, find_reach
from engine.exits.saddle_orbits.brake_orbits import Axes, saddle_axes
from engine.foundations.root_finding import bisect
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.landscape.closed_energy import ridge_bend
from engine.systems.potential import Potential

# Number of steps in which walls are followed from the saddle to the line.
_WALL_STEPS = 32
# Walls are searched up to this multiple of the distance of the saddle from the origin.
_FARTHEST_WALL = 5.0
# Number of points at which a wall is searched.
_WALL_POINTS = 400
# Number of bisections between two of these points.
_BISECTIONS = 60
# Largest change of a wall's position in a step, in units of the channel's width; a larger change can be a jump to another wall.
_LARGEST_WALL_STEP = 0.25
# Number of points along an exit for drawings.
_LINE_POINTS = 41


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


def line_points(curve: np.ndarray) -> np.ndarray:
    """Return x and y along an exit from `line_across`, from wall to wall, of shape (41, 2)."""
    s = np.linspace(-1.0, 1.0, _LINE_POINTS)
    u, q = chebyshev.chebval(s, curve[geometry.COEFFICIENTS :]), curve[geometry.MIDDLE] + curve[geometry.HALF_WIDTH] * s
    return axes_of(curve).points(u, q).T


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
