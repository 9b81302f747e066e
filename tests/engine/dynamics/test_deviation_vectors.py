from __future__ import annotations

import threading

import numpy as np
import pytest

from engine import CASES, Plane, integrate_orbit, start_states
from engine.dynamics.deviation_vectors import attach_deviations, propagate_deviations
from engine.dynamics.fates import is_chaotic
from engine.execution import Execution
from engine.potentials.compiled import fixed_step_size

STATES = start_states(CASES["II"], Plane.X_PX, 0.16, np.array([0.0, 0.1, -0.3]), np.array([0.0, 0.05, 0.1]))


def test_attached_deviations_have_an_infinite_sali() -> None:
    orbits = attach_deviations(STATES)
    assert orbits.shape == (3, 13)
    np.testing.assert_array_equal(orbits[:, :4], STATES)
    assert np.all(np.isinf(orbits[:, -1]))


def test_smallest_sali_agrees_with_that_of_single_orbits() -> None:
    orbits = propagate_deviations(CASES["II"], attach_deviations(STATES), 96.0)
    # SALI is computed at every eighth step.
    times = np.arange(8.0 * fixed_step_size(CASES["II"]), 96.1, 8.0 * fixed_step_size(CASES["II"]))
    for smallest, state in zip(orbits[:, -1], STATES, strict=True):
        orbit = integrate_orbit(CASES["II"], state, 96.0)
        assert smallest == pytest.approx(np.interp(times, orbit.t, orbit.sali).min(), rel=1e-3)


def test_smallest_sali_never_grows() -> None:
    early = propagate_deviations(CASES["II"], attach_deviations(STATES), 100.0)
    late = propagate_deviations(CASES["II"], early, 200.0)
    assert np.all(late[:, -1] <= early[:, -1])


def test_sali_at_or_below_the_threshold_and_nan_are_chaotic() -> None:
    np.testing.assert_array_equal(is_chaotic(np.array([1.4, 1.01e-7, 1e-7, 0.0, np.nan])), [False, False, True, True, True])


def test_cancelling_leaves_nan() -> None:
    cancel = threading.Event()
    cancel.set()
    assert np.isnan(propagate_deviations(CASES["II"], attach_deviations(STATES), 10.0, execution=Execution(cancel=cancel))).all()
