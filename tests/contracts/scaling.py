"""Convert potentials, windows and states to other units of length and energy, and to another mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import Plane, Potential, Window
from engine.systems.well_units import WellUnits


@dataclass(frozen=True)
class Scaling:
    """Factors of lengths and of energies, and the mass."""

    length: float
    energy: float
    mass: float = 1.0

    @property
    def time(self) -> float:
        return self.length * self.mass**0.5 / self.energy**0.5

    @property
    def momentum(self) -> float:
        return self.mass**0.5 * self.energy**0.5

    def potential(self, potential: Potential) -> Potential:
        terms = tuple((i, j, c * self.energy / self.length ** (i + j)) for i, j, c in potential.terms)
        return Potential(potential.name, terms, mass=self.mass)

    def window(self, window: Window, plane: Plane) -> Window:
        return window.scaled(*plane.axis_units(WellUnits(self.length, self.length / self.energy**0.5, self.mass)))

    def states(self, states: np.ndarray) -> np.ndarray:
        return states * [self.length, self.length, self.momentum, self.momentum]
