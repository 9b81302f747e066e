from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import numpy as np
import pytest

from engine import CASES, Fate, Plane, find_lyapunov_orbits, integrate_orbit, start_states
from engine.execution import Execution
from engine.taylor.kernels import dense_output
from engine.trajectories.radius_envelope import compute_radius_envelope

BOUNDED = start_states(CASES["III"], Plane.X_PX, 0.26, np.array([0.1]), np.array([0.2]))[0]
ESCAPING = start_states(CASES["I"], Plane.X_PX, 0.15, np.array([0.1]), np.array([0.0]))[0]


def test_it_encloses_the_samples_of_the_orbit_tightly() -> None:
    orbit, envelope = (
        integrate_orbit(CASES["III"], BOUNDED, 2000.0),
        compute_radius_envelope(CASES["III"], BOUNDED, 2000.0, intervals=40),
    )
    place = np.clip(np.searchsorted(envelope.t, orbit.t, side="right") - 1, 0, 39)
    assert np.all(orbit.r2 <= envelope.high[place] + 1e-3)
    assert np.all(orbit.r2 >= envelope.low[place] - 1e-3)
    assert envelope.high.max() == pytest.approx(orbit.r2.max(), abs=1e-3)
    assert envelope.fate == Fate.BOUNDED
    assert np.isnan(envelope.escape_time)


def test_the_envelope_of_an_escaping_orbit_ends_on_the_lyapunov_orbit() -> None:
    orbit, envelope = integrate_orbit(CASES["I"], ESCAPING, 1e4), compute_radius_envelope(CASES["I"], ESCAPING, 1e4, intervals=25)
    exits = {exit_.channel: exit_.x**2 + exit_.y**2 for exit_ in find_lyapunov_orbits(CASES["I"], 0.15)}
    assert (envelope.fate, envelope.escape_time) == (orbit.fate, orbit.escape_time)
    assert envelope.t[-1] == orbit.escape_time
    assert exits[orbit.fate].min() - 1e-9 <= orbit.r2[-1] <= envelope.high[-1]


def test_the_chunk_size_does_not_affect_the_result(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = compute_radius_envelope(CASES["III"], BOUNDED, 500.0, intervals=10)
    monkeypatch.setattr(dense_output, "_CHUNK", 17)
    pieces = compute_radius_envelope(CASES["III"], BOUNDED, 500.0, intervals=10)
    np.testing.assert_allclose(pieces.high, whole.high, atol=1e-3)
    np.testing.assert_allclose(pieces.low, whole.low, atol=1e-3)


def test_intervals_shorter_than_the_sample_interval_have_values() -> None:
    envelope = compute_radius_envelope(CASES["III"], BOUNDED, 1.0, intervals=400)
    assert np.isfinite(envelope.low).all()
    assert np.all(envelope.low <= envelope.high)


def test_an_outside_start_raises() -> None:
    with pytest.raises(ValueError, match="beyond an exit, in a body"):
        compute_radius_envelope(CASES["II"], [2.0, 0.0, 0.5, 0.0], 10.0)


def test_zero_intervals_raise() -> None:
    with pytest.raises(ValueError, match="intervals=0"):
        compute_radius_envelope(CASES["III"], BOUNDED, 10.0, intervals=0)


def test_a_cancelled_integration_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_radius_envelope(CASES["III"], BOUNDED, 1e4, execution=Execution(cancel=cancel))
