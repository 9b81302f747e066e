"""Section points agree with SciPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, Plane, start_states
from engine.propagation.limited_steps import find_section_points

POTENTIAL, ENERGY = CASES["III"], 0.24


@pytest.fixture
def states() -> np.ndarray:
    x, px = np.random.default_rng(3).uniform(-0.4, 0.4, (2, 70))
    return start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px)


def test_points_agree_with_scipy(states: np.ndarray) -> None:
    def motion(_t: float, s: np.ndarray) -> list[float]:
        vx, vy = POTENTIAL.gradient(s[0], s[1])
        return [s[2], s[3], -vx, -vy]

    def height(_t: float, s: np.ndarray) -> float:
        return s[1]

    height.direction = 1.0  # type: ignore[attr-defined]
    expected = solve_ivp(motion, (0.0, 60.0), states[0], "DOP853", events=height, rtol=1e-12, atol=1e-13).y_events[0]
    expected = expected[np.hypot(*(expected[:, 1:4:2] - states[0, 1:4:2]).T) > 1e-6][:, [0, 2]]
    found_points = find_section_points(POTENTIAL, states[:1], 5, 60.0)[0]
    np.testing.assert_allclose(found_points, expected[:5], atol=1e-9)
