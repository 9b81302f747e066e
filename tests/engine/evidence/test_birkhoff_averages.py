"""Birkhoff averages agree to many digits on tori, and to few digits on chaotic and escaping orbits."""

from __future__ import annotations

import numpy as np

from engine import CASES, Plane, Potential, start_states
from engine.evidence.birkhoff_averages import TORUS_DIGITS, count_agreeing_digits

# Two uncoupled oscillators, one of them anharmonic: every orbit lies on a torus.
SEPARABLE = Potential("separable", ((2, 0, 0.5), (4, 0, 0.3), (0, 2, 0.8)))


def test_all_orbits_of_a_separable_potential_are_quasi_periodic() -> None:
    states = np.random.default_rng(1).uniform(-0.6, 0.6, (60, 4))
    assert np.all(count_agreeing_digits(SEPARABLE, states, 1000.0) >= TORUS_DIGITS)


def test_chaotic_orbits_agree_to_few_digits() -> None:
    # Just below the escape energy, nearly all orbits of case II, the Hénon-Heiles potential, are chaotic.
    x, px = np.random.default_rng(2).uniform(-0.15, 0.15, (2, 40))
    states = start_states(CASES["II"], Plane.X_PX, 0.1666, x, px)
    digits = count_agreeing_digits(CASES["II"], states, 4000.0)
    assert np.median(digits) < 3.5
    assert np.mean(digits >= TORUS_DIGITS) < 0.2


def test_two_averages_that_agree_by_chance_are_not_enough() -> None:
    # The orbit escapes at t = 55 000, although two consecutive averages agree to 8.03 digits.
    state = np.array([[-0.7565352939370201, -0.357878414590201, -0.0256990807857555, -0.21336712097303748]])
    assert count_agreeing_digits(CASES["III"], state, 4000.0) < TORUS_DIGITS - 1.0


def test_tori_far_above_the_bottom_are_recognised() -> None:
    """At the largest amplitude, the energy is 10 000 times that of the first, and the frequency 20 times as high."""
    states = np.array([[amplitude, 0.0, 0.0, 0.3] for amplitude in (0.5, 2.0, 10.0, 16.0)])
    assert np.all(count_agreeing_digits(SEPARABLE, states, 1000.0) > TORUS_DIGITS)


def test_the_digits_of_an_orbit_do_not_depend_on_the_others() -> None:
    """The other orbits take more steps, or run to infinity."""
    torus, others = [0.1, 0.0, 0.0, 0.3], [[0.0, 0.0, 1.0, 1.0], [0.3, 0.1, -0.2, 0.2]]
    alone = count_agreeing_digits(CASES["III"], np.array([torus]), 100.0)
    np.testing.assert_array_equal(count_agreeing_digits(CASES["III"], np.array([*others, torus]), 100.0)[2:], alone)


def test_escaping_orbit_has_zero_digits() -> None:
    states = np.array([[0.0, 0.0, 1.0, 1.0], [0.01, 0.0, 0.0, 0.1]])
    digits = count_agreeing_digits(CASES["III"], states, 100.0)
    assert digits[0] == 0.0
    assert digits[1] > 0.0
