"""Potentials from anywhere: looked over without an error, and what is let through can be shown."""

from __future__ import annotations

import time
from typing import Any
from urllib.parse import parse_qsl

from hypothesis import given
from hypothesis import strategies as st

from app.state.permalink import read_link, write_link
from app.state.system import TYPED, System, refusal
from app.state.view_state import ViewState
from cli.potentials import PARAMETERS, find_potential, name_in_files
from engine import POTENTIALS, Potential, PotentialReview, parse_formula, review_potential, write_formula
from tests.fuzz.hostile import LONGEST_SENTENCE, answer_or_refusal, anything, case_strings, either, formulas

LONGEST_REVIEW = 3.0
"""Seconds of processor time; a page waits for it where a link holds a formula."""

exponents = st.integers(0, 6)
sizes = st.floats(1e-6, 1e6) | st.floats(0.1, 3.0)
coefficients = either(sizes | sizes.map(lambda size: -size), st.just(0.0))
some_terms = st.lists(st.tuples(exponents, exponents, coefficients), max_size=6)


def looked_over(potential: Potential) -> PotentialReview:
    begun = time.process_time()
    found = review_potential(potential)
    assert time.process_time() - begun < LONGEST_REVIEW
    assert found.refusal is None or (found.refusal.endswith(".") and len(found.refusal) <= LONGEST_SENTENCE)
    return found


def check_shown(system: System, found: PotentialReview) -> None:
    """What the page lets through has a slider, a link and starts of orbits."""
    if refusal(found) is not None:
        return
    state = ViewState()
    state.show_system(system)
    energies = system.energies
    assert energies.low < energies.first < energies.high
    assert found.escape_energy < energies.first < found.highest_energy
    assert state.orbit_spec((0.0, 0.0)) is not None
    values, problems = read_link(dict(parse_qsl(write_link(state)[1:])))
    assert problems == []
    assert ViewState(**values).potential == system.potential


@given(some_terms)
def test_a_potential_of_any_terms(terms: list[tuple[Any, ...]]) -> None:
    potential = answer_or_refusal(lambda: Potential("any", tuple(terms)), ["terms"])
    if potential is not None:
        looked_over(potential)


@given(formulas)
def test_a_formula(text: str) -> None:
    potential = answer_or_refusal(lambda: parse_formula(text), ["formula"])
    if potential is not None:
        assert parse_formula(write_formula(potential)).terms == potential.terms
        check_shown(System(TYPED, text), looked_over(potential))


@given(st.sampled_from(list(POTENTIALS)), *[either(st.floats(0.5, 2.0))] * 3)
def test_parameters_of_a_known_potential(name: str, omega_1: Any, omega_2: Any, epsilon: Any) -> None:
    plain = POTENTIALS[name].potential
    changed = answer_or_refusal(lambda: plain.with_parameters(omega_1, omega_2, epsilon), PARAMETERS)
    if changed is not None:
        check_shown(System(name, "", float(omega_1), float(omega_2), float(epsilon)), looked_over(changed))


@given(case_strings)
def test_a_case_as_it_is_typed(case: str) -> None:
    answer_or_refusal(lambda: find_potential(case), ["case", *PARAMETERS])
    assert not set(name_in_files(case)) & set("/\\\0 \n")


@given(anything)
def test_what_is_no_text_is_no_formula(text: Any) -> None:
    if not isinstance(text, str):
        assert answer_or_refusal(lambda: parse_formula(text), ["text", "formula"]) is None
