"""Periodic orbits over a saddle, found by Newton's method for several states of a period and by continuation.

The motion linearised at a saddle of the effective potential Φ has a pair of eigenvalues ±iν: small oscillations of period 2π/ν,
which span the centre subspace. By Lyapunov's centre theorem, a family of periodic orbits begins with these oscillations. Let E be
the energy of the saddle and σ = √(h − E). The size of small orbits is proportional to σ. The period and (position − saddle)/σ
depend smoothly on σ. Each orbit is predicted from orbits at smaller σ. Newton's method corrects several states of one period at
once, so errors grow over only a part of the period (multiple shooting; Stoer & Bulirsch 2002, Introduction to Numerical Analysis,
section 7.3.5). All quantities are in units of the well.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np

from engine.exits.saddle_orbits.brake_orbits import Axes, BrakeOrbit, saddle_axes
from engine.exits.saddle_orbits.continuation import StepLimits, follow
from engine.exits.saddle_orbits.orbit_parts import Parts, trace_parts, velocities
from engine.integrator.kernels.dense_output import sample_path
from engine.systems.landscape.closed_energy import ridge_bend
from engine.systems.potential import Potential

# Number of intervals of the path.
_INTERVALS = 200
_MOST_CORRECTIONS = 12
# Relative size below which corrections that no longer decrease are rounding errors.
_CORRECTION_TOLERANCE = 1e-6
# Near the saddle, the tolerance is instead the rounding error of the energy, divided by σ², times this number.
_ENERGY_ROUNDINGS = 64
# Largest relative change of a prediction by its corrections; a larger change can be a jump to another orbit.
_LARGEST_CHANGE = 0.1
# Number of orbits from which the next one is predicted.
_PREDICTOR_ORBITS = 4
# Largest number of steps of σ.
_MOST_STEPS = 400
# Sharpness of the smooth maximum that defines the edge of an orbit, see `_edge`.
_SHARPNESS = 50.0
# Largest speed at the ends of an orbit in a frame at rest, in units of the well.
_LARGEST_END_SPEED = 1e-12
# Largest distance between the ends of neighbouring parts of an orbit, in units of the well.
_LARGEST_GAP = 1e-10


class _Effort(NamedTuple):
    """The number of nodes, a divisor of 200, and the smallest step of σ in units of the final σ.

    Nodes are states of one period that are corrected together.
    """

    nodes: int
    smallest_step: float


_ROTATING = _Effort(8, 2.0**-10)
# Orbits in a frame at rest are followed where they are very unstable.
_AT_REST = _Effort(20, 2.0**-6)

# The values of σ reached last, each with the unknowns of its orbit, see `_correct`.
_KnownOrbits = list[tuple[float, np.ndarray]]


class SaddleOrbit(NamedTuple):
    """One period of an orbit over a saddle, starting at the turning point with the smallest q in the axes of the saddle.

    Attributes
    ----------
    period
        Period of the orbit, dimensionless.
    path
        (4, 201) x, y, ẋ, ẏ, evenly spaced in time; the last point is the first one.
    nodes
        (nodes, 4) the states that were corrected together, evenly spaced in time; the first one is that of the path.
    edge
        Value of u − a q² on the parabola just outside the orbit, dimensionless; u and q are in the axes of the saddle, and a is
        its `ridge_bend`.
    """

    period: float
    path: np.ndarray
    nodes: np.ndarray
    edge: float


class _Family(NamedTuple):
    """The orbits over one saddle: the potential, the saddle as a state at rest (4,), its energy, its axes and `ridge_bend`."""

    potential: Potential
    saddle_state: np.ndarray
    saddle_energy: float
    axes: Axes
    bend: float

    @property
    def effort(self) -> _Effort:
        return _ROTATING if self.potential.rotation else _AT_REST

    @property
    def nodes(self) -> int:
        return self.effort.nodes

    def sigma(self, energy: float) -> float:
        """Return σ at an energy above that of the saddle."""
        return float(np.sqrt(energy - self.saddle_energy))

    def states(self, sigma: float, unknowns: np.ndarray) -> np.ndarray:
        """Return the states at the nodes, (nodes, 4), from the unknowns of `_correct`."""
        states: np.ndarray = self.saddle_state + sigma * unknowns[:-1].reshape(self.nodes, 4)
        return states

    def trace(self, states: np.ndarray, period: float) -> Parts | None:
        """Return the parts of an orbit of some period that start at its nodes (nodes, 4); None if they cannot be integrated."""
        return trace_parts(self.potential, states, np.full(self.nodes, period / self.nodes))


@functools.lru_cache(maxsize=64)
def find_brake_orbit(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Return the orbit over a saddle in a frame at rest, also where it is too unstable for one integration of half a period.

    Orbits over several saddles are not found, because they do not begin as small oscillations.
    """
    orbit = find_saddle_orbit(potential, energy, channel)
    # Both ends are nodes.
    if orbit is None or not np.abs(orbit.nodes[[0, _AT_REST.nodes // 2], 2:]).max() < _LARGEST_END_SPEED:
        return None
    return BrakeOrbit(0.5 * orbit.period, orbit.path[:2, : _INTERVALS // 2 + 1], orbit.nodes[1:])


def find_saddle_orbit(potential: Potential, energy: float, channel: int) -> SaddleOrbit | None:
    """Return the orbit over a saddle at an energy above it, followed from the small oscillations; None if it is not found.

    Parameters
    ----------
    potential
        The potential in units of its well.
    energy
        h, above the energy of the saddle, dimensionless.
    channel
        Number of the saddle, from 1.
    """
    family = _family_over(potential, channel)
    # Trial orbits that diverge are rejected later.
    with np.errstate(all="ignore"):
        unknowns = _continue_to(family, family.sigma(energy))
        return None if unknowns is None else _complete_orbit(family, energy, unknowns)


def _family_over(potential: Potential, channel: int) -> _Family:
    saddle, axes = potential.saddles[channel - 1], saddle_axes(potential, channel)
    saddle_energy = float(potential.well.saddle_energies[channel - 1])
    return _Family(potential, np.array([*saddle, 0.0, 0.0]), saddle_energy, axes, ridge_bend(potential.form, *axes))


def _continue_to(family: _Family, sigma: float) -> np.ndarray | None:
    """Return the unknowns of the orbit at σ, see `_correct`, followed from σ = 0 with an adaptive step; None if this fails."""

    def advance(known: _KnownOrbits, target: float) -> _KnownOrbits | None:
        corrected = _correct(family, target, _extrapolate(known, target))
        return None if corrected is None else [*known, (target, corrected)][-_PREDICTOR_ORBITS:]

    limits = StepLimits(sigma, family.effort.smallest_step * sigma, _MOST_STEPS)
    known = follow(advance, [(0.0, _small_oscillation(family))], 0.0, sigma, limits)
    return None if known is None else known[-1][1]


def _small_oscillation(family: _Family) -> np.ndarray:
    """Return the unknowns of `_correct` in the limit σ = 0."""
    rotation, axes = family.potential.rotation, family.axes
    flow = np.zeros((4, 4))
    flow[:2, 2:] = np.eye(2)
    flow[2:, :2] = -family.potential.hessian_matrix(*family.saddle_state[:2])
    flow[2:, 2:] = 2.0 * rotation * np.array([[0.0, 1.0], [-1.0, 0.0]])
    values, vectors = np.linalg.eig(flow)
    centre_index = int(np.argmax(values.imag))
    frequency = float(values[centre_index].imag)
    eigenvector = vectors[:, centre_index]
    # The phase is chosen so that q has its minimum at t = 0.
    q_amplitude = axes.outward[0] * eigenvector[1] - axes.outward[1] * eigenvector[0]
    oscillation = -eigenvector * np.conj(q_amplitude) / np.abs(q_amplitude)
    start = oscillation.real
    quadratic_energy = 0.5 * (start[2:] @ start[2:] - start[:2] @ flow[2:, :2] @ start[:2])
    angles = 2.0 * np.pi * np.arange(family.nodes) / family.nodes
    nodes = (oscillation[None] * np.exp(1j * angles)[:, None]).real / np.sqrt(quadratic_energy)
    return np.append(nodes, 2.0 * np.pi / frequency)


def _extrapolate(known: _KnownOrbits, target: float) -> np.ndarray:
    """Evaluate, at the target, the polynomial that interpolates the unknowns at known values of σ."""
    sigmas = np.array([sigma for sigma, _ in known])
    weights = [np.prod((target - np.delete(sigmas, k)) / (sigma - np.delete(sigmas, k))) for k, sigma in enumerate(sigmas)]
    return np.array(weights) @ np.array([unknowns for _, unknowns in known])


def _correct(family: _Family, sigma: float, predicted: np.ndarray) -> np.ndarray | None:
    """Correct a predicted orbit at σ by Newton's method; None if the method does not converge to a nearby orbit.

    The unknowns, (4 nodes + 1,), are (state − saddle)/σ at the nodes, evenly spaced over the period, and the period.
    """
    unknowns: np.ndarray = predicted.copy()
    previous_size = np.inf
    tolerance = max(_CORRECTION_TOLERANCE, _ENERGY_ROUNDINGS * float(np.spacing(abs(family.saddle_energy))) / sigma**2)
    for _ in range(_MOST_CORRECTIONS):
        correction = _newton_step(family, sigma, unknowns)
        if correction is None:
            return None
        unknowns = unknowns + correction
        size = _relative_size(correction, unknowns)
        # `not … <` also rejects NaN.
        if not _relative_size(unknowns - predicted, unknowns) < _LARGEST_CHANGE:
            return None
        if size < tolerance and size > 0.1 * previous_size:
            return unknowns
        previous_size = size
    return None


def _relative_size(change: np.ndarray, unknowns: np.ndarray) -> float:
    """Return the larger of two changes: of the states relative to the largest state, and of the period relative to itself."""
    states = np.abs(change[:-1]).max() / np.abs(unknowns[:-1]).max()
    return float(max(states, np.abs(change[-1] / unknowns[-1])))


def _newton_step(family: _Family, sigma: float, unknowns: np.ndarray) -> np.ndarray | None:
    """Return the least-squares solution of the linearised equations; None if the trial orbit cannot be integrated."""
    system = _linearise(family, sigma, unknowns)
    return None if system is None else -np.linalg.lstsq(*system, rcond=None)[0]


def _linearise(family: _Family, sigma: float, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Return the Jacobian matrix and the residual of the equations; None if the trial orbit cannot be integrated.

    The equations: each part ends where the next part begins, the energy is σ² above the saddle, and q̇ = 0 at the start.
    """
    states = family.states(sigma, unknowns)
    parts = family.trace(states, unknowns[-1])
    if parts is None:
        return None
    equations = 4 * family.nodes + 2
    jacobian, residual = np.zeros((equations, unknowns.size)), np.empty(equations)
    residual[:-2], jacobian[:-2, :-1] = parts.gaps(states) / sigma, parts.changes_of_gaps()
    jacobian[:-2, -1] = (velocities(family.potential, parts.ends) / (family.nodes * sigma)).ravel()
    start, outward = states[0], family.axes.outward
    residual[-2] = (family.potential.energy(start) - family.saddle_energy) / sigma**2 - 1.0
    jacobian[-2, :4] = np.array([*family.potential.gradient(start[0], start[1]), start[2], start[3]]) / sigma
    jacobian[-1, 2:4] = -outward[1], outward[0]
    residual[-1] = jacobian[-1, :4] @ unknowns[:4]
    return (jacobian, residual) if np.isfinite(residual).all() and np.isfinite(jacobian).all() else None


def _complete_orbit(family: _Family, energy: float, unknowns: np.ndarray) -> SaddleOrbit | None:
    """Return the orbit with its path and edge; None if its parts do not join within `_LARGEST_GAP`."""
    sigma, period = family.sigma(energy), float(unknowns[-1])
    states = family.states(sigma, unknowns)
    parts = family.trace(states, period)
    # `not … <` also rejects NaN.
    if parts is None or not np.abs(parts.gaps(states)).max() < _LARGEST_GAP:
        return None
    kernels, intervals = family.potential.well.kernels, _INTERVALS // family.nodes
    times = np.arange(intervals) * (period / family.nodes / intervals)
    pieces = [sample_path(kernels, steps, times) for steps in parts.steps]
    path = np.concatenate([*pieces, states[:1].T], axis=1)
    return SaddleOrbit(period, path, states, _edge(family, path))


def _edge(family: _Family, path: np.ndarray) -> float:
    """Return a little more than the largest u − a q² on the path (4, points) of an orbit, with a of `ridge_bend`.

    The largest value itself is not a smooth function of the energy where the point with this value jumps.
    """
    u, q = family.axes.coordinates(path[:2, :-1])
    offset = u - family.bend * q * q
    spread = float(offset.std())
    relative = (offset - offset.mean()) / spread
    return float(offset.mean()) + spread / _SHARPNESS * float(np.log(np.exp(_SHARPNESS * relative).sum()))
