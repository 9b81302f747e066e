"""SALI of many orbits agrees with SALI of single orbits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, integrate_orbit, start_states
from engine.propagation.limited_steps import attach_deviations, propagate_deviations

STATES = start_states(CASES["II"], Plane.X_PX, 0.16, np.array([0.0, 0.1, -0.3]), np.array([0.0, 0.05, 0.1]))


def test_smallest_sali_agrees_with_that_of_single_orbits() -> None:
    orbits = propagate_deviations(CASES["II"], attach_deviations(STATES), 96.0)
    # SALI is computed at even intervals of eight samples of averages.
    interval = 8.0 * CASES["II"].well.sample_interval
    times = np.arange(interval, 96.1, interval)
    for smallest, state in zip(orbits[:, -1], STATES, strict=True):
        orbit = integrate_orbit(CASES["II"], state, 96.0)
        assert smallest == pytest.approx(np.interp(times, orbit.t, orbit.sali).min(), rel=1e-3)
