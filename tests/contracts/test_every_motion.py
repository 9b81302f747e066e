"""Properties of the orbits of every potential."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import classify_orbits, find_lyapunov_orbits
from engine.potentials.potential import Potential
from tests.contracts.potentials import each_compiled
from tests.peers import taylor_heyoka
from tests.peers.dop853 import equations, variational_equations
from tests.peers.exit_lines import exit_lines

ENERGY_FACTOR = 1.15


def energy_of(potential: Potential, factor: float) -> float:
    bottom = float(potential.value(0.0, 0.0))
    return bottom + factor * (potential.escape_energy - bottom)


def starts(potential: Potential, energy: float, count: int, seed: int = 0) -> np.ndarray:
    """(count, 4) states of one energy near the minimum of the well, with random directions."""
    rng = np.random.default_rng(seed)
    place = 0.3 * potential.units.length * rng.uniform(-1.0, 1.0, (20 * count, 2))
    place = place[potential.value(*place.T) < energy][:count]
    speed = np.sqrt(2.0 * (energy - potential.value(*place.T)))
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.column_stack([place, speed * np.cos(angle), speed * np.sin(angle)])


def starts_on_axis(potential: Potential, energy: float, count: int) -> np.ndarray:
    """(count, 4) states with y = px = 0."""
    x = 0.3 * potential.units.length * np.linspace(-1.0, 1.0, count)
    zero = np.zeros(count)
    return np.column_stack([x, zero, zero, np.sqrt(2.0 * (energy - potential.value(x, zero)))])


@each_compiled
def test_energy_is_conserved(potential: Potential) -> None:
    energy = energy_of(potential, 0.9)
    outcome = classify_orbits(potential, energy, starts(potential, energy, 8), t_max=100.0)
    assert np.all(outcome.fate == 0)
    assert outcome.energy_error.max() < 1e-11


@each_compiled
def test_lyapunov_orbits_are_periodic_and_unstable(potential: Potential) -> None:
    energy = energy_of(potential, ENERGY_FACTOR)
    orbits = find_lyapunov_orbits(potential, energy)
    assert [orbit.channel for orbit in orbits] == list(potential.well.open_channels(energy))
    for orbit in orbits[:3]:
        start = np.array([orbit.x[0], orbit.y[0], 0.0, 0.0])
        half = solve_ivp(equations(potential), (0.0, 0.5 * orbit.period), start, "DOP853", rtol=1e-13, atol=1e-15)
        arrival = [orbit.x[100], orbit.y[100], 0.0, 0.0]
        np.testing.assert_allclose(half.y[:, -1], arrival, rtol=0.0, atol=1e-9 * potential.units.length)
        assert abs(trace_of_monodromy(potential, start, orbit.period)) > 2.0


def trace_of_monodromy(potential: Potential, start: np.ndarray, period: float) -> float:
    """The trace of the monodromy matrix without its two unit eigenvalues; the orbit is unstable if its magnitude is above 2."""
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
def test_rotated_starts_escape_through_rotated_channels(potential: Potential) -> None:
    rotations = potential.form.count_rotations()
    if rotations < 2:
        pytest.skip("no rotation")
    energy, angle = energy_of(potential, ENERGY_FACTOR), 2.0 * np.pi / rotations
    states = starts(potential, energy, 200)
    cos, sin = np.cos(angle), np.sin(angle)
    rotation = np.array([[cos, -sin], [sin, cos]])
    rotated = np.column_stack([states[:, :2] @ rotation.T, states[:, 2:] @ rotation.T])
    original, image = (classify_orbits(potential, energy, s, t_max=15.0) for s in (states, rotated))
    # In so short a time rounding errors only change orbits at a basin boundary.
    step = potential.channels // rotations
    expected = np.where(original.fate > 0, (original.fate - 1 + step) % potential.channels + 1, original.fate)
    assert np.mean(image.fate != expected) < 0.02
    assert np.mean(original.fate > 0) > 0.05


@each_compiled
def test_outcomes_agree_with_heyoka(potential: Potential) -> None:
    energy = energy_of(potential, ENERGY_FACTOR)
    states = starts(potential, energy, 12, seed=5)
    states[-4:] = starts_on_axis(potential, energy, 4)
    ours = classify_orbits(potential, energy, states, t_max=12.0)
    theirs = taylor_heyoka.classify(potential, exit_lines(potential, energy), states, 12.0, 1e-15)
    np.testing.assert_array_equal(ours.fate, theirs.fate)
    np.testing.assert_array_equal(ours.crossings, theirs.crossings)
    np.testing.assert_allclose(ours.escape_time, theirs.escape_time, rtol=0.0, atol=1e-8)
