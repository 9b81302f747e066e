"""A formula at an energy: what the engine says about its exits, the same exits integrated anew, and starts of our own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from engine import Potential, classify_orbits, compute_flux, find_lyapunov_orbits
from engine.results import EscapeFlux
from tests.peers.sampled_paths import Exits, parts_of_half
from tests.referee.formulas import Formula
from tests.referee.lattice import Lattice
from tests.referee.own_orbits import OwnOrbits, UndecidedError
from tests.referee.own_system import OwnSystem

# Shift of a start in units of length, and largest change of the escape time, in units of time, of a robust orbit.
SHIFT, STEADY = 1e-9, 1e-4
# Largest kinetic energy of a start, in units of energy. Above, rounding changes the energy of a state.
_MOST_KINETIC = 1e5
# Parts of the way to a start at which it is tested for walls.
_FINE = np.linspace(0.0, 1.0, 10_000)
# Time of integration in units of time.
DURATION = 60.0
# Half the side of the lattice in units of the distance of the farthest exit.
_LATTICE = 1.5
# Distance of the farthest exit, or units of length without an exit, after which an orbit is far away.
_FAR, _FAR_WITHOUT_EXIT = 30.0, 1000.0


@dataclass(frozen=True)
class Setting:
    """A formula, its potential and an energy."""

    formula: Formula
    potential: Potential
    energy: float

    @property
    def reproduction(self) -> dict[str, Any]:
        """What is needed to ask the engine again."""
        return {"formula": self.formula.text, "energy": self.energy}

    @cached_property
    def system(self) -> OwnSystem:
        return OwnSystem(self.formula.expression, self.potential.origin)

    def at(self, energy: float) -> Setting:
        """Return the setting at another energy, with the same own system and integrator."""
        other = replace(self, energy=energy)
        other.__dict__.update(system=self.system, orbits=self.orbits)
        return other

    @property
    def is_start_of_example(self) -> bool:
        """Whether the formula has a start, and it has this energy."""
        state = self.formula.state
        return state is not None and bool(self.potential.energy(np.array(state)) == self.energy)

    @cached_property
    def size(self) -> float:
        """The distance of the farthest exit; the unit of length of the well without exits."""
        saddles = self.potential.saddles
        return float(np.hypot(*saddles.T).max()) if len(saddles) else self.potential.units.length

    @property
    def time_unit(self) -> float:
        return self.potential.units.time

    @cached_property
    def orbits(self) -> OwnOrbits:
        return OwnOrbits(self.system, self.size * (_FAR if self.potential.channels else _FAR_WITHOUT_EXIT))

    @cached_property
    def exits(self) -> Exits:
        """The exits of the engine, each integrated anew. UndecidedError unless all end at rest on the other wall.

        Very unstable orbits are integrated in parts.
        """
        channels, paths = [], []
        for orbit in find_lyapunov_orbits(self.potential, self.energy):
            starts, duration = parts_of_half(orbit)
            parts = [self.orbits.path(start, duration)[:, :2] for start in starts]
            middle = orbit.x.size // 2
            wanted = [*starts[1:, :2], (orbit.x[middle], orbit.y[middle])]
            apart = np.hypot(*np.transpose([part[-1] for part in parts] - np.array(wanted)))
            if not apart.max() <= 1e-6 * self.size:
                raise UndecidedError("an exit, integrated anew, does not end where the engine says")
            channels.append(orbit.channel)
            paths.append(np.concatenate(parts))
        return Exits(channels, paths)

    @cached_property
    def flux(self) -> EscapeFlux:
        """What the engine says of the flux through its exits."""
        return compute_flux(self.potential, self.energy)

    @cached_property
    def lattice(self) -> Lattice:
        """A lattice that contains the exits."""
        return Lattice(self.system, self.energy, self.exits, _LATTICE * self.size)

    def hidden_starts(self, count: int, seed: int) -> np.ndarray:
        """Return starts of this energy anywhere inside, also where the origin is not seen, of shape (n, 4)."""
        random = np.random.default_rng(seed)
        places = self.lattice.points(self.lattice.surely_inside)
        if not len(places):
            return np.empty((0, 4))
        places = random.choice(places, count) + 0.5 * self.lattice.step * random.uniform(-1.0, 1.0, (count, 2))
        kinetic, turn = self.energy - self.system.value(*places.T), random.uniform(0.0, 2.0 * np.pi, count)
        momenta = np.sqrt(2.0 * np.maximum(kinetic, 0.0)) * np.array([np.cos(turn), np.sin(turn)])
        return np.column_stack([places, *momenta])[(kinetic > 0.0) & (kinetic < _MOST_KINETIC * self.potential.units.energy)]

    def random_starts(self, count: int, seed: int, *, within: float = np.inf) -> np.ndarray:
        """Return starts of this energy that are seen from the origin, before any wall or exit, of shape (n, 4)."""
        random, exits = np.random.default_rng(seed), self.exits
        # The well may be much smaller than the distance of the farthest exit.
        fractions = np.union1d(np.linspace(0.0, 1.0, 400), np.geomspace(1e-7, 1.0, 400))
        starts = []
        for angle, part, turn in random.uniform(0.0, 1.0, (count, 3)) * [2.0 * np.pi, 0.98, 2.0 * np.pi]:
            reach = min(within, 1.5 * self.size)
            ray = reach * fractions[:, None] * [np.cos(angle), np.sin(angle)]
            allowed = self.system.value(*ray.T) < self.energy
            length = int(np.argmin(allowed)) or len(ray)
            segment, channel = exits.first_crossed(ray[:length])
            place = (part if channel or length < len(ray) else part * self.size / reach) * ray[segment if channel else length - 1]
            kinetic = self.energy - float(self.system.value(*place))
            # The samples may miss a thin wall.
            is_seen = np.all(self.system.value(*np.outer(place, _FINE)) < self.energy)
            if is_seen and 0.0 < kinetic < _MOST_KINETIC * self.potential.units.energy:
                starts.append([*place, *(np.sqrt(2.0 * kinetic) * np.array([np.cos(turn), np.sin(turn)]))])
        return np.array(starts).reshape(-1, 4)

    def shifted(self, states: np.ndarray) -> np.ndarray:
        """Return states shifted by `SHIFT`, with momenta that restore the energy, or unchanged where this is impossible."""
        moved = states + SHIFT * self.potential.units.length * np.array([1.0, -0.7, 0.0, 0.0])
        kinetic = self.energy - self.system.value(*moved[:, :2].T)
        factor = np.sqrt(np.maximum(2.0 * kinetic, 0.0)) / np.maximum(np.hypot(*moved[:, 2:].T), 1e-300)
        moved[:, 2:] *= factor[:, None]
        return np.where((kinetic > 0.0)[:, None], moved, states)

    def classify_robustly(self, states: np.ndarray, t_max: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the engine's fates and escape times, and the change of the times by a shift, NaN where the fate changes."""
        first, second = (
            classify_orbits(self.potential, self.energy, each, t_max=t_max) for each in (states, self.shifted(states))
        )
        change = np.where(first.fate > 0, np.abs(first.escape_time - second.escape_time), 0.0)
        return first.fate, first.escape_time, np.where(first.fate == second.fate, change, np.nan)
