"""Any link gives a valid view state. Invalid values are reported in messages that are safe to display."""

from __future__ import annotations

import random
import re
import time
import warnings
from functools import partial
from typing import Any
from urllib.parse import parse_qsl

from hypothesis import given
from hypothesis import strategies as st

from app.session.page import link_sentence, link_title
from app.state.permalink import LINKED, linked_view, read_link, write_link
from app.state.view_state import ViewState
from engine import CASES
from engine.systems.system import TYPED
from tests.app.state.opened_link import open_link
from tests.fuzz.hostile import LONGEST_MESSAGE, STRINGS, floats, formulas, result_or_error, texts
from tests.fuzz.random_formulas import random_link

NAMES = (
    "case", "plane", "h", "t_max", "resolution", "window", "box", "judge", "trust", "manifolds", "origins", "measures",
    "energies", "palette", "orbits", "look", "V", "omega_1", "omega_2", "epsilon", "__class__", "utm_source", "",
)  # fmt: skip
LEGAL = {
    "case": "II", "plane": "x_y", "h": "0.2", "t_max": "1000", "resolution": "224", "window": "-1,1,-1,1", "orbits": "0.1,0.2",
}  # fmt: skip
SAFE = re.compile(r"[A-Za-z0-9_ .,;:+()=?…-]*")
LONGEST_READING = 0.1
"""Longest processor time to read a link, in seconds. Links are read on the event loop."""
POTENTIAL_PROBLEM = "Ignored the potential in the link: "

numbers = floats.map(repr) | st.sampled_from(["1e999", "-inf", "1_0", "0x10", "١", " 1", "1e-400", "9" * 400])
number_lists = st.lists(numbers, min_size=1, max_size=6).map(",".join)
values = texts | formulas | st.sampled_from(STRINGS) | numbers | number_lists | st.lists(number_lists, max_size=7).map(";".join)
attribute_values = (
    floats | texts | st.none() | st.tuples(floats, floats) | st.lists(st.tuples(floats, floats), max_size=7).map(tuple)
)
links = st.dictionaries(st.sampled_from(NAMES), values, max_size=5)


def check(parameters: dict[str, str]) -> None:
    assert set(read_link(parameters)[0]) <= set(LINKED)
    state, problems = open_link(parameters)
    for problem in problems:
        # A message about a formula quotes the formula, which the page escapes.
        if not problem.startswith(POTENTIAL_PROBLEM):
            assert SAFE.fullmatch(problem), problem
        assert len(problem) <= LONGEST_MESSAGE
    assert len(problems) <= len(parameters) + 1
    assert state.potential.channels or state.reviewed.closed_energy > state.energies.high
    assert state.energies.low < state.energies.first < state.energies.high
    # The kernels of other systems would have to be compiled first.
    if state.system.case in CASES and not state.system.parameters:
        result_or_error(state.map_spec, ["energy", "window", "plane", "t_max", "resolution"])
    assert len(link_sentence(linked_view(read_link(parameters)[0]))) <= LONGEST_MESSAGE
    for start in state.starts:
        job = result_or_error(partial(state.orbit_job, start), ["energy", "x", "ordinate", "start", "starts"])
        assert job is None or state.plane.parameter is not None or len(job.arguments[1]) == 4
    assert open_link(dict(parse_qsl(write_link(state)[1:])))[1] == []


@given(links)
def test_any_link_gives_a_legal_view(parameters: dict[str, str]) -> None:
    check(parameters)


@given(st.sampled_from([name for name in NAMES if name]), values)
def test_one_arbitrary_value_in_a_link_gives_a_legal_view(name: str, value: str) -> None:
    check({**LEGAL, name: value})


@given(formulas, st.dictionaries(st.sampled_from(["case", "omega_1", "omega_2", "epsilon", "h", "orbits"]), values, max_size=3))
def test_any_formula_in_a_link_gives_a_legal_view(formula: str, others: dict[str, str]) -> None:
    check({"case": TYPED, **others, "V": formula})


@given(st.integers(0, 2**32))
def test_a_formula_of_any_kind_is_read_at_once(seed: int) -> None:
    link = {"case": TYPED, **random_link(random.Random(seed))}
    begin = time.thread_time()
    values, problems = read_link(link)
    view = linked_view(values)
    assert max(map(len, [link_sentence(view), link_title(view), *problems])) <= LONGEST_MESSAGE
    assert time.thread_time() - begin < LONGEST_READING


@given(st.sampled_from([name for name in LINKED if name != "system"]), attribute_values)
def test_view_state_accepts_only_valid_values(name: str, value: Any) -> None:
    state = ViewState()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            setattr(state, name, value)
    except (ValueError, TypeError):
        return
    result_or_error(state.map_spec, ["energy", "window", "plane", "t_max", "resolution"])
    for start in state.starts:
        result_or_error(partial(state.orbit_job, start), ["energy", "x", "ordinate", "start", "starts"])
    write_link(state)
