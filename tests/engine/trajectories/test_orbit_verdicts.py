"""One verdict per orbit, which does not contradict its indicators."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, Evidence, Orbit, Plane, integrate_orbit, judge_orbit, start_states
from engine.results import BirkhoffDigits
from engine.trajectories.chaos_indicators import Verdict
from tests.disc import DISC

# An island and the chaotic sea of Hénon & Heiles below the escape energy.
ISLAND, SEA = [0.5, 0.0, 0.0, 0.2334], [-0.25, 0.0, 0.0, 0.42081]

# Orbits that are bounded until t = 5000 without a sign of chaos in deviation vectors. By t = 1e5, SALI falls to 1e-7, and the
# third orbit escapes.
STICKY = (
    ("I", (-0.3167831674667674, -0.1372214035177458, 0.00363892447924018, 0.3447834056797196)),
    ("I", (0.30298114722811476, 0.027745995206539975, 0.35121822596890456, -0.23779158119211288)),
    ("I", (0.42691359527116224, 0.3088051241106098, 0.12011369844841593, -0.24774655218686295)),
    ("II", (0.017126393957194064, -0.3378096145016677, -0.022390221364657945, -0.44853607381264227)),
)


def digits_of(value: float) -> BirkhoffDigits:
    return BirkhoffDigits(np.array([1000.0]), np.array([value]))


def with_end(orbit: Orbit, *, sali: float, growth: float, halves: float) -> Orbit:
    """Return a copy of an orbit with another final SALI, power of growth of the deviations, and digits of halves."""
    with np.errstate(divide="ignore", invalid="ignore"):
        changed = replace(orbit, sali=np.full_like(orbit.t, sali), lyapunov_exponent=growth * np.log(orbit.t) / orbit.t)
    changed.__dict__["digits_of_halves"] = halves
    return changed


@pytest.fixture(scope="module")
def bounded() -> Orbit:
    """Return an orbit that could escape but does not."""
    return replace(integrate_orbit(CASES["II"], ISLAND, 2000.0), evidence=Evidence.INTEGRATED)


@pytest.mark.parametrize(
    ("sali", "growth", "halves", "digits", "character"),
    [
        (0.1, 1.0, 7.0, None, Verdict.REGULAR),
        (1e-6, 1.8, 7.0, None, Verdict.REGULAR),
        (0.1, 1.0, 6.9, None, Verdict.NO_SIGN),
        (0.1, 1.0, 3.0, 7.9, Verdict.NO_SIGN),
        (0.1, 1.0, 3.0, 8.0, Verdict.REGULAR),
        (0.1, 1.8, 3.0, None, Verdict.UNDECIDED),
        (1e-6, 1.0, 3.0, None, Verdict.UNDECIDED),
        (1e-6, 2.5, 3.0, None, Verdict.CHAOTIC),
        (1e-9, 1.8, 3.0, None, Verdict.CHAOTIC),
        (0.1, 2.5, 3.0, None, Verdict.CHAOTIC),
        (0.1, 1.0, 3.0, 0.5, Verdict.CHAOTIC),
        (1e-9, 1.0, 9.0, None, Verdict.UNDECIDED),
        (0.1, 2.5, 3.0, 9.0, Verdict.UNDECIDED),
    ],
)
def test_the_character_is_that_of_the_indicators_that_decide(
    bounded: Orbit, sali: float, growth: float, halves: float, digits: float | None, character: Verdict
) -> None:
    orbit = with_end(bounded, sali=sali, growth=growth, halves=halves)
    assert judge_orbit(orbit, None if digits is None else digits_of(digits)).character is character


@pytest.mark.parametrize(("case", "state"), STICKY)
def test_sticky_orbits_are_not_called_regular(case: str, state: tuple[float, ...]) -> None:
    assert judge_orbit(integrate_orbit(CASES[case], state, 5000.0)).character is not Verdict.REGULAR


@pytest.mark.parametrize(("state", "character"), [(ISLAND, Verdict.REGULAR), (SEA, Verdict.CHAOTIC)])
def test_an_orbit_below_the_escape_energy_is_bounded_for_ever(state: list[float], character: Verdict) -> None:
    verdict = judge_orbit(integrate_orbit(CASES["II"], state, 2000.0))
    assert (verdict.evidence, verdict.character) == (Evidence.CLOSED, character)
    assert verdict.describe().startswith(f"Bounded for ever (its well is closed at this energy), {character} (")


@pytest.mark.parametrize(("digits", "on_a_torus"), [(7.9, False), (8.0, True)])
def test_digits_as_on_a_torus_are_evidence_that_an_orbit_is_bounded_for_ever(
    bounded: Orbit, digits: float, on_a_torus: bool
) -> None:
    verdict = judge_orbit(bounded, digits_of(digits))
    assert not verdict.is_bounded_for_ever
    assert (verdict.evidence is Evidence.QUASI_PERIODIC) is on_a_torus
    reason = "Bounded until t = 2 000 and probably for ever (evidence: its averages converge as on an invariant torus), regular"
    assert verdict.describe().startswith(reason) is on_a_torus
    assert verdict.summarize() == "bounded until t = 2 000, regular"


@pytest.mark.parametrize(("sali", "growth"), [(4.9e-11, 1.0), (0.1, 2.5)])
def test_signs_of_chaos_withdraw_the_evidence_of_a_torus(bounded: Orbit, sali: float, growth: float) -> None:
    verdict = judge_orbit(with_end(bounded, sali=sali, growth=growth, halves=9.0), digits_of(8.5))
    assert (verdict.evidence, verdict.character) == (Evidence.INTEGRATED, Verdict.UNDECIDED)
    assert "for ever" not in verdict.describe()


def test_an_escape_names_channel_time_and_crossings() -> None:
    orbit = integrate_orbit(CASES["II"], start_states(CASES["II"], Plane.X_PX, 0.3, np.array([0.1]), np.array([0.2]))[0], 1e3)
    verdict = judge_orbit(orbit)
    assert orbit.fate >= 1
    assert (verdict.evidence, verdict.character) == (Evidence.NONE, None)
    assert f"exit {orbit.fate} at t = {orbit.escape_time:.6g}" in verdict.describe()
    assert verdict.summarize() == f"exit {orbit.fate} at t = {orbit.escape_time:.5g}"
    aligned = judge_orbit(replace(orbit, sali=np.full_like(orbit.sali, 1e-9)))
    assert aligned.character is Verdict.CHAOTIC_INSIDE


@pytest.mark.parametrize(("crossings", "words"), [(0, "directly, without crossing"), (1, "after 1 upward crossing of")])
def test_an_escape_says_after_how_many_crossings(crossings: int, words: str) -> None:
    orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), 1e3)
    assert words in judge_orbit(replace(orbit, crossings=crossings)).describe()


def test_a_collision_is_named_in_the_sentence_and_in_the_list() -> None:
    orbit = integrate_orbit(DISC, (0.2, 0.0, 0.0, 0.5), 100.0)
    assert orbit.fate == 3
    verdict = judge_orbit(orbit)
    assert verdict.describe().startswith("Collided with a disc at t = ")
    assert verdict.summarize().startswith("collision with a disc at t = ")


def test_a_headline_says_where_an_orbit_ends_or_how_long_it_stays() -> None:
    escaping, bounded = (judge_orbit(integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, py), 1e3)) for py in (0.6, 0.3))
    assert escaping.headline() == "Escapes through exit 1 at t = 15.18, after 1 crossing"
    assert bounded.headline().startswith("Bounded for ever, ")
