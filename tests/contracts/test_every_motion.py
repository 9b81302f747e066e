"""Fates, escape times and crossings of random orbits in every potential agree with heyoka.

An orbit is robust if the channel and the crossings by heyoka do not change after a shift of the start by 1e-11. It is steady if
its escape time also changes by less than 1e-7. Other orbits are too chaotic to be compared.
"""

from __future__ import annotations

import numpy as np

from engine import Plane, Potential, classify_orbits, start_states
from engine.slices.default_window import default_window
from tests.contracts.potentials import each_compiled
from tests.peers import taylor_heyoka
from tests.peers.exit_lines import exit_lines

# Energy above the bottom in units of the depth of the well, end time, number of starts, and shift of starts.
ENERGY_FACTOR, T_MAX, STARTS, SHIFT = 1.4, 60.0, 20, 1e-11


def interior_starts(potential: Potential, energy: float, plane: Plane) -> np.ndarray:
    """Return random interior starts, selected with the independent description of the exits in `exit_lines`."""
    rng, window = np.random.default_rng(potential.channels), default_window(potential, plane, energy)
    x = rng.uniform(window.x_low, window.x_high, 400)
    ordinate = rng.uniform(window.ordinate_low, window.ordinate_high, 400)
    states = start_states(potential, plane, energy, x, ordinate)
    states = states[np.isfinite(states).all(axis=1)]
    past = [line.past(states[:, 0], states[:, 1]) > 0 for line in exit_lines(potential, energy)]
    return states[~np.any(past, axis=0)][:STARTS]


@each_compiled
def test_outcomes_of_robust_orbits_agree_with_heyoka(potential: Potential) -> None:
    energy, t_max = potential.well.energy_at(ENERGY_FACTOR), T_MAX * potential.units.time
    lines = exit_lines(potential, energy)
    states = np.concatenate([interior_starts(potential, energy, plane) for plane in (Plane.X_Y, Plane.X_PX)])
    shift = np.array([SHIFT * potential.units.length, 0.0, 0.0, 0.0])
    ours = classify_orbits(potential, energy, states, t_max)
    theirs, shifted = (taylor_heyoka.classify(potential, lines, each, t_max) for each in (states, states + shift))
    robust = (shifted.fate == theirs.fate) & (shifted.crossings == theirs.crossings)
    assert robust.mean() > 0.9
    np.testing.assert_array_equal(ours.fate[robust], theirs.fate[robust])
    np.testing.assert_array_equal(ours.crossings[robust], theirs.crossings[robust])
    steady = robust & (np.abs(shifted.escape_time - theirs.escape_time) < 1e-7 * potential.units.time)
    np.testing.assert_allclose(ours.escape_time[steady], theirs.escape_time[steady], rtol=0, atol=1e-6 * potential.units.time)
    assert steady.any()
