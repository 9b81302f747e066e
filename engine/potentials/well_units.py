"""Units of length and time of a well: powers of 2, so that numbers are converted without rounding.

Under x → L x and V → E V, times scale as L/√E. In units of the well, every such potential is the same one. All tolerances and
all time and length constants of the engine are in these units; for the three cases of Zotos (2014) they are 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class WellUnits:
    """The units of one well, dimensionless, each a power of 2.

    Attributes
    ----------
    length
        Unit of x and y.
    time
        Unit of time.
    """

    length: float = 1.0
    time: float = 1.0

    @property
    def momentum(self) -> float:
        """Unit of px and py, which are velocities: length / time."""
        return self.length / self.time

    @property
    def energy(self) -> float:
        """Unit of H and V: momentum²."""
        return self.momentum**2

    @property
    def state(self) -> np.ndarray:
        """(4,) units of x, y, px, py."""
        return np.array([self.length, self.length, self.momentum, self.momentum])


def nearest_power_of_two(value: float) -> float:
    """The power of 2 nearest to a finite value above 0 on a logarithmic scale; scaled by a power of 2 exactly as `value` is."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa * mantissa >= 0.5 else exponent - 1)
