"""Fates, escape times and crossings of random orbits compared with heyoka.

An orbit is robust if the channel and the crossings by heyoka do not change after a shift of the start by 1e-11. It is steady if
its escape time also changes by less than 1e-7. Other orbits are too chaotic to be compared.
"""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, classify_orbits, start_states
from engine.slices.default_window import default_window
from tests.peers import taylor_heyoka
from tests.peers.exit_lines import exit_lines

T_MAX = 60.0
STARTS = 20
SHIFT = np.array([1e-11, 0.0, 0.0, 0.0])
SETS = [("I", 0.13), ("II", 0.5), ("III", 0.35)]


def interior_starts(name: str, energy: float, plane: Plane) -> np.ndarray:
    """Return random interior starts, selected with the independent description of the exits in `exit_lines`."""
    potential, rng = CASES[name], np.random.default_rng(int(1000 * energy))
    window = default_window(potential, plane, energy)
    x = rng.uniform(window.x_low, window.x_high, 400)
    ordinate = rng.uniform(window.ordinate_low, window.ordinate_high, 400)
    states = start_states(potential, plane, energy, x, ordinate)
    states = states[np.isfinite(states).all(axis=1)]
    past = [line.past(states[:, 0], states[:, 1]) > 0 for line in exit_lines(potential, energy)]
    return states[~np.any(past, axis=0)][:STARTS]


@pytest.mark.parametrize(("name", "energy"), SETS)
def test_outcomes_of_robust_orbits_agree_with_heyoka(name: str, energy: float) -> None:
    potential, lines = CASES[name], exit_lines(CASES[name], energy)
    states = np.concatenate([interior_starts(name, energy, plane) for plane in (Plane.X_Y, Plane.X_PX)])
    ours = classify_orbits(potential, energy, states, T_MAX)
    theirs, shifted = (taylor_heyoka.classify(potential, lines, each, T_MAX) for each in (states, states + SHIFT))
    robust = (shifted.fate == theirs.fate) & (shifted.crossings == theirs.crossings)
    assert robust.mean() > 0.9
    np.testing.assert_array_equal(ours.fate[robust], theirs.fate[robust])
    np.testing.assert_array_equal(ours.crossings[robust], theirs.crossings[robust])
    steady = robust & (np.abs(shifted.escape_time - theirs.escape_time) < 1e-7)
    np.testing.assert_allclose(ours.escape_time[steady], theirs.escape_time[steady], rtol=0, atol=1e-6)
    assert steady.any()
