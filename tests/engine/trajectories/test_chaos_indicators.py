"""SALI, Lyapunov exponent and Birkhoff digits agree with the known character of orbits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Orbit, Plane, Potential, classify_orbits, integrate_orbit, start_states
from engine.evidence.birkhoff_averages import TORUS_DIGITS, WINDOWS
from engine.foundations.wording import format_time
from engine.trajectories import chaos_indicators
from engine.trajectories.birkhoff_digits import BirkhoffDigits, compute_birkhoff_digits
from engine.trajectories.chaos_indicators import Verdict, evaluate_indicators
from tests.extending import run_example

# Starts of Hénon & Heiles at or below E = 1/8, with their y as x: in an island, and in the chaotic sea.
ISLAND, SEA = [0.5, 0.0, 0.0, 0.2334], [-0.25, 0.0, 0.0, 0.42081]
# Two uncoupled oscillators: every bounded orbit lies on a torus. The saddle is at (1, 0), with V = 1/6.
SEPARABLE = Potential("separable", ((2, 0, 0.5), (3, 0, -1 / 3), (0, 2, 0.8)))


def conclusions(orbit: Orbit, digits: BirkhoffDigits | None = None) -> list[Verdict | None]:
    return [verdict.conclusion for verdict in evaluate_indicators(orbit, digits)]


@pytest.fixture(scope="module")
def island() -> Orbit:
    return integrate_orbit(CASES["II"], ISLAND, 8000.0)


@pytest.fixture(scope="module")
def late_escape() -> tuple[np.ndarray, Orbit]:
    """Return the start and the orbit of an escape between t = 2000 and 8000."""
    x = np.linspace(-0.4, 0.4, 1500)
    states = start_states(CASES["I"], Plane.X_PX, 0.14, x, np.full_like(x, 0.05))
    states = states[np.isfinite(states).all(axis=1)]
    times = classify_orbits(CASES["I"], 0.14, states, 8000.0).escape_time
    state = states[np.flatnonzero((times > 2000.0) & (times < 8000.0))[0]]
    return state, integrate_orbit(CASES["I"], state, 1e5)


# Digits by window length.


def test_digits_of_a_torus_rise_to_the_number_that_is_evidence() -> None:
    found = compute_birkhoff_digits(CASES["I"], start_states(CASES["I"], Plane.X_PX, 0.12, np.array([-0.2]), np.zeros(1))[0], 1e5)
    assert found.digits.size > 1
    assert np.all(np.diff(found.digits) > 1.0)
    assert found.digits[-2] < TORUS_DIGITS <= found.digits[-1]


@pytest.mark.parametrize(("t_max", "count"), [(1999.0, 0), (2000.0, 1), (8000.0, 2)])
def test_two_windows_of_digits_must_fit_into_t_max(t_max: float, count: int) -> None:
    assert compute_birkhoff_digits(CASES["II"], SEA, t_max).windows.tolist() == list(WINDOWS[:count])


# Conclusions.


# Conclusions of SALI, the exponent, the digits of halves, and the digits.
TORUS = [Verdict.NO_SIGN, Verdict.NO_SIGN, Verdict.REGULAR, Verdict.REGULAR]


def test_an_orbit_of_the_chaotic_sea_is_chaotic() -> None:
    sea = integrate_orbit(CASES["II"], SEA, 8000.0)
    found = conclusions(sea, compute_birkhoff_digits(CASES["II"], SEA, 8000.0))
    assert found == [Verdict.CHAOTIC, Verdict.CHAOTIC, Verdict.UNDECIDED, Verdict.CHAOTIC]


def test_orbits_of_a_separable_potential_are_regular() -> None:
    state = np.random.default_rng(0).uniform(-0.2, 0.2, 4)
    orbit = integrate_orbit(SEPARABLE, state, 2000.0)
    assert conclusions(orbit, compute_birkhoff_digits(SEPARABLE, state, 2000.0)) == TORUS


def test_indicators_agree_where_regular_and_chaotic_orbits_coexist() -> None:
    x, px = np.random.default_rng(4).uniform(-0.4, 0.4, (2, 24))
    states = start_states(CASES["I"], Plane.X_PX, 0.12, x, px)
    seen = set()
    for state in states[np.isfinite(states).all(axis=1)][:8]:
        orbit = integrate_orbit(CASES["I"], state, 8000.0)
        of_this_orbit = set(conclusions(orbit, compute_birkhoff_digits(CASES["I"], state, 8000.0)))
        assert not {Verdict.REGULAR, Verdict.CHAOTIC} <= of_this_orbit
        seen |= of_this_orbit
    assert {Verdict.REGULAR, Verdict.CHAOTIC} <= seen


def test_an_orbit_that_escapes_late_is_chaotic_while_inside(late_escape: tuple[np.ndarray, Orbit]) -> None:
    orbit, digits = late_escape[1], BirkhoffDigits(np.array([1000.0]), np.array([1.5]))
    verdicts = evaluate_indicators(orbit, digits)
    assert [verdict.conclusion for verdict in verdicts] == [Verdict.CHAOTIC_INSIDE, Verdict.CHAOTIC_INSIDE, None]
    assert [verdict.value for verdict in verdicts] == [orbit.sali[-1], orbit.lyapunov_exponent[-1], 1.5]
    assert all(f"t = {format_time(orbit.escape_time)}" in verdict.sentence for verdict in verdicts)


@pytest.mark.parametrize("t_max", [1e-3, 300.0])
def test_a_short_regular_orbit_is_undecided(t_max: float) -> None:
    orbit = integrate_orbit(CASES["II"], ISLAND, t_max)
    digits = compute_birkhoff_digits(CASES["II"], ISLAND, t_max)
    assert conclusions(orbit, digits) == [Verdict.UNDECIDED] * 4


@pytest.mark.parametrize(
    ("sali", "expected"),
    [
        (1e-7, Verdict.CHAOTIC),
        (1e-6, Verdict.UNDECIDED),
        (2e-5, Verdict.NO_SIGN),
    ],
)
def test_sali_between_chaos_and_tori_is_undecided(island: Orbit, sali: float, expected: Verdict) -> None:
    assert conclusions(replace(island, sali=np.full_like(island.t, sali)))[0] is expected


@pytest.mark.parametrize(("power", "expected"), [(1.8, Verdict.UNDECIDED), (2.1, Verdict.CHAOTIC)])
def test_growth_by_a_power_of_time_is_judged_by_the_power(island: Orbit, power: float, expected: Verdict) -> None:
    with np.errstate(divide="ignore", invalid="ignore"):
        exponent = power * np.log(island.t) / island.t
    verdict = evaluate_indicators(replace(island, lyapunov_exponent=exponent))[1]
    assert verdict.conclusion is expected
    assert verdict.value == exponent[-1]


def test_oscillations_of_the_growth_do_not_decide(island: Orbit) -> None:
    with np.errstate(divide="ignore", invalid="ignore"):
        # Without the oscillation, the vector grows like t. At t/10 and t, the oscillation is at its lowest and its highest.
        growth = np.log(island.t) + 0.8 * np.cos(50.0 * np.pi * island.t / island.t[-1])
        oscillating = replace(island, lyapunov_exponent=growth / island.t)
    assert conclusions(oscillating)[1] is Verdict.NO_SIGN


def test_growth_that_turns_exponential_late_is_not_regular(island: Orbit) -> None:
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = np.log(island.t) + 5.0 * np.clip(island.t / island.t[-1] - 0.5, 0.0, None)
        late = replace(island, lyapunov_exponent=growth / island.t)
    assert conclusions(late)[1] is Verdict.UNDECIDED


@pytest.mark.parametrize(
    ("window", "digits", "expected"),
    [
        (1000.0, 0.9, Verdict.CHAOTIC),
        (1000.0, 1.5, Verdict.UNDECIDED),
        (16000.0, 1.5, Verdict.CHAOTIC),
        (16000.0, 7.9, Verdict.UNDECIDED),
        (64000.0, 8.0, Verdict.REGULAR),
    ],
)
def test_digits_are_judged_at_the_longest_window(island: Orbit, window: float, digits: float, expected: Verdict) -> None:
    found = BirkhoffDigits(np.array([500.0, window]), np.array([5.0, digits]))
    assert conclusions(island, found)[3] is expected


def test_the_indicator_of_the_guide_tells_the_sea_from_an_island(island: Orbit) -> None:
    indicator = run_example("Example: add a chaos indicator", vars(chaos_indicators))["FLI"]
    assert indicator.judge(integrate_orbit(CASES["II"], SEA, 8000.0), None)[0] is Verdict.CHAOTIC
    assert indicator.judge(island, None)[0] is Verdict.UNDECIDED
