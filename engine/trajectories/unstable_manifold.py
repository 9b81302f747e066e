"""The inner branch of the unstable manifold of a Lyapunov orbit: a tube of orbits that lead from the exit into the well."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from engine.exits.exit_rows import exit_curves
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.saddle_orbits.orbit_parts import monodromy_matrix
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.dense_output import sample_path, trace_steps
from engine.integrator.source.section_numbers import SectionNumbers
from engine.propagation.passages import find_passages, find_passages_of_orbit
from engine.systems.potential import Potential

# Largest displacement from the Lyapunov orbit at which orbits of the tube start, in units of the well. When the tube has grown to
# the size of the well, the distance of such an orbit from the manifold scales with the third power of the displacement: 4e-8 for
# 1e-2, 3e-11 for 1e-3, and thus 3e-13 for this value.
_MAX_DISPLACEMENT = 2e-4
# Longest time per passage of the section, in periods. Later passages, of orbits that stay near another Lyapunov orbit, are not
# needed.
_MAX_PERIODS_PER_PASSAGE = 12.0
# Smallest multiplier of an unstable orbit. Over a saddle, multipliers are 38 or more; near 1, an orbit is almost stable.
_MIN_MULTIPLIER = 1.5
# Largest multiplier. Above, rounding errors are a large part of the smallest displacement.
_MAX_MULTIPLIER = 1e9
# End of the first image of a Lyapunov orbit that crosses the section, in units of the distance of the saddle from the origin.
# Such an orbit is itself a point of the section, where one infinite curve begins. The image ends where a displacement that
# continued to grow by the multiplier would reach this size.
_FIRST_IMAGE_END = 6.0
# Share of a period after which a displacement of that size passes the section: the time of the downward passage of y = 0 in Case
# II. Orbits that pass at another time have other displacements at the start, so that their images have the same ends.
_USUAL_PASSAGE = 0.75
# Differences of that share below this value are rounding errors.
_ROUNDING = 1e-9
# Number of tiles that a thread computes at a time; a tile takes about 0.3 ms.
_TILES_PER_TASK = 16


@dataclass(frozen=True, eq=False)
class UnstableManifold:
    """The inner branch of a Lyapunov orbit's unstable manifold, as a one-parameter family of orbits.

    A displacement from a fixed point of the Lyapunov orbit, in the unstable direction, grows by the multiplier per period. The
    displacements between any size and the multiplier times that size therefore give each orbit of the branch once (a fundamental
    domain). The parameter of the family is a phase from 0 to 1; phases 0 and 1 give the same orbit.

    Attributes
    ----------
    orbit
        The Lyapunov orbit of a potential in units of its well.
    direction
        (4,) unit vector in phase space: the inward unstable direction at the first point of the orbit.
    multiplier
        Unstable Floquet multiplier, the eigenvalue of the monodromy matrix of largest modulus, above 1.5.
    min_displacement, max_displacement
        Displacements of phase 0 and of phase 1, in units of the well.
    section
        The surface of section that its orbits cross, see `Section.numbers`.
    near_passages
        Number of initial passages of the section near the Lyapunov orbit; 0 if that orbit does not cross it.
    """

    orbit: LyapunovOrbit
    direction: np.ndarray
    multiplier: float
    min_displacement: float
    max_displacement: float
    section: SectionNumbers
    near_passages: int

    @classmethod
    def from_orbit(cls, orbit: LyapunovOrbit, section: SectionNumbers) -> UnstableManifold:
        """Build the manifold of a Lyapunov orbit and its passages of a section of positions, crossed in one direction.

        Raises
        ------
        ValueError
            When the orbit is not unstable, is too unstable, or crosses the section more than once in a period.
        """
        if not abs(orbit.stability_index) < 0.5 * _MAX_MULTIPLIER:
            raise ValueError(
                f"the Lyapunov orbit of channel {orbit.channel} is too unstable for its tube; its multiplier "
                f"{2.0 * abs(orbit.stability_index):.3g} must be below {_MAX_MULTIPLIER:g}"
            )
        monodromy = monodromy_matrix(orbit.potential, orbit.start, orbit.period)
        multiplier, direction = _leading_eigenpair(monodromy)
        if not multiplier > _MIN_MULTIPLIER:
            raise ValueError(
                f"the Lyapunov orbit of channel {orbit.channel} is not unstable; "
                f"its multiplier {multiplier:.3g} must be above {_MIN_MULTIPLIER:g}"
            )
        if direction[:2] @ orbit.outward > 0.0:
            direction = -direction
        largest, near_passages = _choose_displacement(orbit, multiplier, section)
        manifold = cls(orbit, read_only(direction), multiplier, largest / multiplier, largest, section, near_passages)
        _, left_eigenvector = _leading_eigenpair(monodromy.T)
        return replace(manifold, max_displacement=manifold._displacement_after_period(left_eigenvector))

    @property
    def potential(self) -> Potential:
        """The potential in units of its well."""
        return self.orbit.potential

    def _displacement_after_period(self, left_eigenvector: np.ndarray) -> float:
        """Return the displacement of the orbit of phase 0 after one period, with nonlinear terms.

        The product of `left_eigenvector`, (4,), which belongs to the multiplier, and a displacement is proportional to the
        unstable component of the displacement.
        """
        kernels = self.potential.well.kernels
        (start,) = self.start_states(np.array([self.min_displacement]))
        steps = trace_steps(kernels, start, self.orbit.period, len(self.potential.outcomes))
        target = sample_path(kernels, steps, np.array([self.orbit.period]))[:, 0]
        displacement = self.max_displacement
        # Three corrections reach the limit of rounding.
        for _ in range(3):
            (trial,) = self.start_states(np.array([displacement]))
            displacement += float(left_eigenvector @ (target - trial) / (left_eigenvector @ self.direction))
        return displacement

    def find_passages(self, phases: np.ndarray, count: int, execution: Execution = DEFAULT_EXECUTION) -> np.ndarray:
        """Find the first passages of the section of the orbits with these phases before they escape.

        Parameters
        ----------
        phases
            (n,) from 0 to 1.
        count
            Number of passages per orbit, at least 1.
        execution
            How the computation runs.

        Returns
        -------
        (n, count, 5) x, y, px, py and time; NaN for missing passages. The time is 0 where the displacement, if it grew
        exponentially at its initial rate, would be 1. Phases 0 and 1 thus give the same times.

        Raises
        ------
        concurrent.futures.CancelledError
            When cancelled.
        """
        displacements = self.displacements(phases)
        growth_time = self.orbit.period / math.log(self.max_displacement / self.min_displacement)
        curves = exit_curves(self.potential, self.orbit.energy)
        # The second term is the time in which the smallest displacement would grow to 1.
        duration = count * _MAX_PERIODS_PER_PASSAGE * self.orbit.period - growth_time * math.log(self.min_displacement)
        starts = self.start_states(displacements)
        passages, _ = find_passages(
            self.potential, starts, np.zeros(len(starts), np.int64), curves[None], count, duration, self.section,
            execution=execution, tiles_per_task=_TILES_PER_TASK,
        )  # fmt: skip
        execution.raise_if_cancelled()
        passages[:, :, 4] += growth_time * np.log(displacements)[:, None]
        return passages

    def displacements(self, phases: np.ndarray) -> np.ndarray:
        """Return the displacements of the orbits with these phases, (n,), in geometric progression."""
        return self.min_displacement * (self.max_displacement / self.min_displacement) ** phases

    def start_states(self, displacements: np.ndarray) -> np.ndarray:
        """Return n states displaced from the Lyapunov orbit's first point and projected back onto its energy, (n, 4)."""
        states: np.ndarray = self.orbit.start + displacements[:, None] * self.direction
        # Three steps of Newton's method along the gradient of H.
        for _ in range(3):
            gradient = np.column_stack([*self.potential.gradient(states[:, 0], states[:, 1]), states[:, 2:]])
            excess = self.potential.energy(states) - self.orbit.energy
            states = states - (excess / np.sum(gradient * gradient, axis=1))[:, None] * gradient
        return states


def _choose_displacement(orbit: LyapunovOrbit, multiplier: float, section: SectionNumbers) -> tuple[float, int]:
    """Return `max_displacement`, without nonlinear terms, and `near_passages`, see `UnstableManifold`."""
    times = find_passages_of_orbit(orbit.potential, orbit.start, 2, orbit.period, section)[:, 4]
    if times.size > 1:
        raise ValueError(f"the Lyapunov orbit of channel {orbit.channel} crosses the section more than once in a period")
    if times.size == 0:
        return _MAX_DISPLACEMENT, 0
    earlier = _USUAL_PASSAGE - float(times[0]) / orbit.period
    growth = 1.0 if abs(earlier) < _ROUNDING else multiplier**earlier
    end = _FIRST_IMAGE_END * float(np.hypot(*orbit.potential.saddles[orbit.channel - 1])) * growth
    periods = math.ceil(math.log(end / _MAX_DISPLACEMENT) / math.log(multiplier))
    return end * multiplier**-periods, periods - 1


def _leading_eigenpair(matrix: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the eigenvalue of largest modulus and its unit eigenvector, which are real for an unstable orbit."""
    values, vectors = np.linalg.eig(matrix)
    leading = int(np.argmax(np.abs(values)))
    return float(values[leading].real), vectors[:, leading].real.copy()
