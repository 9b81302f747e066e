"""Parts of an orbit between its nodes, with their transition matrices, for corrections of several states of a period at once."""

from __future__ import annotations

import functools
from types import ModuleType
from typing import NamedTuple

import numpy as np

from engine.integrator.kernels.dense_output import advance_states, trace_pieces, trace_steps, transition_matrices
from engine.systems.potential import Potential

# Largest number of integrator steps in a part of an orbit; an orbit with more steps passes close to a centre of attraction.
_MOST_STEPS_PER_PART = 400
# Largest change of the matrix of a step by computing it in two halves, relative to its largest element, and most halvings.
_TANGENT_ERROR, _MOST_HALVINGS = 1e-11, 12


class Parts(NamedTuple):
    """The parts of a trial orbit between its nodes.

    Attributes
    ----------
    steps
        The integrator steps of each part, of shape (m, 5).
    ends
        (nodes, 4) state at the end of each part.
    matrices
        (nodes, 4, 4) transition matrix of each part.
    """

    steps: list[np.ndarray]
    ends: np.ndarray
    matrices: np.ndarray

    def gaps(self, states: np.ndarray) -> np.ndarray:
        """Return, of shape (4 nodes,), the end of each part minus the state at the next node, for states (nodes, 4)."""
        return (self.ends - np.roll(states, -1, axis=0)).ravel()

    def changes_of_gaps(self) -> np.ndarray:
        """Return the derivatives of `gaps` by the states at the nodes, of shape (4 nodes, 4 nodes)."""
        nodes = len(self.ends)
        blocks = np.zeros((nodes, 4, nodes, 4))
        for k in range(nodes):
            blocks[k, :, k] += self.matrices[k]
            blocks[k, :, (k + 1) % nodes] -= np.eye(4)
        return blocks.reshape(4 * nodes, 4 * nodes)


def trace_parts(potential: Potential, states: np.ndarray, durations: np.ndarray) -> Parts | None:
    """Return the parts that start at states (nodes, 4) and take some times (nodes,); None if they cannot be integrated."""
    if not (np.isfinite(states).all() and np.all((durations > 0.0) & (durations < np.inf))):
        return None
    kernels, outcomes = potential.well.kernels, len(potential.outcomes)
    # The first piece of a part is the whole part, or has more than `_MOST_STEPS_PER_PART` steps.
    parts = list(zip(states, durations.tolist(), strict=True))
    steps = [next(trace_pieces(kernels, state, duration, outcomes))[0] for state, duration in parts]
    if max(map(len, steps)) > _MOST_STEPS_PER_PART:
        return None
    stops = np.cumsum([len(part_steps) for part_steps in steps])
    step_durations = np.concatenate(
        [np.diff(part_steps[:, 4], append=duration) for part_steps, (_, duration) in zip(steps, parts, strict=True)]
    )
    step_states = np.concatenate(steps)[:, :4]
    if not np.isfinite(step_states).all():
        return None
    matrices = np.moveaxis(transition_matrices(kernels, step_states.T, step_durations), -1, 0)
    products = [matrix_product(part_matrices) for part_matrices in np.split(matrices, stops[:-1])]
    ends = advance_states(kernels, step_states[stops - 1], step_durations[stops - 1])
    return Parts(steps, ends, np.array(products))


def matrix_product(matrices: np.ndarray) -> np.ndarray:
    """Return the product of n transition matrices, of shape (4, 4), with the first matrix applied first."""
    return functools.reduce(lambda earlier, matrix: matrix @ earlier, matrices)


def velocities(potential: Potential, states: np.ndarray) -> np.ndarray:
    """Return the time derivatives of n states, of shape (n, 4)."""
    x, y, vx, vy = states.T
    slope_x, slope_y = potential.gradient(x, y)
    coriolis = 2.0 * potential.rotation
    return np.column_stack([vx, vy, coriolis * vy - slope_x, -coriolis * vx - slope_y])


def monodromy_matrix(potential: Potential, start: np.ndarray, period: float) -> np.ndarray:
    """Return the monodromy matrix, (4, 4), of an orbit that begins at a state (4,), in units of the well."""
    return transition_matrices_of(potential, start[None], np.array([period]))[0]


def transition_matrices_of(potential: Potential, starts: np.ndarray, durations: np.ndarray) -> np.ndarray:
    """Return the transition matrices, (n, 4, 4), of orbits from n starts (n, 4) after times (n,), in units of the well."""
    kernels, outcomes = potential.well.kernels, len(potential.outcomes)
    steps = [trace_steps(kernels, start, end, outcomes) for start, end in zip(starts, durations.tolist(), strict=True)]
    sizes = [np.diff(each[:, 4], append=end) for each, end in zip(steps, durations.tolist(), strict=True)]
    states, step_durations = _shortened_steps(kernels, np.concatenate(steps)[:, :4], np.concatenate(sizes))
    matrices = np.moveaxis(transition_matrices(kernels, states.T, step_durations), -1, 0)
    # The steps of all orbits follow each other; halved steps end where the whole one did.
    middles = np.cumsum(step_durations) - 0.5 * step_durations
    stops = np.searchsorted(middles, np.cumsum(durations[:-1]))
    return np.array([matrix_product(part) for part in np.split(matrices, stops)])


def monodromy_of_brake_orbit(potential: Potential, start: np.ndarray, half_period: float) -> np.ndarray:
    """Return the monodromy matrix, (4, 4), of an orbit that begins at rest in a frame at rest, in units of the well.

    The orbit is at rest again after half a period, and returns on the same path. Errors thus grow over half a period only.
    """
    half = monodromy_matrix(potential, start, half_period)
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
