"""Orbits between the outer walls of an exit of several channels, above the maxima of V between the channels.

Just below a maximum, two orbits lead from an outer wall to the forbidden region around the maximum. Above the maximum, this
region is gone, and one orbit leads from one outer wall to the other.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine.exits.brake_orbits import Axes, BrakeOrbit, find_from_outside
from engine.integrator.kernels import events
from engine.integrator.kernels.dense_output import trace_pieces
from engine.systems.potential import Potential

# Positions at which lines of starts cross the line between the outermost saddles, as shares of its length.
_LINE_SHARES = (0.5, 0.25, 0.75, 0.0, 1.0)
# Indices of the points of an exit's path from which test orbits leave.
_POINTS = np.arange(5, 100, 10)
# Angles of these orbits to the normal of the path, in radians.
_ANGLES = np.radians([-75.0, -40.0, 0.0, 40.0, 75.0])
# Time for which these orbits are followed, in units of the well.
_FOLLOWED_TIME = 30.0
# A gate 0 x + 0 y = −1 that all points have passed, so that each step is tested.
_PASSED_GATE = np.array([[0.0, 0.0, -1.0]])


def axes_between(potential: Potential, channels: tuple[int, ...], share: float = 0.5) -> Axes:
    """Return axes with q along the line between the outermost saddles of an exit, and the origin at a `share` of it, 0 to 1."""
    saddles = potential.saddles[np.array(channels) - 1]
    angles = np.arctan2(saddles[:, 1], saddles[:, 0])
    order = np.argsort(angles)
    gaps = np.diff(angles[order], append=angles[order[0]] + 2.0 * np.pi)
    # The outermost saddles are on both sides of the widest gap.
    widest = int(np.argmax(gaps))
    first, last = saddles[order[(widest + 1) % len(order)]], saddles[order[widest]]
    chord = last - first
    return Axes((1.0 - share) * first + share * last, np.array([chord[1], -chord[0]]) / np.hypot(*chord))


def find_merged_orbits(potential: Potential, energy: float, channels: tuple[int, ...]) -> Iterator[BrakeOrbit]:
    """Yield the orbits that can be the exit of several channels: orbits with all saddles of the channels between their ends."""
    saddles = potential.saddles[np.array(channels) - 1].T
    search_size = float(np.hypot(*saddles).max())
    for share in _LINE_SHARES:
        axes = axes_between(potential, channels, share)
        _, q = axes.coordinates(saddles)
        for orbit in find_from_outside(potential, energy, axes, search_size):
            _, end_q = axes.coordinates(orbit.path[:, [0, -1]])
            if end_q[0] < q.min() and q.max() < end_q[1]:
                yield orbit


def has_returns(potential: Potential, energy: float, orbit: BrakeOrbit, curve: np.ndarray) -> bool:
    """Return whether any of 50 orbits that leave across an exit, a row `curve`, returns across this exit."""
    kernels = potential.well.kernels
    for start in _leaving_states(potential, energy, orbit.path):
        # The first piece holds thousands of steps, far more than the time requires.
        steps, _ = next(trace_pieces(kernels, start, _FOLLOWED_TIME, len(potential.outcomes)))
        # An orbit that returns is, in backward time, an orbit that leaves. The first step begins on the exit and is left out.
        for (x0, y0), (x1, y1) in zip(steps[1:-1, :2], steps[2:, :2], strict=True):
            if events.crossed_exit(x1, y1, x0, y0, curve[None], _PASSED_GATE):
                return True
    return False


def _leaving_states(potential: Potential, energy: float, path: np.ndarray) -> np.ndarray:
    """Return 50 states that leave across a path (2, 101) with the well on its left, of shape (50, 4)."""
    dx, dy = path[:, _POINTS + 1] - path[:, _POINTS - 1]
    path_angle = np.arctan2(dy, dx)
    angle = (path_angle - 0.5 * np.pi)[:, None] + _ANGLES
    speed = np.sqrt(2.0 * (energy - potential.value(*path[:, _POINTS])))[:, None]
    positions = [np.broadcast_to(path[axis, _POINTS, None], angle.shape) for axis in range(2)]
    return np.stack([*positions, speed * np.cos(angle), speed * np.sin(angle)], axis=-1).reshape(-1, 4)
