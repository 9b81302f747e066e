"""Properties of the orbits of every potential."""

from __future__ import annotations

import numpy as np

from engine import classify_orbits
from engine.systems.potential import Potential
from tests.contracts.potentials import each_compiled
from tests.peers import taylor_heyoka
from tests.peers.exit_lines import exit_lines

ENERGY_FACTOR = 1.15


def energy_of(potential: Potential, factor: float) -> float:
    bottom = float(potential.value(0.0, 0.0))
    return bottom + factor * (potential.escape_energy - bottom)


def starts(potential: Potential, energy: float, count: int, seed: int = 0) -> np.ndarray:
    """Return states of one energy near the minimum of the well, with random directions, of shape (count, 4)."""
    rng = np.random.default_rng(seed)
    place = 0.3 * potential.units.length * rng.uniform(-1.0, 1.0, (20 * count, 2))
    place = place[potential.value(*place.T) < energy][:count]
    speed = np.sqrt(2.0 * (energy - potential.value(*place.T)))
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.column_stack([place, speed * np.cos(angle), speed * np.sin(angle)])


def starts_on_axis(potential: Potential, energy: float, count: int) -> np.ndarray:
    """Return states with y = px = 0, of shape (count, 4)."""
    x = 0.3 * potential.units.length * np.linspace(-1.0, 1.0, count)
    zero = np.zeros(count)
    return np.column_stack([x, zero, zero, np.sqrt(2.0 * (energy - potential.value(x, zero)))])


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
