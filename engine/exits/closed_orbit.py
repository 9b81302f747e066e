"""A periodic orbit: its stability, its action and its path follow from states from which short parts of it are integrated."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from engine.exits.monodromy import Monodromy, canonical_axes, eigenvectors
from engine.exits.saddle_orbits.orbit_parts import matrix_product, monodromy_matrix, trace_parts
from engine.foundations.arrays import read_only
from engine.foundations.result import Result
from engine.foundations.validation import checked_count
from engine.integrator.kernels.dense_output import sample_path
from engine.systems.potential import Potential

# Points of Gauss's quadrature in a step of the integrator, whose path is a polynomial.
_GAUSS_POINTS = 20


class Nodes(NamedTuple):
    """The states of a closed orbit from which its parts begin, in units of the well.

    Attributes
    ----------
    states
        (nodes, 4) x, y, px, py.
    durations
        (nodes,) durations of the parts, in the order of time.
    """

    states: np.ndarray
    durations: np.ndarray

    def monodromy_matrix(self, potential: Potential) -> np.ndarray:
        """Return the monodromy matrix, (4, 4), which is the product of the matrices of the parts."""
        parts = zip(self.states, self.durations.tolist(), strict=True)
        return matrix_product(np.array([monodromy_matrix(potential, state, duration) for state, duration in parts]))

    def stability_index(self, potential: Potential) -> float:
        """Return a of the monodromy matrix."""
        return stability_index(self.monodromy_matrix(potential))

    def action(self, potential: Potential) -> float:
        """Return the integral of the canonical momentum along the orbit, whose derivative by the energy is the period.

        In a frame that rotates at the rate Ω, the canonical momentum is (px − Ω y, py + Ω x). NaN if the orbit cannot be
        integrated.
        """
        parts = trace_parts(potential, self.states, self.durations)
        if parts is None:
            return np.nan
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
        total = 0.0
        for steps, duration in zip(parts.steps, self.durations, strict=True):
            sizes = np.diff(steps[:, 4], append=duration)
            times = steps[:, 4, None] + 0.5 * (nodes + 1.0) * sizes[:, None]
            x, y, vx, vy = sample_path(potential.well.kernels, steps, times.ravel()).reshape(4, *times.shape)
            integrand = vx * vx + vy * vy + potential.rotation * (x * vy - y * vx)
            total += float(np.sum(0.5 * sizes[:, None] * weights * integrand))
        return total

    def sampled_path(self, potential: Potential, points: int) -> np.ndarray:
        """Return the path at about this number of times, evenly spaced within each part, as rows t, x, y, px, py."""
        parts = trace_parts(potential, self.states, self.durations)
        if parts is None:
            return np.empty((5, 0))
        period = self.durations.sum()
        begins = np.cumsum(self.durations) - self.durations
        counts = np.maximum(np.ceil(points * self.durations / period), 2).astype(int)
        pieces = []
        for steps, begin, duration, count in zip(parts.steps, begins, self.durations, counts, strict=True):
            times = np.arange(count) * (duration / count)
            pieces.append(np.vstack([begin + times, sample_path(potential.well.kernels, steps, times)]))
        last = np.append(period, self.states[0])
        return np.column_stack([*pieces, last])


def stability_index(monodromy: np.ndarray) -> float:
    """Return a = ½ (tr M − 2) of a closed orbit with monodromy matrix M, (4, 4) (Hénon 1965, Ann. Astrophys. 28, 992).

    Eigenvalues of M would have errors of the root of rounding, because 1 is a double eigenvalue.
    """
    return 0.5 * (float(np.trace(monodromy)) - 2.0)


class Stability(StrEnum):
    """The motion near a periodic orbit, from its stability index a = ½ (tr M − 2) with the monodromy matrix M.

    Nearby orbits stay near a stable orbit, abs(a) ≤ 1. They leave an unstable orbit along two curves: on the same side, a > 1, or
    on alternating sides (with reflection), a < −1.
    """

    STABLE = "stable"
    UNSTABLE = "unstable"
    REFLECTING = "unstable with reflection"

    @classmethod
    def of(cls, index: float) -> Stability:
        """Return the stability that belongs to a stability index, a finite number."""
        return cls.STABLE if abs(index) <= 1.0 else cls.UNSTABLE if index > 1.0 else cls.REFLECTING


class ClosedOrbit(Result):
    """Base of periodic orbits, which have an energy h, a period T, a stability index a, an action J and a potential."""

    energy: float
    period: float
    potential: Potential
    inner_names: ClassVar = Result.inner_names | {"monodromy_matrix", "nodes"}

    if TYPE_CHECKING:
        # Fields of some kinds of orbits, and computed when they are asked for of others.

        @property
        def stability_index(self) -> float:
            """a = ½ (tr M − 2), with the monodromy matrix M of one period."""

        @property
        def action(self) -> float:
            """J = ∮ p dq over one period, with the canonical momenta."""

    @property
    def start(self) -> np.ndarray:
        """(4,) x, y, px and py at the time 0."""
        raise NotImplementedError

    @property
    def nodes(self) -> Nodes:
        """The orbit in units of the well, as parts in which errors do not grow much."""
        raise NotImplementedError

    @property
    def monodromy_matrix(self) -> np.ndarray:
        """(4, 4) the matrix of one period for x, y, ẋ, ẏ, in units of the well."""
        return self.nodes.monodromy_matrix(self.potential.in_well_units)

    @property
    def stability(self) -> Stability:
        """The motion near the orbit."""
        return Stability.of(self.stability_index)

    @property
    def residue(self) -> float:
        """Greene's residue R = ½ (1 − a): stable from 0 to 1, unstable below 0, unstable with reflection above 1."""
        return 0.5 * (1.0 - self.stability_index)

    @property
    def rotation_number(self) -> float:
        """Turns of a nearby orbit around a stable orbit in a period, arccos(a)/2π, 0 to ½; NaN for an unstable orbit."""
        return float(np.arccos(self.stability_index) / (2.0 * np.pi)) if abs(self.stability_index) <= 1.0 else np.nan

    @property
    def multipliers(self) -> np.ndarray:
        """(2,) complex Floquet multipliers λ and 1/λ, abs(λ) ≥ 1; the other two eigenvalues of M are 1."""
        index = complex(self.stability_index)
        root = np.sqrt(index * index - 1.0)
        larger = index + root if self.stability_index >= 0.0 else index - root
        return read_only(np.array([larger, 1.0 / larger]))

    def find_monodromy(self) -> Monodromy:
        """Return the monodromy matrix at the start of the orbit in canonical coordinates, with multipliers and eigenvectors.

        The matrix is that of the equations of motion linearised along one period, with the series of the integrator. For a very
        unstable orbit, it is a product of the matrices of short parts.

        Examples
        --------
        >>> from escape_explorer import POTENTIALS, find_lyapunov_orbits
        >>> orbit = find_lyapunov_orbits(POTENTIALS["Earth-Moon"], -1.09)[0]
        >>> monodromy = orbit.find_monodromy()
        >>> orbit.name, round(float(monodromy.multipliers[0].real), 1)
        ('L2', 1254.8)
        """
        potential = self.potential
        state_units = np.array(potential.units.state)
        axes = canonical_axes(potential.mass * potential.rotation)
        matrix = self.monodromy_matrix * state_units[:, None] / state_units
        matrix = axes @ matrix @ np.linalg.inv(axes)
        flow = axes @ potential.derivatives(self.start)
        return Monodromy(matrix, self.multipliers, eigenvectors(matrix, self.multipliers), flow)

    def find_path(self, points: int = 400) -> np.ndarray:
        """Return the path of one period, of shape (5, m): t, x, y, px and py at about this number of times, 2 to 1e6.

        The last point is the first one. Integration over several periods would leave an unstable orbit.
        """
        units = self.potential.units
        path = self.nodes.sampled_path(self.potential.in_well_units, checked_count("points", points, 2, 10**6))
        return path * np.array([units.time, *units.state])[:, None]
