"""What the user chose: one validated object that everything on the page follows."""

from __future__ import annotations

import reprlib
from typing import Any

import numpy as np
import param

from app.rendering.palette import MOST_ORBITS, PALETTES, Palette
from app.runtime.settings import current_settings
from app.state.energy_ranges import ENERGIES
from app.state.system import SYSTEM, TYPED, System
from engine import (
    FREQUENCIES,
    POTENTIALS,
    STRENGTHS,
    MapSpec,
    OrbitRequest,
    Plane,
    Potential,
    UnresolvedMapSpec,
    Window,
    start_states,
)


def _up_to[Number: (int, float)](limit: float, choices: dict[str, Number]) -> dict[str, Number]:
    """The choices that a limit allows, and in any case the least."""
    least = min(choices.values())
    return {name: value for name, value in choices.items() if value <= max(limit, least)}


T_MAX_CHOICES = _up_to(
    current_settings().longest_t_max, {"100": 1e2, "1 000": 1e3, "10 000": 1e4, "100 000": 1e5, "1 000 000": 1e6}
)
RESOLUTION_CHOICES = _up_to(
    current_settings().largest_resolution, {"113 × 113": 113, "225 × 225": 225, "450 × 450": 450, "900 × 900": 900}
)

SWITCHES = ("judge", "trust", "manifolds", "origins", "measures", "energies")
"""What of a view state is shown on demand."""

Start = tuple[float, float]
"""x and ordinate of a start on the plane."""


class _Starts(param.Parameter):
    """Up to MOST_ORBITS starts, each a pair of finite numbers."""

    def _validate(self, val: Any) -> None:
        if not isinstance(val, tuple) or len(val) > MOST_ORBITS or not all(map(_is_start, val)):
            raise ValueError(f"starts={reprlib.repr(val)}: must be up to {MOST_ORBITS} pairs of finite numbers x, ordinate")


def _is_start(value: Any) -> bool:
    is_pair = isinstance(value, tuple) and len(value) == 2
    return is_pair and all(isinstance(number, int | float) and abs(number) < np.inf for number in value)


class ViewState(param.Parameterized):
    """The view: which map, in which colours, and the starts of the orbits beside it."""

    case = param.Selector(default="I", objects=[*POTENTIALS, TYPED])
    formula = param.String(default="", doc="V(x, y) as it was typed, where the case is TYPED")
    omega_1 = param.Number(default=1.0, bounds=FREQUENCIES, doc="frequency of the well along x")
    omega_2 = param.Number(default=1.0, bounds=FREQUENCIES, doc="frequency of the well along y")
    epsilon = param.Number(default=1.0, bounds=STRENGTHS, doc="strength of what perturbs the well")
    plane = param.Selector(default=Plane.X_PX, objects=list(Plane))
    energy = param.Number(default=ENERGIES["I"].first, doc="h; on (x, h) it is the ordinate instead")
    t_max = param.Selector(default=min(1e5, max(T_MAX_CHOICES.values())), objects=list(T_MAX_CHOICES.values()))
    resolution = param.Selector(default=min(225, max(RESOLUTION_CHOICES.values())), objects=list(RESOLUTION_CHOICES.values()))
    window = param.ClassSelector(
        class_=Window, default=None, allow_None=True, doc="part of the plane; None for the whole interior"
    )
    box = param.ClassSelector(
        class_=Window, default=None, allow_None=True, doc="part of the view to count in; None for all of it"
    )
    judge = param.Boolean(default=False, doc="whether bounded orbits are judged regular or chaotic")
    trust = param.Boolean(default=False, doc="whether pixels are marked whose answer hangs on rounding")
    manifolds = param.Boolean(default=False, doc="whether the stable manifolds of the Lyapunov orbits are drawn")
    origins = param.Boolean(default=False, doc="whether orbits are followed into the past, too")
    measures = param.Boolean(default=False, doc="whether the basins are measured")
    energies = param.Boolean(default=False, doc="whether curves against energy are shown")
    palette = param.Selector(default="paper", objects=list(PALETTES), doc="name of the set of colours")
    starts = _Starts(default=(), doc="of the orbits, up to MOST_ORBITS; each has its place and colour")
    chosen = param.Integer(default=0, bounds=(0, MOST_ORBITS - 1), doc="place of the orbit that is looked at")

    @property
    def system(self) -> System:
        """The chosen case with its parameters."""
        return System(self.case, self.formula, float(self.omega_1), float(self.omega_2), float(self.epsilon))

    @property
    def potential(self) -> Potential:
        """The potential of the chosen system."""
        return self.system.potential

    @property
    def colours(self) -> Palette:
        """The chosen set of colours."""
        return PALETTES[self.palette]

    @property
    def chosen_start(self) -> Start | None:
        """The start that is looked at; None where there is none."""
        return self.starts[self.chosen] if self.chosen < len(self.starts) else None

    def map_spec(self) -> MapSpec:
        """The request for the map in view; ValueError names what is wrong with the choice."""
        return self.unresolved_map_spec().spec()

    def unresolved_map_spec(self) -> UnresolvedMapSpec:
        """The map in view."""
        return self.unresolved_map_spec_at(self.energy)

    def unresolved_map_spec_at(self, h: float) -> UnresolvedMapSpec:
        """The same at another energy."""
        energy: float | tuple[float, float] = h
        if self.plane is Plane.X_H:
            energy = (self.potential.escape_energy, self.system.energies.high)
        return UnresolvedMapSpec(self.potential, self.plane, energy, (self.resolution, self.resolution), self.window, self.t_max)

    def orbit_spec(self, start: Start) -> OrbitRequest | None:
        """The request for the orbit of a start; None where no orbit of this energy can start."""
        x, ordinate = (np.array([value]) for value in start)
        x0, y, px, py = (float(value) for value in start_states(self.potential, self.plane, self.energy, x, ordinate)[0])
        return OrbitRequest(self.potential, (x0, y, px, py), self.t_max) if np.isfinite(py) else None

    def add_start(self, start: Start) -> None:
        """One more orbit, which is then looked at; with all places taken it takes the one after the last chosen."""
        if start in self.starts:
            self.chosen = self.starts.index(start)
            return
        place = len(self.starts) if len(self.starts) < MOST_ORBITS else (self.chosen + 1) % MOST_ORBITS
        starts = list(self.starts)
        starts[place : place + 1] = [start]
        self.param.update(starts=tuple(starts), chosen=place)

    def show_system(self, system: System, energy: float | None = None) -> None:
        """Another system, all of it, at its first energy unless told otherwise, without the orbits of the last one."""
        chosen = {name: getattr(system, name) for name in SYSTEM}
        energy = system.energies.first if energy is None else energy
        self.param.update(**chosen, energy=energy, window=None, starts=(), chosen=0)

    def remove_start(self, place: int) -> None:
        """Forget an orbit; those after it move up."""
        starts = self.starts[:place] + self.starts[place + 1 :]
        self.param.update(starts=starts, chosen=max(min(self.chosen, len(starts) - 1), 0))
