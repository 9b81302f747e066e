"""Whether an orbit between two points at rest separates the well from the outside of a channel."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_shapes import count_crossings
from engine.systems.potential import Potential


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
