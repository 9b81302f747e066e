"""Tubes of orbits that come in from the Lyapunov orbit over an exit: the inner branch of its unstable manifold, forward."""

from __future__ import annotations

import math
import threading
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import read_only
from engine.dynamics.compiled import kernels_of, step_tolerance
from engine.dynamics.fixed_step_batches import glide
from engine.dynamics.lyapunov_orbits import LyapunovOrbit, channel_axes, exit_curves, exit_gates
from engine.execution import is_cancelled
from engine.potentials.potential import Potential
from engine.taylor.kernels.dense_output import sample_path, trace_steps

# Displacement in phase space from the Lyapunov orbit, at most, at which the tube is launched. How far a launch lies off the tube,
# by the time the tube has grown to the well's size, falls like its third power: 4e-8 for 1e-2, 3e-11 for 1e-3, and so 3e-13 here.
_LAUNCH = 2e-4
# On the way from one cut to the next the tube may stay near another Lyapunov orbit, for so many periods at most that matter.
_MOST_PERIODS = 12.0
# An orbit over a saddle multiplies by 38 and more; at 1 it would be stable, or about to be.
_LEAST_MULTIPLIER = 1.5
# A Lyapunov orbit that crosses y = 0 itself is a point of the section, and one endless curve leads away from it. The first
# image ends where a displacement, if it went on growing as near that orbit, would be so many times as far as the saddle is.
_FIRST_IMAGE_ENDS = 6.0


@dataclass(frozen=True, eq=False)
class UnstableManifold:
    """The inner branch of a Lyapunov orbit's unstable manifold, as a family of orbits numbered from 0 to 1.

    A displacement from one point of the orbit, in the unstable direction, grows by the multiplier in a period. So displacements
    between one size and that many times as large are all the orbits of the branch, and numbers 0 and 1 are the same one.

    Attributes
    ----------
    potential, orbit
        What it belongs to.
    direction
        (4,) unit vector in phase space at the orbit's first point, where it is at rest: the unstable direction, inward.
    multiplier
        The unstable eigenvalue of the monodromy matrix, above 1.
    smallest, largest
        Displacements of numbers 0 and 1.
    near_cuts
        How many passages of y = 0 belong to the neighbourhood of the Lyapunov orbit: 0 where that does not cross y = 0.
    """

    potential: Potential
    orbit: LyapunovOrbit
    direction: np.ndarray
    multiplier: float
    smallest: float
    largest: float
    near_cuts: int

    @classmethod
    def from_orbit(cls, potential: Potential, orbit: LyapunovOrbit) -> UnstableManifold:
        """The tube of a Lyapunov orbit; ValueError when that orbit is not unstable in the way in which saddles make it so."""
        monodromy = _monodromy(potential, orbit)
        multiplier, direction = _leading_eigenvector(monodromy)
        if not multiplier > _LEAST_MULTIPLIER:
            raise ValueError(f"energy={orbit.energy}: the Lyapunov orbit of channel {orbit.channel} has no unstable direction")
        if direction[:2] @ channel_axes(potential, orbit.channel) > 0.0:
            direction = -direction
        largest, near_cuts = _LAUNCH, 0
        if orbit.y[0] * orbit.y[orbit.y.size // 2] <= 0.0:
            end = _FIRST_IMAGE_ENDS * float(np.hypot(*potential.saddles[orbit.channel - 1]))
            periods = math.ceil(math.log(end / _LAUNCH) / math.log(multiplier))
            largest, near_cuts = end * multiplier**-periods, periods - 1
        tube = cls(potential, orbit, read_only(direction), multiplier, largest / multiplier, largest, near_cuts)
        return replace(tube, largest=tube._size_after_period(_leading_eigenvector(monodromy.T)[1]))

    def _size_after_period(self, across: np.ndarray) -> float:
        """The displacement at which number 0 comes by again, its growth not being quite linear.

        across (4,): the left eigenvector of the multiplier; what it gives for a displacement is its unstable part.
        """
        kernels = kernels_of(self.potential)
        (start,) = self.launch(np.array([self.smallest]))
        steps = trace_steps(kernels, start, self.orbit.period, self.potential.channels, tolerance=step_tolerance(self.potential))
        back = sample_path(kernels, steps, np.array([self.orbit.period]))[:, 0]
        size = self.largest
        for _ in range(3):
            (tried,) = self.launch(np.array([size]))
            size += float(across @ (back - tried) / (across @ self.direction))
        return size

    def follow(
        self, numbers: np.ndarray, most: int, executor: Executor | None = None, cancel: threading.Event | None = None
    ) -> np.ndarray:
        """(n, most, 3) x, px and time of the first downward passages of y = 0 of these orbits, before they leave.

        NaN where there are fewer. Times count from when the displacement, growing as it does at first, is 1: alike for 0 and 1.
        Raises CancelledError when cancelled.
        """
        sizes = self.sizes(numbers)
        pace = self.orbit.period / math.log(self.largest / self.smallest)
        curves = exit_curves(self.potential, self.orbit.energy)
        horizon = most * _MOST_PERIODS * self.orbit.period - pace * math.log(self.smallest)
        arguments = (most, curves, exit_gates(curves), horizon)
        cuts = glide(_cut, self.potential, self.launch(sizes), *arguments, shape=(most, 3), executor=executor, cancel=cancel)
        if is_cancelled(cancel):
            raise CancelledError
        cuts[:, :, 2] += pace * np.log(sizes)[:, None]
        return cuts

    def sizes(self, numbers: np.ndarray) -> np.ndarray:
        """(n,) displacements of the orbits with these numbers."""
        sizes: np.ndarray = self.smallest * (self.largest / self.smallest) ** numbers
        return sizes

    def launch(self, sizes: np.ndarray) -> np.ndarray:
        """(n, 4) states displaced by these sizes from rest at the wall, and put back on the energy."""
        states: np.ndarray = np.array([self.orbit.x[0], self.orbit.y[0], 0.0, 0.0]) + sizes[:, None] * self.direction
        for _ in range(3):
            slope = np.column_stack([*self.potential.gradient(states[:, 0], states[:, 1]), states[:, 2:]])
            excess = self.potential.energy(states) - self.orbit.energy
            states = states - (excess / np.sum(slope * slope, axis=1))[:, None] * slope
        return states


def _leading_eigenvector(matrix: np.ndarray) -> tuple[float, np.ndarray]:
    """The eigenvalue that is largest in size, and its unit vector, real parts."""
    values, vectors = np.linalg.eig(matrix)
    leading = int(np.argmax(np.abs(values)))
    return float(values[leading].real), vectors[:, leading].real.copy()


def _monodromy(potential: Potential, orbit: LyapunovOrbit) -> np.ndarray:
    """(4, 4) linearised flow over a period, from rest."""
    kernels = kernels_of(potential)
    steps = trace_steps(
        kernels,
        np.array([orbit.x[0], orbit.y[0], 0.0, 0.0]),
        orbit.period,
        potential.channels,
        tolerance=step_tolerance(potential),
    )
    durations = np.diff(steps[:, 4], append=orbit.period)
    columns = np.eye(4)
    for state, duration in zip(steps[:, :4], durations, strict=True):
        kernels.tangent(4, np.full(4, duration), *np.repeat(state, 4).reshape(4, 4), *columns)
    return columns


def _cut(potential: Potential, tile: np.ndarray, most: int, curves: np.ndarray, gates: np.ndarray, horizon: float) -> np.ndarray:
    cuts = np.full((tile.shape[1], most, 3), np.nan)
    found = np.zeros(tile.shape[1], np.int64)
    kernels_of(potential).find_section_passages(step_tolerance(potential), horizon, gates, curves, tile, cuts, found)
    return cuts
