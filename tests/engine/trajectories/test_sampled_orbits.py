"""Orbits sampled at chosen times have the states of single orbits and the outcomes of batches."""

from __future__ import annotations

import numpy as np
import pytest

from engine import (
    CASES,
    Fate,
    classify_orbits,
    integrate_orbit,
    sample_orbits,
    sample_starts,
)

ENERGIES = {"I": 0.2, "III": 0.36}
TIMES = np.linspace(0.0, 30.0, 61)


def starts_of(case: str, count: int = 40) -> np.ndarray:
    return sample_starts(CASES[case], ENERGIES[case], count, rng=3)


@pytest.mark.parametrize("case", ENERGIES)
def test_outcomes_are_those_of_a_batch(case: str) -> None:
    orbits = sample_orbits(CASES[case], starts_of(case), TIMES)
    outcomes = classify_orbits(CASES[case], ENERGIES[case], starts_of(case), 30.0)
    np.testing.assert_array_equal(orbits.fate, outcomes.fate)
    np.testing.assert_allclose(orbits.escape_time, outcomes.escape_time, rtol=1e-13)
    np.testing.assert_array_equal(orbits.crossings, outcomes.crossings)


@pytest.mark.parametrize("case", ENERGIES)
def test_states_are_those_of_single_orbits(case: str) -> None:
    states = starts_of(case, 8)
    orbits = sample_orbits(CASES[case], states, TIMES)
    for place, state in enumerate(states):
        one = integrate_orbit(CASES[case], state, 30.0)
        known = one.t[-1] >= TIMES
        # Sample the orbit at the times of the single orbit.
        again = sample_orbits(CASES[case], state[None], one.t[None])
        np.testing.assert_allclose(again.x[0], one.x, rtol=0, atol=1e-12)
        np.testing.assert_allclose(again.py[0], one.py, rtol=0, atol=1e-12)
        np.testing.assert_array_equal(np.isfinite(orbits.y[place]), known)


def test_each_orbit_has_its_own_times() -> None:
    states = starts_of("I", 3)
    own = np.array([[0.0, 1.0, 2.0], [0.5, 0.5, 0.75], [0.0, 0.1, 40.0]])
    orbits = sample_orbits(CASES["I"], states, own)
    for place in range(3):
        alone = sample_orbits(CASES["I"], states[place : place + 1], own[place])
        np.testing.assert_array_equal(orbits.px[place], alone.px[0])
    np.testing.assert_array_equal(orbits.t, own)


def test_a_start_outside_has_no_path() -> None:
    outside = np.array([[0.0, 3.0, 0.0, 0.1], [0.1, 0.0, 0.0, 0.1]])
    orbits = sample_orbits(CASES["I"], outside, [0.0, 1.0])
    assert orbits.fate[0] == Fate.OUTSIDE
    assert np.isfinite(orbits.x).tolist() == [[True, False], [True, True]]
    assert orbits.y[0, 0] == 3.0
