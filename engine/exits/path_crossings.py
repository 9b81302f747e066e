"""How often paths in the plane cross each other, and which channel a path closes."""

from __future__ import annotations

import numpy as np

from engine.systems.potential import Potential

# Largest distance between ends of two orbits that count as the same end, in units of the well.
_END_TOLERANCE = 1e-6


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
