"""The distance of two orbits agrees with SciPy, and long orbits are compared for a limited time."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from engine import CASES, Plane, compute_separation, start_states
from engine.trajectories.separation import LONGEST_SEPARATION


def state_at(case: str, h: float, x: float, px: float) -> np.ndarray:
    return start_states(CASES[case], Plane.X_PX, h, np.array([x]), np.array([px]))[0]


def test_the_distance_agrees_with_scipy() -> None:
    potential, first, second = CASES["II"], state_at("II", 0.15, 0.1, 0.2), state_at("II", 0.15, 0.1001, 0.2)
    separation = compute_separation(potential, first, second, 50.0)

    def flow(_t: float, s: np.ndarray) -> list[float]:
        x, y = s[0], s[1]
        return [s[2], s[3], -x + x * x - y * y, -y - 2 * x * y]

    paths = [solve_ivp(flow, (0, 50.0), s, "DOP853", t_eval=separation.t, rtol=1e-12, atol=1e-13).y for s in (first, second)]
    np.testing.assert_allclose(separation.distance, np.linalg.norm(paths[0] - paths[1], axis=0), rtol=1e-5)


def test_long_orbits_are_compared_for_the_longest_separation_time() -> None:
    state = state_at("I", 0.1, 0.1, 0.1)
    assert compute_separation(CASES["I"], state, 1.0000001 * state, 1e6).t[-1] == LONGEST_SEPARATION
