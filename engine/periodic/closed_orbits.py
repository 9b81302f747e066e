"""Numbers of a closed orbit: its stability index, its action and the number of its returns, in units of the well."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.exits.saddle_orbits.orbit_parts import matrix_product, monodromy_matrix, trace_parts
from engine.integrator.kernels.dense_output import sample_path, trace_steps
from engine.periodic.shooting import Trial
from engine.periodic.symmetries import Symmetry
from engine.propagation.passages import find_passages_of_orbit
from engine.slices.sections.section import Section
from engine.systems.potential import Potential

SAME_POINT = 1e-7
"""Distance within which two returns are the same point, in units of the well."""

# Largest number of passages in a part of an orbit, and time within which two passages are the same.
_MOST_PASSAGES, _SAME_TIME = 1000, 1e-6
# Points of Gauss's quadrature in a step of the integrator, whose path is a polynomial.
_GAUSS_POINTS = 20


def transition_matrix(potential: Potential, orbit: Trial) -> np.ndarray:
    """Return the monodromy matrix of a closed orbit, (4, 4), as the product of the matrices of its parts."""
    parts = zip(orbit.states, orbit.part_durations.tolist(), strict=True)
    return matrix_product(np.array([monodromy_matrix(potential, state, duration) for state, duration in parts]))


def stability_index(potential: Potential, orbit: Trial) -> float:
    """Return a = ½ (tr M − 2) of a closed orbit with monodromy matrix M (Hénon 1965, Ann. Astrophys. 28, 992).

    Eigenvalues of M would have errors of the root of rounding, because 1 is a double eigenvalue.
    """
    return 0.5 * (float(np.trace(transition_matrix(potential, orbit))) - 2.0)


def half_symmetry(potential: Potential, orbit: Trial, symmetries: Sequence[Symmetry]) -> Symmetry | None:
    """Return the reflection, of some symmetries, that maps a closed orbit onto itself half a period later; None without one."""
    state, _ = _first_half(potential, orbit)
    for symmetry in symmetries:
        if not symmetry.reverses_time and np.abs(symmetry.factors * state - orbit.states[0]).max() < SAME_POINT:
            return symmetry
    return None


def half_index(potential: Potential, orbit: Trial, symmetry: Symmetry) -> float:
    """Return b = ½ (tr S M − 2), with the matrix M of half a period and S of its `half_symmetry`; a = 2b² − 1.

    Where b changes its sign, a touches −1. There the sign of a + 1 does not change.
    """
    _, matrix = _first_half(potential, orbit)
    return 0.5 * (float(np.sum(symmetry.factors * np.diagonal(matrix))) - 2.0)


def _first_half(potential: Potential, orbit: Trial) -> tuple[np.ndarray, np.ndarray]:
    """Return the state of an orbit after half its period, (4,), and the transition matrix of this half, (4, 4)."""
    remaining, matrix = 0.5 * float(orbit.durations.sum()), np.eye(4)
    for state, duration in zip(orbit.states, orbit.part_durations.tolist(), strict=True):
        if duration >= remaining:
            break
        matrix, remaining = monodromy_matrix(potential, state, duration) @ matrix, remaining - duration
    steps = trace_steps(potential.well.kernels, state, remaining, len(potential.outcomes))
    end = sample_path(potential.well.kernels, steps, np.array([remaining]))[:, 0]
    return end, monodromy_matrix(potential, state, remaining) @ matrix


def action(potential: Potential, orbit: Trial) -> float:
    """Return the integral of the canonical momentum along a closed orbit, whose derivative by the energy is the period.

    In a frame that rotates at the rate Ω, the canonical momentum is (px − Ω y, py + Ω x). NaN if the orbit cannot be integrated.
    """
    parts = trace_parts(potential, orbit.states, orbit.part_durations)
    if parts is None:
        return np.nan
    nodes, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    total = 0.0
    for steps, duration in zip(parts.steps, orbit.part_durations, strict=True):
        sizes = np.diff(steps[:, 4], append=duration)
        times = steps[:, 4, None] + 0.5 * (nodes + 1.0) * sizes[:, None]
        x, y, vx, vy = sample_path(potential.well.kernels, steps, times.ravel()).reshape(4, *times.shape)
        integrand = vx * vx + vy * vy + potential.rotation * (x * vy - y * vx)
        total += float(np.sum(0.5 * sizes[:, None] * weights * integrand))
    return total


def primitive_returns(orbit: Trial) -> int:
    """Return the number of returns after which a closed orbit repeats itself."""
    states = orbit.states[orbit.returns]
    n = len(states)
    return next(m for m in range(1, n + 1) if n % m == 0 and np.abs(states - np.roll(states, -m, axis=0)).max() < SAME_POINT)


def with_all_returns(potential: Potential, section: Section, orbit: Trial) -> Trial:
    """Return a closed orbit with all its returns to a section, in units of the well; it is unchanged if none is missing."""
    durations = orbit.part_durations
    begins = np.cumsum(durations) - durations
    known, period = begins[orbit.returns], float(durations.sum())
    passages = []
    for state, begin, duration in zip(orbit.states, begins, durations.tolist(), strict=True):
        found = find_passages_of_orbit(potential, state, _MOST_PASSAGES, duration, section.numbers)
        passages.append(np.column_stack([found[:, :4], begin + found[:, 4]]))
    points = np.concatenate(passages)
    # A return at a node can be found at the end of a part.
    distances = np.abs((points[:, 4, None] - known + 0.5 * period) % period - 0.5 * period)
    further = points[distances.min(axis=1) > _SAME_TIME]
    if not len(further):
        return orbit
    everything = np.vstack([np.column_stack([orbit.states[orbit.returns], known]), further])
    everything = everything[np.argsort(everything[:, 4])]
    times = everything[:, 4]
    return Trial(everything[:, :4], np.diff(times, append=times[0] + period), orbit.value, (1,) * len(times))


def sampled_path(potential: Potential, orbit: Trial, points: int) -> np.ndarray:
    """Return a closed orbit at about this number of times, evenly spaced within each part, as rows t, x, y, px, py."""
    parts = trace_parts(potential, orbit.states, orbit.part_durations)
    if parts is None:
        return np.empty((5, 0))
    durations = orbit.part_durations
    begins = np.cumsum(durations) - durations
    counts = np.maximum(np.ceil(points * durations / durations.sum()), 2).astype(int)
    pieces = []
    for steps, begin, duration, count in zip(parts.steps, begins, durations, counts, strict=True):
        times = np.arange(count) * (duration / count)
        pieces.append(np.vstack([begin + times, sample_path(potential.well.kernels, steps, times)]))
    last = np.append(durations.sum(), orbit.states[0])
    return np.column_stack([*pieces, last])
