"""What the user chose: one validated object that everything on the page follows."""

from __future__ import annotations

import numpy as np
import param

from app.paper_energies import ENERGIES
from engine import CASES, MapSpec, Plane, Potential, Window, start_states

T_MAX_CHOICES = {"100": 1e2, "1 000": 1e3, "10 000": 1e4, "100 000": 1e5, "1 000 000": 1e6}
RESOLUTION_CHOICES = {"113 × 113": 113, "225 × 225": 225, "450 × 450": 450, "900 × 900": 900}


class ViewState(param.Parameterized):
    """The view: which map, and the start of the orbit beside it (x and ordinate; None before the first click)."""

    case = param.Selector(default="I", objects=list(CASES))
    plane = param.Selector(default=Plane.X_PX, objects=list(Plane))
    energy = param.Number(default=ENERGIES["I"].first, doc="h; on (x, h) it is the ordinate instead")
    t_max = param.Selector(default=1e5, objects=list(T_MAX_CHOICES.values()))
    resolution = param.Selector(default=225, objects=list(RESOLUTION_CHOICES.values()))
    window = param.ClassSelector(
        class_=Window, default=None, allow_None=True, doc="part of the plane; None for the whole interior"
    )
    judge = param.Boolean(default=False, doc="whether bounded orbits are judged regular or chaotic")
    start = param.NumericTuple(default=None, length=2, allow_None=True)

    @property
    def potential(self) -> Potential:
        """The potential of the chosen case."""
        return CASES[self.case]

    def map_spec(self) -> MapSpec:
        """The request for the map in view; ValueError names what is wrong with the choice."""
        energy: float | tuple[float, float] = self.energy
        if self.plane is Plane.X_H:
            energy = (self.potential.escape_energy, ENERGIES[self.case].high)
        return MapSpec(self.potential, self.plane, energy, (self.resolution, self.resolution), self.window, self.t_max)

    def start_state(self) -> tuple[float, float, float, float]:
        """x, y, px, py of the chosen start; py is NaN where it is forbidden."""
        x, ordinate = (np.array([value]) for value in self.start)
        return tuple(float(value) for value in start_states(self.potential, self.plane, self.energy, x, ordinate)[0])  # type: ignore[return-value]
