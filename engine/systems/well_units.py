"""Units of length, time and mass of a well.

The units of length and energy are powers of 2, so conversion of lengths and energies does not round. Conversion of times and
momenta does not round if √mass is a power of 2. Under x → L x, V → E V and m → M m, times scale as L √(M/E) and momenta as
√(M E). Systems that differ only by such a scaling are equal in units of the well. All tolerances and all constants of time and
length of the engine are in these units. For the three cases of Zotos (2014), the units are 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

import numpy as np

# Key of the metadata of fields whose values have a unit.
_UNIT = "unit"


def _quantity(length: int, time: int, mass: int = 0) -> dict[str, tuple[int, int, int]]:
    """Return the metadata of a field: the powers of length, time and mass in the unit of its value, for `WellUnits.restore`."""
    return {_UNIT: (length, time, mass)}


# Metadata of fields with these quantities.
LENGTH, TIME, AREA = _quantity(1, 0), _quantity(0, 1), _quantity(2, 0)
RATE, MOMENTUM, ENERGY = _quantity(0, -1), _quantity(1, -1, 1), _quantity(2, -2, 1)


@dataclass(frozen=True)
class WellUnits:
    """The units of one well, dimensionless.

    Attributes
    ----------
    length
        Unit of x and y, a power of 2.
    unit_mass_time
        Unit of time of the same well with a mass of 1, a power of 2.
    mass
        Unit of mass.
    """

    length: float = 1.0
    unit_mass_time: float = 1.0
    mass: float = 1.0

    @property
    def time(self) -> float:
        """Unit of time, which is proportional to √mass."""
        return self.unit_mass_time * math.sqrt(self.mass)

    @property
    def momentum(self) -> float:
        """Unit of px and py."""
        return self.length / self.unit_mass_time * math.sqrt(self.mass)

    @property
    def energy(self) -> float:
        """Unit of H and V, a power of 2."""
        return (self.length / self.unit_mass_time) ** 2

    @property
    def state(self) -> np.ndarray:
        """Units of x, y, px, py, of shape (4,)."""
        return np.array([self.length, self.length, self.momentum, self.momentum])

    @property
    def inverse(self) -> WellUnits:
        """The units with which `restore` converts from the units of the potential to those of the well."""
        return WellUnits(1.0 / self.length, 1.0 / self.unit_mass_time, 1.0 / self.mass)

    def restore[Computed](self, result: Computed) -> Computed:
        """Convert a result, an instance of a dataclass, from these units to the units of the potential.

        Fields whose metadata is a quantity, such as `TIME`, are converted. Read-only arrays stay read-only.
        """
        if self == WellUnits():
            return result
        restored = {}
        for quantity in fields(result):  # type: ignore[arg-type]
            if _UNIT in quantity.metadata:
                restored[quantity.name] = getattr(result, quantity.name) * self._unit(*quantity.metadata[_UNIT])
        return replace(result, **restored)  # type: ignore[type-var]

    def _unit(self, length: int, time: int, mass: int) -> float:
        """Return the unit of a quantity with these powers. √mass, which rounds, has the power 0 for lengths and energies."""
        return self.length**length * self.unit_mass_time**time * math.sqrt(self.mass) ** (time + 2 * mass)


def nearest_power_of_two(value: float) -> float:
    """Return the power of 2 nearest to a finite value above 0 on a logarithmic scale.

    A factor of 2^k in the value is a factor of 2^k in the result.
    """
    mantissa, exponent = math.frexp(value)
    return math.ldexp(1.0, exponent if mantissa * mantissa >= 0.5 else exponent - 1)
