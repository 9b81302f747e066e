"""Halves and returns of a closed orbit, in units of the well."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.exits.closed_orbit import Nodes
from engine.exits.saddle_orbits.orbit_parts import monodromy_matrix
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


def primitive_returns(orbit: Trial) -> int:
    """Return the number of returns after which a closed orbit repeats itself."""
    states = orbit.states[orbit.returns]
    n = len(states)
    return next(m for m in range(1, n + 1) if n % m == 0 and np.abs(states - np.roll(states, -m, axis=0)).max() < SAME_POINT)


def passages_of(potential: Potential, section: Section, orbit: Nodes) -> np.ndarray:
    """Return the crossings of a section by a closed orbit, in units of the well, as rows x, y, px, py, t of shape (n, 5)."""
    begins = np.cumsum(orbit.durations) - orbit.durations
    passages = []
    for state, begin, duration in zip(orbit.states, begins, orbit.durations.tolist(), strict=True):
        found = find_passages_of_orbit(potential, state, _MOST_PASSAGES, duration, section.numbers)
        passages.append(np.column_stack([found[:, :4], begin + found[:, 4]]))
    return np.concatenate(passages)


def with_all_returns(potential: Potential, section: Section, orbit: Trial) -> Trial:
    """Return a closed orbit with all its returns to a section, in units of the well; it is unchanged if none is missing."""
    durations = orbit.part_durations
    known, period = (np.cumsum(durations) - durations)[orbit.returns], float(durations.sum())
    points = passages_of(potential, section, orbit.nodes)
    # A return at a node can be found at the end of a part.
    distances = np.abs((points[:, 4, None] - known + 0.5 * period) % period - 0.5 * period)
    further = points[distances.min(axis=1) > _SAME_TIME]
    if not len(further):
        return orbit
    everything = np.vstack([np.column_stack([orbit.states[orbit.returns], known]), further])
    return orbit_through(everything[np.argsort(everything[:, 4])], period, orbit.value)


def orbit_through(returns: np.ndarray, period: float, value: float) -> Trial:
    """Return the closed orbit with some returns, rows x, y, px, py, t of shape (n, 5), in the order of time."""
    times = returns[:, 4]
    return Trial(returns[:, :4], np.diff(times, append=times[0] + period), value, (1,) * len(times))
