"""A Lyapunov orbit: a periodic orbit over a saddle, with its path and its exit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from engine.exits.closed_orbit import ClosedOrbit, Nodes, stability_index
from engine.exits.exit_lines import line_points
from engine.exits.exit_shapes import mirrored_curve
from engine.exits.saddle_orbits.orbit_parts import monodromy_of_brake_orbit
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.landscape.mirror_images import Signs
from engine.systems.merged_channels import name_channels
from engine.systems.potential import Potential
from engine.systems.well_units import ENERGY, LENGTH, MOMENTUM, TIME, WellUnits


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovOrbit(ClosedOrbit):
    """One Lyapunov orbit; all quantities are dimensionless. The arrays are read-only.

    Attributes
    ----------
    channel
        Number of the exit channel, from 1.
    energy
        Energy h of the orbit.
    period
        Period of the orbit.
    x, y
        (201,) path over one period, evenly spaced in time, from one side of the channel to the other and back; in a rotating
        frame, once around a closed curve. The first and the last point are equal.
    curve
        (columns,) the exit as a row of numbers, as the kernels of the integrator read it.
    velocity
        (2,) momenta px and py at the first point, which equal ẋ and ẏ; 0 unless the frame rotates.
    inner_states
        (n, 4) x, y, px and py after n of n + 1 equal parts of the period, where a very unstable orbit is integrated in parts;
        otherwise empty.
    others
        Numbers of the other channels of the same exit, if the energy is above the maxima between them and `channel`, which is
        the lowest number.
    potential
        The potential in which the orbit moves.
    """

    channel: int
    energy: float = field(metadata=ENERGY)
    period: float = field(metadata=TIME)
    x: np.ndarray = field(metadata=LENGTH)
    y: np.ndarray = field(metadata=LENGTH)
    curve: np.ndarray
    velocity: np.ndarray = field(default_factory=lambda: np.zeros(2), metadata=MOMENTUM)
    inner_states: np.ndarray = field(default_factory=lambda: np.empty((0, 4)))
    others: tuple[int, ...] = ()
    potential: Potential = field(kw_only=True, repr=False)

    array_dimensions: ClassVar = {"curve": ("column",), "velocity": ("component",), "inner_states": ("part", "coordinate")}
    inner_names: ClassVar = ClosedOrbit.inner_names | {"mirrored", "restored", "symmetrized"}

    @property
    def start(self) -> np.ndarray:
        """(4,) x, y, px and py at the first point."""
        return np.array([self.x[0], self.y[0], *self.velocity])

    @property
    def nodes(self) -> Nodes:
        """See `ClosedOrbit.nodes`. In a frame at rest, the orbit is at rest again after half its period."""
        units = self.potential.units
        states, period = np.vstack([self.start, self.inner_states]), self.period / units.time
        if self._is_traced_back:
            states = np.vstack([states, [*self.half_path[-1], 0.0, 0.0]])
        return Nodes(states / units.state, np.full(len(states), period / len(states)))

    @property
    def monodromy_matrix(self) -> np.ndarray:
        """See `ClosedOrbit.monodromy_matrix`. In a frame at rest, the matrix follows from half the period."""
        well, nodes = self.potential.in_well_units, self.nodes
        if self._is_traced_back:
            return monodromy_of_brake_orbit(well, nodes.states[0], nodes.durations[0])
        return nodes.monodromy_matrix(well)

    @cached_property
    def stability_index(self) -> float:
        """a = ½ (tr M − 2), with the monodromy matrix M of one period; nearby orbits leave an unstable orbit, abs(a) > 1.

        Examples
        --------
        >>> from escape_explorer import CASES, find_lyapunov_orbits
        >>> orbit = find_lyapunov_orbits(CASES["I"], 0.19)[0]
        >>> round(orbit.stability_index, 3), round(orbit.multipliers[0].real, 2)
        (46.928, 93.85)
        """
        return stability_index(self.monodromy_matrix)

    @cached_property
    def action(self) -> float:
        """J = ∮ p dq over one period, with the canonical momenta; dJ/dh = T along a family."""
        units = self.potential.units
        return self.nodes.action(self.potential.in_well_units) * units.length * units.momentum

    def provenance(self) -> dict[str, Any]:
        """Return the potential, the energy, the integrator and the version."""
        return self.potential.describe_run(energy=self.energy)

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return the path and its times."""
        return {"t": np.linspace(0.0, self.period, self.x.size), "x": self.x, "y": self.y}

    @property
    def name(self) -> str:
        """The name of the exit, such as "L1"; without names its channel number, "1", or "1+3" if two channels form the exit."""
        named = self.potential.exit_names if len(self.potential.exit_names) == self.potential.channels else ()
        return name_channels((self.channel, *self.others), named)

    @property
    def outward(self) -> np.ndarray:
        """(2,) unit vector out of the well, across the exit."""
        return self.curve[geometry.OUTWARD_X : geometry.OUTWARD_Y + 1]

    @property
    def half_path(self) -> np.ndarray:
        """(101, 2) half a period of the path, from one side of the channel to the other; the other half retraces it.

        In a rotating frame, this is the whole closed path, (201, 2).
        """
        path = np.column_stack([self.x, self.y])
        return path if self._is_closed_curve else path[: self.x.size // 2 + 1]

    @property
    def exit_path(self) -> np.ndarray:
        """(n, 2) points of the exit: half the path, or, in a rotating frame, the parabola just outside the orbit."""
        return line_points(self.curve) if self._is_closed_curve else self.half_path

    @property
    def _is_closed_curve(self) -> bool:
        # Only in a rotating frame is the orbit a closed curve, and its exit a parabola (LINE).
        return bool(self.curve[geometry.SHAPE] == geometry.LINE)

    @property
    def _is_traced_back(self) -> bool:
        # Whether the second half of the period is computed as the first one, traced back.
        return not self._is_closed_curve and not self.inner_states.size

    def restored(self, units: WellUnits) -> LyapunovOrbit:
        """Convert the orbit from units of the well to those of its potential."""
        if units == WellUnits():
            return self
        curve = self.curve * units.length
        # These columns have no unit.
        unitless = slice(geometry.OUTWARD_X, geometry.SHAPE + 1)
        curve[unitless] = self.curve[unitless]
        return replace(units.restore(self), curve=curve, inner_states=self.inner_states * units.state)

    def mirrored(self, channel: int, signs: Signs) -> LyapunovOrbit:
        """Return the exact image under a reflection in a frame at rest, so that mirror images escape at the same time."""
        x_sign, y_sign = signs
        path, inner_states = (x_sign * self.x, y_sign * self.y), self.inner_states * np.tile(signs, 2)
        curve = mirrored_curve(self.curve, signs)
        return replace(self, channel=channel, x=path[0], y=path[1], curve=curve, inner_states=inner_states)

    def symmetrized(self, signs: Signs) -> LyapunovOrbit:
        """Return this orbit, which is its own mirror image, with an exit curve that is exactly its own mirror image."""
        return replace(self, curve=0.5 * (self.curve + mirrored_curve(self.curve, signs)))
