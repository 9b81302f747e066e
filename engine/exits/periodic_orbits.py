"""Periodic orbits over a saddle in a rotating frame, found by Newton's method and continuation.

The motion linearised at a saddle of the effective potential Φ has a pair of eigenvalues ±iν: small oscillations of period 2π/ν,
which span the centre subspace. By Lyapunov's centre theorem, a family of periodic orbits begins with these oscillations. Let E be
the energy of the saddle and σ = √(h − E). The size of small orbits is proportional to σ. The period and (position − saddle)/σ
depend smoothly on σ. Each orbit is predicted from orbits at smaller σ. Newton's method corrects several states of one period at
once, so errors grow over only a part of the period (multiple shooting; Stoer & Bulirsch 2002, Introduction to Numerical Analysis,
section 7.3.5). All quantities are in units of the well.
"""

from __future__ import annotations

import functools
from types import ModuleType
from typing import NamedTuple

import numpy as np

from engine.exits.brake_orbits import Axes, saddle_axes
from engine.exits.continuation import StepLimits, follow
from engine.integrator.kernels.dense_output import advance_states, sample_path, trace_pieces, trace_steps, transition_matrices
from engine.systems.landscape.closed_energy import ridge_bend
from engine.systems.potential import Potential

# Number of nodes: states of one period that are corrected together.
_NODES = 8
# Number of points of the path between two nodes.
_POINTS_PER_NODE = 25
_MOST_CORRECTIONS = 12
# Relative size below which corrections that no longer decrease are rounding errors.
_CORRECTION_TOLERANCE = 1e-6
# Near the saddle, the tolerance is instead the rounding error of the energy, divided by σ², times this number.
_ENERGY_ROUNDINGS = 64
# Largest relative change of a prediction by its corrections; a larger change can be a jump to another orbit.
_LARGEST_CHANGE = 0.1
# Number of orbits from which the next one is predicted.
_PREDICTOR_ORBITS = 4
# Smallest step of σ, in units of the final σ.
_SMALLEST_STEP = 2.0**-10
# Largest number of steps of σ.
_MOST_STEPS = 400
# Largest number of integrator steps in a part of an orbit; an orbit with more steps passes close to a centre of attraction.
_MOST_STEPS_PER_PART = 400
# Sharpness of the smooth maximum that defines the edge of an orbit, see `_edge`.
_SHARPNESS = 50.0
# Largest change of the matrix of a step by computing it in two halves, relative to its largest element, and most halvings.
_TANGENT_ERROR, _MOST_HALVINGS = 1e-11, 12
# Largest distance between the ends of neighbouring parts of an orbit, in units of the well.
_LARGEST_GAP = 1e-10

# The values of σ reached last, each with the unknowns of its orbit, see `_correct`.
_KnownOrbits = list[tuple[float, np.ndarray]]


class PeriodicOrbit(NamedTuple):
    """One period of an orbit over a saddle, starting at the turning point with the smallest q in the axes of the saddle.

    Attributes
    ----------
    period
        Period of the orbit, dimensionless.
    path
        (4, 201) x, y, ẋ, ẏ, evenly spaced in time; the last point is the first one.
    edge
        Value of u − a q² on the parabola just outside the orbit, dimensionless; u and q are in the axes of the saddle, and a is
        its `ridge_bend`.
    """

    period: float
    path: np.ndarray
    edge: float


class _Family(NamedTuple):
    """The orbits over one saddle: the potential, the saddle as a state at rest (4,), its energy, its axes and `ridge_bend`."""

    potential: Potential
    saddle_state: np.ndarray
    saddle_energy: float
    axes: Axes
    bend: float


class _Parts(NamedTuple):
    """The parts of a trial orbit between its nodes.

    For each part, `steps` are its integrator steps, (m, 5), `ends` is the state at its end, (nodes, 4), and `matrices` is its
    transition matrix, (nodes, 4, 4).
    """

    steps: list[np.ndarray]
    ends: np.ndarray
    matrices: np.ndarray


def find_orbit_in_rotating_frame(potential: Potential, energy: float, channel: int) -> PeriodicOrbit | None:
    """Return the orbit over a saddle at an energy above it, followed from the small oscillations; None if it is not found.

    In a frame at rest, the result is the orbit that `brake_orbits` finds, up to rounding errors. Exits in such a frame are made
    from the orbits of `brake_orbits`, because their ends are exactly at rest. Orbits over several saddles are not found, because
    they do not begin as small oscillations.

    Parameters
    ----------
    potential
        The potential in units of its well. The frame may be at rest, which tests use for comparison.
    energy
        h, above the energy of the saddle, dimensionless.
    channel
        Number of the saddle, from 1.
    """
    saddle = potential.saddles[channel - 1]
    saddle_energy = float(potential.well.saddle_energies[channel - 1])
    axes = saddle_axes(potential, channel)
    family = _Family(potential, np.array([*saddle, 0.0, 0.0]), saddle_energy, axes, ridge_bend(potential.form, *axes))
    # Trial orbits that diverge are rejected later.
    with np.errstate(all="ignore"):
        unknowns = _continue_to(family, float(np.sqrt(energy - saddle_energy)))
        return None if unknowns is None else _complete_orbit(family, energy, unknowns)


def floquet_multipliers(matrix: np.ndarray) -> np.ndarray:
    """Return the complex eigenvalues of a monodromy matrix, of shape (4,), in order of decreasing modulus."""
    eigenvalues = np.linalg.eigvals(matrix).astype(complex)
    return eigenvalues[np.argsort(-np.abs(eigenvalues), kind="stable")]


def monodromy_matrix(potential: Potential, start: np.ndarray, period: float) -> np.ndarray:
    """Return the monodromy matrix, (4, 4), of an orbit that begins at a state (4,), in units of the well."""
    kernels = potential.well.kernels
    steps = trace_steps(kernels, start, period, len(potential.outcomes))
    states, durations = _shortened_steps(kernels, steps[:, :4], np.diff(steps[:, 4], append=period))
    matrix = np.eye(4)
    for state, duration in zip(states, durations, strict=True):
        # `tangent` changes the rows of the matrix in place: its columns are four deviation vectors along the same orbit.
        kernels.tangent(4, np.full(4, duration), *np.repeat(state, 4).reshape(4, 4), *matrix)
    return matrix


def monodromy_of_brake_orbit(potential: Potential, start: np.ndarray, period: float) -> np.ndarray:
    """Return the monodromy matrix, (4, 4), of an orbit that begins at rest in a frame at rest, in units of the well.

    The orbit is at rest again after half a period, and returns on the same path. Errors thus grow over half a period only.
    """
    half = monodromy_matrix(potential, start, 0.5 * period)
    (a, b), (c, d) = (np.hsplit(rows, 2) for rows in np.vsplit(half, 2))
    # The matrix of the way back: that of the symplectic inverse, with reversed momenta before and after.
    way_back = np.block([[d.T, b.T], [c.T, a.T]])
    return way_back @ half


def _shortened_steps(kernels: ModuleType, states: np.ndarray, durations: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the starts (n, 4) and sizes (n,) of steps, halved until the series of deviations from the orbit is accurate.

    The steps follow from the series of the orbit. On an orbit along a line of symmetry, these lack what acts across the line.
    """
    for _ in range(_MOST_HALVINGS):
        halves = 0.5 * durations
        middles = advance_states(kernels, states, halves)
        whole, first, second = (
            np.moveaxis(transition_matrices(kernels, begin.T, size), -1, 0)
            for begin, size in ((states, durations), (states, halves), (middles, halves))
        )
        product = second @ first
        error = np.abs(product - whole).max(axis=(1, 2)) / np.abs(product).max(axis=(1, 2))
        # Halving does not help a step that is not finite: its error, NaN, is not above the limit.
        is_rough = error > _TANGENT_ERROR
        if not is_rough.any():
            break
        sizes = np.where(is_rough, halves, durations)
        after = np.flatnonzero(is_rough) + 1
        states, durations = np.insert(states, after, middles[is_rough], axis=0), np.insert(sizes, after, halves[is_rough])
    return states, durations


def _continue_to(family: _Family, sigma: float) -> np.ndarray | None:
    """Return the unknowns of the orbit at σ, see `_correct`, followed from σ = 0 with an adaptive step; None if this fails."""

    def advance(known: _KnownOrbits, target: float) -> _KnownOrbits | None:
        corrected = _correct(family, target, _extrapolate(known, target))
        return None if corrected is None else [*known, (target, corrected)][-_PREDICTOR_ORBITS:]

    limits = StepLimits(sigma, _SMALLEST_STEP * sigma, _MOST_STEPS)
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
    angles = 2.0 * np.pi * np.arange(_NODES) / _NODES
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
    states = family.saddle_state + sigma * unknowns[:-1].reshape(_NODES, 4)
    parts = _trace(family.potential, states, unknowns[-1])
    if parts is None:
        return None
    jacobian, residual = np.zeros((4 * _NODES + 2, unknowns.size)), np.empty(4 * _NODES + 2)
    residual[:-2] = ((parts.ends - np.roll(states, -1, axis=0)) / sigma).ravel()
    jacobian[:-2, -1] = (_velocities(family.potential, parts.ends) / (_NODES * sigma)).ravel()
    for k in range(_NODES):
        node, next_node = slice(4 * k, 4 * k + 4), slice(4 * ((k + 1) % _NODES), 4 * ((k + 1) % _NODES) + 4)
        jacobian[node, node] += parts.matrices[k]
        jacobian[node, next_node] -= np.eye(4)
    start, outward = states[0], family.axes.outward
    residual[-2] = (family.potential.energy(start) - family.saddle_energy) / sigma**2 - 1.0
    jacobian[-2, :4] = np.array([*family.potential.gradient(start[0], start[1]), start[2], start[3]]) / sigma
    jacobian[-1, 2:4] = -outward[1], outward[0]
    residual[-1] = jacobian[-1, :4] @ unknowns[:4]
    return (jacobian, residual) if np.isfinite(residual).all() and np.isfinite(jacobian).all() else None


def _velocities(potential: Potential, states: np.ndarray) -> np.ndarray:
    """Return the time derivatives of n states, of shape (n, 4)."""
    x, y, vx, vy = states.T
    slope_x, slope_y = potential.gradient(x, y)
    coriolis = 2.0 * potential.rotation
    return np.column_stack([vx, vy, coriolis * vy - slope_x, -coriolis * vx - slope_y])


def _trace(potential: Potential, states: np.ndarray, period: float) -> _Parts | None:
    """Return the parts of an orbit of some period that start at its nodes (nodes, 4); None if they cannot be integrated."""
    if not (np.isfinite(states).all() and 0.0 < period < np.inf):
        return None
    kernels, duration = potential.well.kernels, period / _NODES
    # The first piece of a part is the whole part, or has more than `_MOST_STEPS_PER_PART` steps.
    steps = [next(trace_pieces(kernels, state, duration, len(potential.outcomes)))[0] for state in states]
    if max(map(len, steps)) > _MOST_STEPS_PER_PART:
        return None
    stops = np.cumsum([len(part_steps) for part_steps in steps])
    durations = np.concatenate([np.diff(part_steps[:, 4], append=duration) for part_steps in steps])
    step_states = np.concatenate(steps)[:, :4]
    if not np.isfinite(step_states).all():
        return None
    matrices = np.moveaxis(transition_matrices(kernels, step_states.T, durations), -1, 0)
    products = [_product(part_matrices) for part_matrices in np.split(matrices, stops[:-1])]
    ends = advance_states(kernels, step_states[stops - 1], durations[stops - 1])
    return _Parts(steps, ends, np.array(products))


def _product(matrices: np.ndarray) -> np.ndarray:
    """Return the product of n transition matrices, of shape (4, 4), with the first matrix applied first."""
    return functools.reduce(lambda earlier, matrix: matrix @ earlier, matrices)


def _complete_orbit(family: _Family, energy: float, unknowns: np.ndarray) -> PeriodicOrbit | None:
    """Return the orbit with its path and edge; None if its parts do not join within `_LARGEST_GAP`."""
    sigma, period = float(np.sqrt(energy - family.saddle_energy)), float(unknowns[-1])
    states = family.saddle_state + sigma * unknowns[:-1].reshape(_NODES, 4)
    parts = _trace(family.potential, states, period)
    # `not … <` also rejects NaN.
    if parts is None or not np.abs(parts.ends - np.roll(states, -1, axis=0)).max() < _LARGEST_GAP:
        return None
    kernels, duration = family.potential.well.kernels, period / _NODES
    times = np.arange(_POINTS_PER_NODE) * (duration / _POINTS_PER_NODE)
    pieces = [sample_path(kernels, steps, times) for steps in parts.steps]
    path = np.concatenate([*pieces, states[:1].T], axis=1)
    return PeriodicOrbit(period, path, _edge(family, path))


def _edge(family: _Family, path: np.ndarray) -> float:
    """Return a little more than the largest u − a q² on the path (4, points) of an orbit, with a of `ridge_bend`.

    The largest value itself is not a smooth function of the energy where the point with this value jumps.
    """
    u, q = family.axes.coordinates(path[:2, :-1])
    offset = u - family.bend * q * q
    spread = float(offset.std())
    relative = (offset - offset.mean()) / spread
    return float(offset.mean()) + spread / _SHARPNESS * float(np.log(np.exp(_SHARPNESS * relative).sum()))
