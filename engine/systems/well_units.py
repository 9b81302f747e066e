"""Units of length and time of a well, which are powers of 2, so that numbers are converted without rounding.

Under x → L x and V → E V, times scale as L/√E, and potentials that differ only by such a scaling are equal in units of the well.
All tolerances and all constants of time and length of the engine are in these units; for the three cases of Zotos (2014) the
units are 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np


def _quantity(length: int, time: int) -> dict[str, tuple[int, int]]:
    """Return metadata of a dataclass field: the powers of length and time in the unit of its value, for `WellUnits.restore`."""
    return {_UNIT: (length, time)}


_UNIT = "unit"
LENGTH, TIME, AREA = _quantity(1, 0), _quantity(0, 1), _quantity(2, 0)
MOMENTUM, RATE, ENERGY = _quantity(1, -1), _quantity(0, -1), _quantity(2, -2)


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

    @property
    def inverse(self) -> WellUnits:
        """Return the units with which `restore` converts from the units of the potential to those of the well."""
        return WellUnits(1.0 / self.length, 1.0 / self.time)

    def restore[Computed](self, result: Computed) -> Computed:
        """Convert a result from these units to the units of the potential, without rounding.

        Fields whose metadata is a quantity, such as `TIME`, are converted; arrays stay read-only.
        """
        if self == WellUnits():
            return result
        restored = {}
        for each in fields(result):  # type: ignore[arg-type]
            if _UNIT in each.metadata:
                length, time = each.metadata[_UNIT]
                value = getattr(result, each.name)
                restored[each.name] = value * (self.length**length * self.time**time)
                if isinstance(value, np.ndarray):
                    restored[each.name].flags.writeable = value.flags.writeable
        return replace(result, **restored)  # type: ignore[type-var]


def nearest_power_of_two(value: float) -> float:
    """Return the power of 2 nearest to a finite value above 0 on a logarithmic scale; it scales exactly with powers of 2."""
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa * mantissa >= 0.5 else exponent - 1)
