"""Any potential can be reviewed, and every accepted potential can be displayed."""

from __future__ import annotations

import random
import time
from typing import Any
from urllib.parse import parse_qsl

from hypothesis import example, given
from hypothesis import strategies as st

from app.state.permalink import linked_view, read_link, write_link
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from engine import Potential, System, parse_formula, review_potential, write_formula
from engine.results import PotentialReview
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.system import TYPED
from plots.texts.accepted_potentials import page_refusal
from tests.app.state.opened_link import open_link
from tests.contracts.potentials import WELLS
from tests.fuzz.hostile import LONGEST_MESSAGE, formulas, mostly, result_or_error
from tests.fuzz.random_formulas import random_link

LONGEST_REVIEW = 30.0
"""Processor time that only a review without bounds takes, in seconds. On a fast, quiet processor, reviews take up to 3 s."""

exponents = st.integers(0, 6)
sizes = st.floats(1e-6, 1e6) | st.floats(0.1, 3.0)
coefficients = mostly(sizes | sizes.map(lambda size: -size), st.just(0.0))
term_lists = st.lists(st.tuples(exponents, exponents, coefficients), max_size=6)


def reviewed(potential: Potential) -> PotentialReview:
    begun = time.thread_time()
    review = review_potential(potential)
    assert time.thread_time() - begun < LONGEST_REVIEW
    assert review.refusal is None or (review.refusal.endswith(".") and len(review.refusal) <= LONGEST_MESSAGE)
    return review


def check_display(system: System, review: PotentialReview) -> None:
    """Check the energy range, starts and link of an accepted potential."""
    if page_refusal(review) is not None:
        return
    state = ViewState()
    state.show_system(review_for_page(system))
    energies = state.energies
    assert energies.low < energies.first < energies.high
    if review.channels or review.potential.escape_radius is not None:
        assert review.escape_energy < energies.first < review.highest_energy
    else:
        assert review.potential.well.bottom < energies.low < energies.high < review.closed_energy
    # The origin is forbidden only if a body elsewhere has the first energy.
    is_forbidden = state.potential.value(0.0, 0.0) > energies.first
    assert (state.orbit_job((0.0, 0.0)) is None) == is_forbidden
    again, problems = open_link(dict(parse_qsl(write_link(state)[1:])))
    assert problems == []
    assert again.potential == system.potential


@given(term_lists)
def test_a_potential_with_any_terms_is_displayed_or_refused(terms: list[tuple[Any, ...]]) -> None:
    potential = result_or_error(lambda: Potential("any", tuple(terms)), ["terms"])
    if potential is not None:
        reviewed(potential)


@given(formulas)
# A formula that is no polynomial.
@example("r")
def test_any_formula_is_reviewed_or_refused(text: str) -> None:
    potential = result_or_error(lambda: parse_formula(text), ["formula"])
    if potential is not None:
        assert parse_formula(write_formula(potential)).form == potential.form
        check_display(System(TYPED, text), reviewed(potential))


@given(st.integers(0, 2**32))
# A body beside the origin.
@example(52)
def test_a_link_with_a_formula_of_any_kind_is_reviewed_or_refused(seed: int) -> None:
    values, _ = read_link({"case": TYPED, **random_link(random.Random(seed))})
    reviewed_system = result_or_error(lambda: review_for_page(linked_view(values).system), ["formula", *WELL_PARAMETERS])
    if reviewed_system is not None and reviewed_system.refusal is None:
        check_display(reviewed_system.system, reviewed_system)


@given(st.sampled_from(list(WELLS)), *[mostly(st.floats(0.5, 2.0))] * 3)
def test_a_known_potential_with_any_parameters_is_displayed_or_refused(
    name: str, omega_1: Any, omega_2: Any, epsilon: Any
) -> None:
    plain = WELLS[name]
    changed = result_or_error(lambda: plain.with_parameters(omega_1, omega_2, epsilon), WELL_PARAMETERS)
    if changed is not None:
        check_display(
            System(name, "", {"omega_1": float(omega_1), "omega_2": float(omega_2), "epsilon": float(epsilon)}), reviewed(changed)
        )
