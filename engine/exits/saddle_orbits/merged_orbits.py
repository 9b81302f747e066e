"""Orbits between the outer walls of an exit of several channels, above the maxima of V between the channels.

Just below a maximum, two orbits lead from an outer wall to the forbidden region around the maximum. Above the maximum, this
region is gone, and one orbit leads from one outer wall to the other.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine.exits.saddle_orbits.brake_orbits import Axes, BrakeOrbit, find_from_outside
from engine.systems.potential import Potential

# Positions at which lines of starts cross the line between the outermost saddles, as shares of its length.
_LINE_SHARES = (0.5, 0.25, 0.75, 0.0, 1.0)


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
