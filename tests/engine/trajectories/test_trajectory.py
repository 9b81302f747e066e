"""Single orbits agree with SciPy and with orbits of batches, in path, outcome and indicators."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    Evidence,
    Fate,
    Orbit,
    Plane,
    classify_orbits,
    integrate_orbit,
    judge_orbit,
    sample_starts,
    start_states,
)
from engine.propagation.limited_steps import DEVIATION_VECTORS
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits
from engine.trajectories.chaos_indicators import Verdict
from tests.peers.dop853 import equations, variational_equations
from tests.peers.exit_lines import exit_lines

# An energy of each case at which some orbits escape and some do not.
ENERGY = {"I": 0.14, "II": 0.18, "III": 0.35}
ESCAPING = [("I", 1), ("II", 3), ("III", 4)]


def interior_starts(name: str, energy: float, count: int, reach: float = 0.4) -> np.ndarray:
    x, px = np.random.default_rng(4).uniform(-reach, reach, (2, count))
    states = start_states(CASES[name], Plane.X_PX, energy, x, px)
    return states[np.isfinite(states).all(axis=1)]


def start_with_fate(name: str, fate: int, t_max: float = 200.0) -> np.ndarray:
    starts = interior_starts(name, ENERGY[name], 400)
    return starts[np.flatnonzero(classify_orbits(CASES[name], ENERGY[name], starts, t_max).fate == fate)[0]]


@pytest.fixture(scope="module", params=CASES)
def bounded(request: pytest.FixtureRequest) -> tuple[str, np.ndarray, Orbit]:
    start = start_with_fate(request.param, Fate.BOUNDED)
    return request.param, start, integrate_orbit(CASES[request.param], start, 200.0)


@pytest.fixture(scope="module", params=ESCAPING, ids=str)
def escaping(request: pytest.FixtureRequest) -> tuple[str, np.ndarray, Orbit]:
    name, channel = request.param
    start = start_with_fate(name, channel)
    return name, start, integrate_orbit(CASES[name], start, 200.0)


def states_of(orbit: Orbit) -> np.ndarray:
    return np.column_stack([orbit.x, orbit.y, orbit.px, orbit.py])


# The path.


def test_the_path_leads_from_the_start_to_t_max_in_equal_intervals(bounded: tuple[str, np.ndarray, Orbit]) -> None:
    _, start, orbit = bounded
    np.testing.assert_array_equal(states_of(orbit)[0], start)
    assert (orbit.t[0], orbit.t[-1]) == (0.0, 200.0)
    np.testing.assert_allclose(np.diff(orbit.t), orbit.t[1], rtol=1e-9)
    np.testing.assert_allclose(orbit.r2, orbit.x**2 + orbit.y**2, rtol=1e-14)
    assert np.isnan(orbit.escape_time)


@pytest.mark.parametrize(("name", "energy"), [("I", 0.05), ("II", 0.08), ("III", 0.1)])
def test_a_regular_orbit_agrees_with_scipy(name: str, energy: float) -> None:
    start = interior_starts(name, energy, 20, reach=0.15)[0]
    orbit = integrate_orbit(CASES[name], start, 50.0)
    path = solve_ivp(
        equations(CASES[name]), (0, 50), start, "DOP853", rtol=1e-13, atol=1e-15, t_eval=orbit.t[:: orbit.t.size // 40]
    ).y
    np.testing.assert_allclose(states_of(orbit)[:: orbit.t.size // 40].T, path, atol=1e-9)


# Fate and verdict.


def test_fate_time_and_crossings_equal_those_of_a_batch(escaping: tuple[str, np.ndarray, Orbit]) -> None:
    name, start, orbit = escaping
    outcome = classify_orbits(CASES[name], orbit.energy, start[None], 200.0)
    mine = (orbit.fate, orbit.escape_time, orbit.crossings, orbit.energy_error)
    assert mine == (outcome.fate[0], outcome.escape_time[0], outcome.crossings[0], outcome.energy_error[0])


def test_an_escaped_orbit_ends_on_its_exit_and_is_inside_before(escaping: tuple[str, np.ndarray, Orbit]) -> None:
    name, _, orbit = escaping
    line = exit_lines(CASES[name], orbit.energy)[orbit.fate - 1]
    beyond = line.beyond(orbit.x, orbit.y)
    assert orbit.t[-1] == orbit.escape_time
    assert beyond[-1] == pytest.approx(0.0, abs=1e-8)
    assert np.all(beyond[:-1] < 0)


@pytest.mark.parametrize(("factor", "escapes"), [(1 - 1e-9, False), (1.0, True), (1 + 1e-9, True)])
def test_t_max_around_the_escape_time_decides(escaping: tuple[str, np.ndarray, Orbit], factor: float, escapes: bool) -> None:
    name, start, orbit = escaping
    again = integrate_orbit(CASES[name], start, factor * orbit.escape_time)
    assert again.fate == (orbit.fate if escapes else Fate.BOUNDED)
    assert again.t[-1] == (orbit.escape_time if escapes else factor * orbit.escape_time)


def test_an_outside_start_stays_where_it_is() -> None:
    orbit = integrate_orbit(CASES["II"], start_states(CASES["II"], Plane.X_Y, 0.3, np.array([1.3]), np.zeros(1))[0], 10.0)
    assert (orbit.fate, orbit.t.tolist(), orbit.x.tolist()) == (Fate.OUTSIDE, [0.0], [1.3])
    assert orbit.evidence is Evidence.NONE


# SALI.


# The Lyapunov exponent.


@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("II", 0.1666), ("III", 0.24)])
def test_sali_and_the_lyapunov_exponent_agree_with_scipys_variational_equations(name: str, energy: float) -> None:
    start = interior_starts(name, energy, 20)[0]
    orbit = integrate_orbit(CASES[name], start, 80.0)
    pick = slice(orbit.t.size // 20, None, orbit.t.size // 20)
    flat = np.concatenate([start, DEVIATION_VECTORS.ravel()])
    both = solve_ivp(variational_equations(CASES[name]), (0, 80), flat, "DOP853", rtol=1e-12, atol=1e-12, t_eval=orbit.t[pick]).y[
        4:
    ]
    exponent = np.log(np.linalg.norm(both[:4], axis=0)) / orbit.t[pick]
    np.testing.assert_allclose(orbit.lyapunov_exponent[pick], exponent, rtol=1e-6, atol=1e-9)
    one, two = (w / np.linalg.norm(w, axis=0) for w in both.reshape(2, 4, -1))
    sali = np.minimum(np.linalg.norm(one - two, axis=0), np.linalg.norm(one + two, axis=0))
    early = orbit.t[pick] < 40.0
    np.testing.assert_allclose(orbit.sali[pick][early], sali[early], rtol=1e-6, atol=1e-9)
    assert orbit.sali[0] == pytest.approx(np.sqrt(2.0))
    assert np.isnan(orbit.lyapunov_exponent[0])


# Invalid parameters.


@pytest.mark.parametrize("side", [-1.0, 0.0, 1.0])
def test_an_orbit_at_rest_on_a_saddle_is_bounded_and_does_not_run_away(side: float) -> None:
    name = "II"
    saddle = CASES[name].saddles[0]
    x, y = np.nextafter(saddle, saddle + side * saddle) if side else saddle
    orbit = integrate_orbit(CASES[name], (x, y, 0.0, 0.0), 100.0)
    assert orbit.energy == pytest.approx(CASES[name].escape_energy, abs=1e-16)
    assert (orbit.fate, orbit.evidence) == (Fate.BOUNDED, Evidence.CLOSED)
    assert np.hypot(orbit.x, orbit.y).max() < 1.01 * np.hypot(*saddle)


def test_deviations_grow_as_the_distance_of_a_neighbour_past_a_body() -> None:
    # The orbit passes the body at a distance of 0.013 at t = 3.13. Steps are much shorter there than the sampling intervals.
    potential, start, distance = POTENTIALS["Hill"], np.array([-0.3, 0.0, 0.0, 2.5346]), 1e-9
    units = potential.units.state
    orbit = integrate_orbit(potential, start, 3.5)
    neighbour = integrate_orbit(potential, start + distance * DEVIATION_VECTORS[0] * units, 3.5)
    apart = (states_of(neighbour) - states_of(orbit))[-1] / units
    assert orbit.lyapunov_exponent[-1] * 3.5 == pytest.approx(np.log(np.linalg.norm(apart) / distance), abs=1e-3)


def test_orbits_around_a_body_are_not_called_chaotic_for_the_steps_past_it() -> None:
    potential = POTENTIALS["Hill"]
    orbits = [integrate_orbit(potential, start, 1000.0) for start in sample_starts(potential, -2.2, 6, rng=1)]
    bounded = [orbit for orbit in orbits if orbit.fate == Fate.BOUNDED]
    assert len(bounded) > 2
    assert all(judge_orbit(orbit).character is Verdict.REGULAR for orbit in bounded)


def test_the_birkhoff_digits_of_an_orbit_are_those_of_its_start() -> None:
    start = (0.1, 0.0, 0.0, 0.3)
    orbit = integrate_orbit(CASES["II"], start, t_max=2000.0)
    found, wanted = orbit.compute_birkhoff_digits(), compute_birkhoff_digits(CASES["II"], start, 2000.0)
    np.testing.assert_array_equal(found.digits, wanted.digits)
    with pytest.raises(ValueError, match="this orbit has no potential"):
        replace(orbit, potential=None).compute_birkhoff_digits()
