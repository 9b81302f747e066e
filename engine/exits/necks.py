"""Whether an orbit between two points at rest separates the well from the outside of a channel."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_shapes import count_crossings
from engine.systems.potential import Potential

# Height above the bottom of the well at which the line over a saddle begins, in units of the height of the saddle. Orbits that
# cross the line below this height pass through the well. Of 1 400 Lyapunov orbits, none crossed it below 0.85.
_LINE_START = 0.5


def closes_channel(potential: Potential, energy: float, channel: int, path: np.ndarray) -> bool:
    """Return whether a path (2, n) between two points at rest separates the well from the outside of one channel, and no other.

    The path crosses an odd number of times the line of steepest descent over the saddle of the channel, from the well to the
    outside, and the lines of other open channels an even number of times. These numbers do not change if the ends of the path
    move along the zero-velocity curve, because V is below h on the lines. All quantities are in units of the well.
    """
    well = potential.well
    line = well.exit_lines[channel - 1]
    begin = np.argmax(potential.value(*line.T) > well.bottom + _LINE_START * (well.saddle_energies[channel - 1] - well.bottom))
    others = (well.exit_lines[other - 1] for other in well.open_channels(energy) if other != channel)
    return count_crossings(path.T, line[begin:]) % 2 == 1 and all(count_crossings(path.T, each) % 2 == 0 for each in others)
