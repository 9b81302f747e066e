from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import numpy as np
import pytest

from engine import CASES, Fate, Plane, find_lyapunov_orbits, integrate_orbit, start_states
from engine.taylor.kernels import dense_output
from engine.trajectories.radius_envelope import compute_radius_envelope

BOUNDED = start_states(CASES["III"], Plane.X_PX, 0.26, np.array([0.1]), np.array([0.2]))[0]
LEAVING = start_states(CASES["I"], Plane.X_PX, 0.15, np.array([0.1]), np.array([0.0]))[0]


def test_it_holds_every_value_of_the_orbit_and_not_much_more() -> None:
    orbit, envelope = integrate_orbit(CASES["III"], BOUNDED, 2000.0), compute_radius_envelope(CASES["III"], BOUNDED, 2000.0, 40)
    place = np.clip(np.searchsorted(envelope.t, orbit.t, side="right") - 1, 0, 39)
    assert np.all(orbit.r2 <= envelope.high[place] + 1e-3)
    assert np.all(orbit.r2 >= envelope.low[place] - 1e-3)
    assert envelope.high.max() == pytest.approx(orbit.r2.max(), abs=1e-3)
    assert envelope.fate == Fate.BOUNDED
    assert np.isnan(envelope.escape_time)


def test_one_that_leaves_ends_on_the_lyapunov_orbit_at_its_escape() -> None:
    orbit, envelope = integrate_orbit(CASES["I"], LEAVING, 1e4), compute_radius_envelope(CASES["I"], LEAVING, 1e4, 25)
    exits = {exit_.channel: exit_.x**2 + exit_.y**2 for exit_ in find_lyapunov_orbits(CASES["I"], 0.15)}
    assert (envelope.fate, envelope.escape_time) == (orbit.fate, orbit.escape_time)
    assert envelope.t[-1] == orbit.escape_time
    assert exits[orbit.fate].min() - 1e-9 <= orbit.r2[-1] <= envelope.high[-1]


def test_an_orbit_may_come_in_any_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = compute_radius_envelope(CASES["III"], BOUNDED, 500.0, 10)
    monkeypatch.setattr(dense_output, "_CHUNK", 17)
    pieces = compute_radius_envelope(CASES["III"], BOUNDED, 500.0, 10)
    np.testing.assert_allclose(pieces.high, whole.high, atol=1e-3)
    np.testing.assert_allclose(pieces.low, whole.low, atol=1e-3)


def test_intervals_shorter_than_a_look_are_still_filled() -> None:
    envelope = compute_radius_envelope(CASES["III"], BOUNDED, 1.0, 400)
    assert np.isfinite(envelope.low).all()
    assert np.all(envelope.low <= envelope.high)


def test_a_start_outside_is_refused() -> None:
    with pytest.raises(ValueError, match="beyond a Lyapunov orbit"):
        compute_radius_envelope(CASES["II"], [2.0, 0.0, 0.5, 0.0], 10.0)


def test_no_intervals_are_refused() -> None:
    with pytest.raises(ValueError, match="intervals=0"):
        compute_radius_envelope(CASES["III"], BOUNDED, 10.0, 0)


def test_when_cancelled_it_stops() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_radius_envelope(CASES["III"], BOUNDED, 1e4, cancel=cancel)
