"""Other units of length and energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine import Plane, Potential, Window
from engine.systems.well_units import WellUnits


@dataclass(frozen=True)
class Scaling:
    """Factors of lengths and of energies."""

    length: float
    energy: float

    @property
    def time(self) -> float:
        return self.length / self.energy**0.5

    @property
    def momentum(self) -> float:
        return self.energy**0.5

    def potential(self, potential: Potential) -> Potential:
        terms = tuple((i, j, c * self.energy / self.length ** (i + j)) for i, j, c in potential.terms)
        return Potential(potential.name, terms)

    def window(self, window: Window, plane: Plane) -> Window:
        return window.scaled(*plane.axis_units(WellUnits(self.length, self.time)))

    def states(self, states: np.ndarray) -> np.ndarray:
        return states * [self.length, self.length, self.momentum, self.momentum]
