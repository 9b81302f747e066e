"""What every potential keeps to in motion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import classify_orbits, find_lyapunov_orbits
from engine.potentials.potential import Potential
from engine.potentials.symmetry import count_rotations
from tests.contracts.potentials import each_compiled
from tests.peers import taylor_heyoka
from tests.peers.dop853 import equations, variational_equations
from tests.peers.exit_lines import exit_lines

ABOVE = 1.15


def energy_of(potential: Potential, factor: float) -> float:
    bottom = float(potential.value(0.0, 0.0))
    return bottom + factor * (potential.escape_energy - bottom)


def starts(potential: Potential, energy: float, count: int, seed: int = 0) -> np.ndarray:
    """(count, 4) states of one energy near the bottom of the well, in random directions."""
    rng = np.random.default_rng(seed)
    place = 0.3 * potential.length * rng.uniform(-1.0, 1.0, (20 * count, 2))
    place = place[potential.value(*place.T) < energy][:count]
    speed = np.sqrt(2.0 * (energy - potential.value(*place.T)))
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.column_stack([place, speed * np.cos(angle), speed * np.sin(angle)])


@each_compiled
def test_energy_is_conserved_over_a_hundred_units_of_time(potential: Potential) -> None:
    energy = energy_of(potential, 0.9)
    outcome = classify_orbits(potential, energy, starts(potential, energy, 8), t_max=100.0)
    assert np.all(outcome.fate == 0)
    assert outcome.energy_error.max() < 1e-11


@each_compiled
def test_lyapunov_orbits_close_and_are_unstable(potential: Potential) -> None:
    energy = energy_of(potential, ABOVE)
    orbits = find_lyapunov_orbits(potential, energy)
    assert [orbit.channel for orbit in orbits] == list(potential.open_channels(energy))
    for orbit in orbits[:3]:
        start = np.array([orbit.x[0], orbit.y[0], 0.0, 0.0])
        half = solve_ivp(equations(potential), (0.0, 0.5 * orbit.period), start, "DOP853", rtol=1e-13, atol=1e-15)
        arrival = [orbit.x[100], orbit.y[100], 0.0, 0.0]
        np.testing.assert_allclose(half.y[:, -1], arrival, rtol=0.0, atol=1e-9 * potential.length)
        assert abs(trace_of_monodromy(potential, start, orbit.period)) > 2.0


def trace_of_monodromy(potential: Potential, start: np.ndarray, period: float) -> float:
    """4 for a stable or an integrable orbit's Jordan block at most; beyond, neighbours move away exponentially."""
    trace = 0.0
    for pair in (np.eye(4)[:2], np.eye(4)[2:]):
        flow = solve_ivp(
            variational_equations(potential), (0.0, period), [*start, *pair.ravel()], "DOP853", rtol=1e-10, atol=1e-12
        )
        vectors = flow.y[4:, -1].reshape(2, 4)
        columns = np.flatnonzero(pair.sum(axis=0))
        trace += sum(vectors[row, column] for row, column in enumerate(columns))
    return float(trace) - 2.0


@each_compiled
def test_turned_starts_leave_by_turned_channels(potential: Potential) -> None:
    turns = count_rotations(potential)
    if turns < 2:
        pytest.skip("no rotation")
    energy, angle = energy_of(potential, ABOVE), 2.0 * np.pi / turns
    states = starts(potential, energy, 200)
    cos, sin = np.cos(angle), np.sin(angle)
    rotation = np.array([[cos, -sin], [sin, cos]])
    turned = np.column_stack([states[:, :2] @ rotation.T, states[:, 2:] @ rotation.T])
    here, there = (classify_orbits(potential, energy, s, t_max=15.0) for s in (states, turned))
    # Rounding grows too little in so short a time to change any but an orbit on the very boundary.
    step = potential.channels // turns
    expected = np.where(here.fate > 0, (here.fate - 1 + step) % potential.channels + 1, here.fate)
    assert np.mean(there.fate != expected) < 0.02
    assert np.mean(here.fate > 0) > 0.05


@each_compiled
def test_heyoka_says_the_same_of_random_starts(potential: Potential) -> None:
    energy = energy_of(potential, ABOVE)
    states = starts(potential, energy, 12, seed=5)
    ours = classify_orbits(potential, energy, states, t_max=12.0)
    theirs = taylor_heyoka.classify(potential, exit_lines(potential, energy), states, 12.0, 1e-15)
    np.testing.assert_array_equal(ours.fate, theirs.fate)
    np.testing.assert_array_equal(ours.crossings, theirs.crossings)
    np.testing.assert_allclose(ours.escape_time, theirs.escape_time, rtol=0.0, atol=1e-8)
