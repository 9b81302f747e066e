"""Section points of an orbit are as many as its crossings, and agree with an event finder."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Fate,
    Plane,
    Potential,
    classify_orbits,
    integrate_orbit,
    judge_orbit,
    sample_starts,
    start_states,
)
from engine.propagation.limited_steps import find_section_points
from engine.trajectories.chaos_indicators import Verdict

POTENTIAL, ENERGY = CASES["III"], 0.24
# For each case, an energy at which some orbits escape and others are regular.
MIXED = [("I", 0.14), ("III", 0.3)]


def split_starts(name: str, energy: float, t_max: float) -> tuple[np.ndarray, np.ndarray]:
    """Return starts of orbits that escape after more than two crossings, and starts of bounded orbits."""
    starts = start_states(CASES[name], Plane.X_PX, energy, *np.random.default_rng(6).uniform(-0.4, 0.4, (2, 400)))
    starts = starts[np.isfinite(starts).all(axis=1)]
    outcomes = classify_orbits(CASES[name], energy, starts, t_max)
    return starts[(outcomes.fate >= 1) & (outcomes.crossings > 2)], starts[outcomes.fate == Fate.BOUNDED]


@pytest.mark.parametrize(("name", "energy"), MIXED)
@pytest.mark.parametrize("escapes", [True, False])
def test_an_orbit_has_as_many_points_as_crossings(name: str, energy: float, escapes: bool) -> None:
    escaping, bounded = split_starts(name, energy, 300.0)
    for start in (escaping if escapes else bounded)[:8]:
        orbit = integrate_orbit(CASES[name], start, 300.0)
        assert orbit.crossings > 0
        assert orbit.find_section_crossings().shape == (orbit.crossings, 2)


@pytest.mark.parametrize(("name", "energy"), [("II", 0.15)])
def test_points_of_a_regular_orbit_agree_with_the_event_finder(name: str, energy: float) -> None:
    start = start_states(CASES[name], Plane.X_PX, energy, np.array([0.3]), np.zeros(1))
    orbit = integrate_orbit(CASES[name], start[0], 1000.0)
    assert judge_orbit(orbit).character is Verdict.NO_SIGN
    expected = find_section_points(CASES[name], start, orbit.crossings, 1000.0)[0]
    np.testing.assert_allclose(orbit.find_section_crossings(), expected, atol=1e-9)


def test_two_passages_between_samples_are_one_crossing() -> None:
    # ÿ = −y + x² turns the orbit back before the next sample.
    potential, start = Potential("rotated", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, -1.0))), (0.3, 1e-4, 0.0, -0.008)
    orbit = integrate_orbit(potential, start, 0.3)
    ends = replace(orbit, **{name: getattr(orbit, name)[[0, -1]] for name in ("t", "x", "y", "px", "py")})
    assert orbit.y[0] > 0.0 < orbit.y[-1]
    assert orbit.crossings == 1
    np.testing.assert_allclose(ends.find_section_crossings(), orbit.find_section_crossings(), atol=1e-12)


def test_points_of_orbits_past_a_body_are_all_found_and_allowed() -> None:
    # Some pass the planet between two samples.
    potential, energy = POTENTIALS["Hill"], -2.2
    orbits = [integrate_orbit(potential, start, 300.0) for start in sample_starts(potential, energy, 8, rng=1)]
    bounded = [orbit for orbit in orbits if orbit.fate == Fate.BOUNDED]
    assert len(bounded) > 2
    for orbit in bounded:
        x, px = orbit.find_section_crossings().T
        assert x.size == orbit.crossings
        assert np.all(potential.value(x, 0.0) + 0.5 * px**2 <= energy + 1e-8)
