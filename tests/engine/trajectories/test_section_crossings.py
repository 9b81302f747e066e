from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, Fate, Plane, Regularity, classify_orbits, find_section_crossings, integrate_orbit, start_states
from engine.dynamics.section_points import find_section_points

POTENTIAL, ENERGY = CASES["III"], 0.24


@pytest.fixture
def states() -> np.ndarray:
    x, px = np.random.default_rng(3).uniform(-0.4, 0.4, (2, 70))
    return start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px)


def test_points_are_those_that_scipy_finds(states: np.ndarray) -> None:
    def motion(_t: float, s: np.ndarray) -> list[float]:
        vx, vy = POTENTIAL.gradient(s[0], s[1])
        return [s[2], s[3], -vx, -vy]

    def height(_t: float, s: np.ndarray) -> float:
        return s[1]

    height.direction = 1.0  # type: ignore[attr-defined]
    theirs = solve_ivp(motion, (0.0, 60.0), states[0], "DOP853", events=height, rtol=1e-12, atol=1e-13).y_events[0]
    theirs = theirs[np.hypot(*(theirs[:, 1:4:2] - states[0, 1:4:2]).T) > 1e-6][:, [0, 2]]
    mine = find_section_points(POTENTIAL, states[:1], 5, 60.0)[0]
    np.testing.assert_allclose(mine, theirs[:5], atol=1e-9)


def test_following_on_from_a_point_gives_the_next_ones(states: np.ndarray) -> None:
    points = find_section_points(POTENTIAL, states, 4, 100.0)
    again = start_states(POTENTIAL, Plane.X_PX, ENERGY, *points[:, 0].T)
    np.testing.assert_allclose(find_section_points(POTENTIAL, again, 3, 100.0), points[:, 1:], atol=1e-7)


def test_points_not_reached_in_time_are_nan(states: np.ndarray) -> None:
    points = find_section_points(POTENTIAL, states, 50, 30.0)
    found = np.isfinite(points).all(axis=2)
    assert found[:, 0].all()
    assert not found[:, -1].any()
    assert np.all(np.diff(found.astype(int), axis=1) <= 0)


def test_an_executor_makes_no_difference(states: np.ndarray) -> None:
    with ThreadPoolExecutor(3) as pool:
        mine = find_section_points(POTENTIAL, states, 3, 60.0, executor=pool)
    np.testing.assert_array_equal(mine, find_section_points(POTENTIAL, states, 3, 60.0))
    np.testing.assert_array_equal(mine[-1:], find_section_points(POTENTIAL, states[-1:], 3, 60.0))


def test_no_orbits_have_no_points() -> None:
    assert find_section_points(POTENTIAL, np.empty((0, 4)), 3, 60.0).shape == (0, 3, 2)


def test_when_cancelled_no_points_are_looked_for(states: np.ndarray) -> None:
    cancel = threading.Event()
    cancel.set()
    points = find_section_points(POTENTIAL, states, 3, 60.0, cancel=cancel)
    assert points.shape == (len(states), 3, 2)
    assert np.isnan(points).all()


# Points read off an orbit.

# An energy of each case at which some orbits leave and others are regular.
MIXED = [("I", 0.14), ("II", 0.18), ("III", 0.3)]


def sorted_starts(name: str, energy: float, t_max: float) -> tuple[np.ndarray, np.ndarray]:
    """Starts that leave after some crossings, and others that stay."""
    starts = start_states(CASES[name], Plane.X_PX, energy, *np.random.default_rng(6).uniform(-0.4, 0.4, (2, 400)))
    starts = starts[np.isfinite(starts).all(axis=1)]
    outcomes = classify_orbits(CASES[name], energy, starts, t_max)
    return starts[(outcomes.fate >= 1) & (outcomes.crossings > 2)], starts[outcomes.fate == Fate.BOUNDED]


@pytest.mark.parametrize(("name", "energy"), MIXED)
@pytest.mark.parametrize("leaves", [True, False])
def test_an_orbit_has_as_many_points_as_crossings(name: str, energy: float, leaves: bool) -> None:
    leaving, staying = sorted_starts(name, energy, 300.0)
    for start in (leaving if leaves else staying)[:8]:
        orbit = integrate_orbit(CASES[name], start, 300.0)
        assert orbit.crossings > 0
        assert find_section_crossings(CASES[name], orbit).shape == (orbit.crossings, 2)


@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("II", 0.15), ("III", 0.24)])
def test_points_of_a_regular_orbit_are_those_that_are_looked_for(name: str, energy: float) -> None:
    start = start_states(CASES[name], Plane.X_PX, energy, np.array([0.3]), np.zeros(1))
    orbit = integrate_orbit(CASES[name], start[0], 1000.0)
    assert orbit.regularity is Regularity.REGULAR
    theirs = find_section_points(CASES[name], start, orbit.crossings, 1000.0)[0]
    np.testing.assert_allclose(find_section_crossings(CASES[name], orbit), theirs, atol=1e-6)


def test_points_between_samples_far_apart_are_right_too() -> None:
    start = start_states(POTENTIAL, Plane.X_PX, ENERGY, np.array([0.1]), np.array([0.2]))[0]
    orbit = integrate_orbit(POTENTIAL, start, 1000.0)
    sparse = replace(orbit, **{name: getattr(orbit, name)[::10] for name in ("t", "x", "y", "px", "py")})
    np.testing.assert_allclose(find_section_crossings(POTENTIAL, sparse), find_section_crossings(POTENTIAL, orbit), atol=1e-6)


@pytest.mark.parametrize(("state", "crossings"), [((0.0, 0.0, 0.0, 0.5), 0), ((0.0, -1e-9, 0.0, 0.5), 1)])
def test_a_start_on_the_section_is_no_point(state: tuple[float, float, float, float], crossings: int) -> None:
    orbit = integrate_orbit(POTENTIAL, state, 1.0)
    assert len(find_section_crossings(POTENTIAL, orbit)) == orbit.crossings == crossings


def test_an_orbit_that_begins_outside_has_no_points() -> None:
    orbit = integrate_orbit(POTENTIAL, (1.2, 1.2, 0.0, 1.2), 10.0)
    assert orbit.fate == Fate.OUTSIDE
    assert find_section_crossings(POTENTIAL, orbit).shape == (0, 2)
