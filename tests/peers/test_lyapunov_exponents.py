"""SALI agrees with the largest Lyapunov exponent, computed with heyoka from two neighbouring orbits (Benettin's method)."""

from __future__ import annotations

import numpy as np
import pytest

from engine import (
    CASES,
    MapSpec,
    Plane,
    Potential,
    Regularity,
    compute_map,
    compute_regularity,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    start_states,
)
from engine.propagation.fates import is_chaotic
from engine.trajectories.chaos_indicators import Verdict
from tests.peers import taylor_heyoka

T_MAX, INTERVAL, DISTANCE = 3000.0, 10.0, 1e-8


def largest_exponents(potential: Potential, starts: np.ndarray, t_max: float = T_MAX, interval: float = INTERVAL) -> np.ndarray:
    n = len(starts)
    both = np.concatenate([starts, starts + DISTANCE * np.array([1.0, 2.0, 3.0, 4.0]) / np.sqrt(30)])
    growth = np.zeros(n)
    for _ in range(int(t_max / interval)):
        both = taylor_heyoka.propagated(potential, both, interval)
        deviation = both[n:] - both[:n]
        distance = np.linalg.norm(deviation, axis=1)
        growth += np.log(distance / DISTANCE)
        both[n:] = both[:n] + deviation * (DISTANCE / distance)[:, None]
    return growth / t_max


@pytest.mark.slow
@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("II", 0.1666), ("III", 0.24)])
def test_sali_agrees_with_the_lyapunov_exponent(name: str, energy: float) -> None:
    x, px = np.random.default_rng(4).uniform(-0.25, 0.25, (2, 16))
    starts = start_states(CASES[name], Plane.X_PX, energy, x, px)
    exponents = largest_exponents(CASES[name], starts)
    chaotic = is_chaotic(np.array([integrate_orbit(CASES[name], start, T_MAX).sali[-1] for start in starts]))
    # Deviations of regular orbits grow linearly, which gives ln(T)/T = 0.0027; exponents of chaotic orbits are 0.01 or more.
    clear = (exponents < 0.004) | (exponents > 0.008)
    assert clear.sum() >= 12
    np.testing.assert_array_equal(chaotic[clear], exponents[clear] > 0.008)


@pytest.mark.parametrize("energy", [30.0, 100.0])
def test_chaotic_pixels_far_above_the_bottom_have_large_exponents(energy: float) -> None:
    potential = parse_formula("½r²+x²y²−0.000001x⁶")
    whole = compute_map(MapSpec(potential, Plane.X_PX, energy, (12, 12), t_max=1000.0))
    rows, columns = np.nonzero(compute_regularity(whole).character == Regularity.CHAOTIC)
    starts = start_states(potential, Plane.X_PX, energy, whole.x[columns], whole.ordinate[rows])[::8]
    assert len(starts) >= 8
    assert np.all(largest_exponents(potential, starts, t_max=100.0, interval=1.0) > 0.5)


def test_exponent_of_henon_heiles_agrees_with_the_literature() -> None:
    """At E = 1/8 a test of galpy expects 0.04 to 0.08 (github.com/jobovy/galpy/pull/945, an orbit with 0.0519).

    The median of five orbits is used, because an orbit that sticks to an island for a long time has a smaller exponent.
    """
    potential = CASES["II"]  # the Hénon–Heiles potential with x and y exchanged
    x, px = np.array([[-0.25, 0.0], [-0.2, 0.1], [-0.25, 0.05], [-0.22, 0.02], [-0.24, -0.04]]).T
    orbits = [integrate_orbit(potential, start, 1e4) for start in start_states(potential, Plane.X_PX, 0.125, x, px)]
    assert {judge_orbit(orbit).character for orbit in orbits} == {Verdict.CHAOTIC}
    assert 0.04 < np.median([orbit.lyapunov_exponent[-1] for orbit in orbits]) < 0.08
