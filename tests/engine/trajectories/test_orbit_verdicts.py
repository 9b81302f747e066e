"""One verdict per orbit, which does not contradict its indicators."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from engine import CASES, BirkhoffDigits, Certificate, Fate, Orbit, Plane, Verdict, integrate_orbit, judge_orbit, start_states
from engine.service import evaluate_indicators

# An island and the chaotic sea of Hénon & Heiles below the escape energy.
ISLAND, SEA = [0.5, 0.0, 0.0, 0.2334], [-0.25, 0.0, 0.0, 0.42081]


def digits_of(value: float) -> BirkhoffDigits:
    return BirkhoffDigits(np.array([1000.0]), np.array([value]))


def with_end(orbit: Orbit, *, sali: float, growth: float) -> Orbit:
    """The orbit with another final SALI, and deviations that grow like t to a power."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return replace(orbit, sali=np.full_like(orbit.t, sali), lyapunov_exponent=growth * np.log(orbit.t) / orbit.t)


@pytest.fixture(scope="module")
def bounded() -> Orbit:
    """An orbit that could escape but does not."""
    return replace(integrate_orbit(CASES["II"], ISLAND, 2000.0), certificate=Certificate.INTEGRATED)


def test_a_short_orbit_is_undecided_as_for_its_indicators() -> None:
    start = start_states(CASES["II"], Plane.X_H, 0.0, np.array([0.3]), np.array([0.05]))[0]
    orbit = integrate_orbit(CASES["II"], start, 100.0)
    assert {indicator.conclusion for indicator in evaluate_indicators(orbit)} == {Verdict.UNDECIDED}
    verdict = judge_orbit(orbit)
    assert verdict.character is Verdict.UNDECIDED
    assert ", undecided whether regular or chaotic, with " in verdict.describe()


@pytest.mark.parametrize(
    ("sali", "growth", "digits", "character"),
    [
        (0.1, 1.0, None, Verdict.REGULAR),
        (0.1, 1.8, None, Verdict.REGULAR),
        (1e-6, 1.8, None, Verdict.UNDECIDED),
        (1e-6, 2.5, None, Verdict.CHAOTIC),
        (1e-9, 1.8, None, Verdict.CHAOTIC),
        (0.1, 2.5, None, Verdict.UNDECIDED),
        (0.1, 1.0, 0.5, Verdict.UNDECIDED),
        (1e-6, 1.8, 8.5, Verdict.REGULAR),
    ],
)
def test_the_character_is_that_of_the_indicators_that_decide(
    bounded: Orbit, sali: float, growth: float, digits: float | None, character: Verdict
) -> None:
    orbit = with_end(bounded, sali=sali, growth=growth)
    assert judge_orbit(orbit, None if digits is None else digits_of(digits)).character is character


@pytest.mark.parametrize(("state", "character"), [(ISLAND, Verdict.REGULAR), (SEA, Verdict.CHAOTIC)])
def test_an_orbit_below_the_escape_energy_is_bounded_for_ever(state: list[float], character: Verdict) -> None:
    verdict = judge_orbit(integrate_orbit(CASES["II"], state, 2000.0))
    assert (verdict.certificate, verdict.character) == (Certificate.CLOSED, character)
    assert verdict.describe().startswith(f"Bounded for ever (its energy is below every saddle) and {character}, with ")
    assert verdict.describe().endswith(" until t = 2 000.")


@pytest.mark.parametrize(("digits", "for_ever"), [(7.9, False), (8.0, True)])
def test_digits_as_on_a_torus_certify_an_orbit(bounded: Orbit, digits: float, for_ever: bool) -> None:
    verdict = judge_orbit(bounded, digits_of(digits))
    assert verdict.is_bounded_for_ever is for_ever
    start = "Bounded for ever (certified: quasi-periodic, as on an invariant torus)" if for_ever else "Bounded until t = 2 000"
    assert verdict.describe().startswith(start)
    assert verdict.summarize() == f"bounded {'for ever' if for_ever else 'until t = 2 000'}, regular"


def test_without_windows_to_compare_an_orbit_is_not_certified(bounded: Orbit) -> None:
    assert judge_orbit(bounded, BirkhoffDigits(np.array([]), np.array([]))).certificate is Certificate.INTEGRATED


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"crossings": 1}, "with 1 upward crossing of y = 0."),
        ({"crossings": 12345}, "with 12 345 upward crossings of y = 0."),
    ],
)
def test_crossings_are_counted_in_words(bounded: Orbit, changes: dict[str, Any], sentence: str) -> None:
    assert judge_orbit(replace(bounded, **changes)).describe().endswith(sentence)


def test_an_escape_names_channel_time_and_crossings() -> None:
    orbit = integrate_orbit(CASES["II"], start_states(CASES["II"], Plane.X_PX, 0.3, np.array([0.1]), np.array([0.2]))[0], 1e3)
    verdict = judge_orbit(orbit)
    assert orbit.fate >= 1
    assert (verdict.certificate, verdict.character) == (Certificate.NONE, None)
    assert f"channel {orbit.fate} at t = {orbit.escape_time:.6g}" in verdict.describe()
    assert verdict.summarize() == f"channel {orbit.fate} at t = {orbit.escape_time:.5g}"
    assert "after 1 upward crossing of y = 0." in judge_orbit(replace(orbit, crossings=1)).describe()
    assert judge_orbit(replace(orbit, crossings=0)).describe().endswith("directly, without crossing y = 0 upward.")


def test_an_outside_start_is_neither_bounded_nor_judged() -> None:
    orbit = integrate_orbit(CASES["II"], start_states(CASES["II"], Plane.X_Y, 0.3, np.array([1.3]), np.zeros(1))[0], 10.0)
    verdict = judge_orbit(orbit)
    assert (verdict.fate, verdict.character, verdict.summarize()) == (Fate.OUTSIDE, None, "outside")
    assert verdict.describe().startswith("Outside")
