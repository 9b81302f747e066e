"""Terms are explained where they first stand in a text."""

from __future__ import annotations

import re

import pytest

from app.state.glossary import GLOSSARY, glossary_list, with_terms
from engine import CASES, EscapeMap, MapSpec, compute_basin_entropy, compute_map

BUTTON = re.compile(r"<button[^>]* popovertarget='([^']*)'>([^<]*)</button>")


@pytest.fixture(scope="module")
def escape_map() -> EscapeMap:
    return compute_map(MapSpec(CASES["II"], "x_px", 0.2, (40, 40), t_max=100.0))


@pytest.mark.parametrize("term", GLOSSARY)
def test_a_button_opens_the_meaning_of_a_term(term: str) -> None:
    html = with_terms(f"<b>{term}</b>")
    [(identifier, label)] = BUTTON.findall(html)
    assert label == term
    assert re.search(rf"<span id='{re.escape(identifier)}'[^>]* popover>", html)


def test_only_the_first_place_of_a_term_is_a_button() -> None:
    html = with_terms("<p>Interior starts; of the interior starts</p>")
    assert [label for _, label in BUTTON.findall(html)] == ["Interior starts"]


def test_the_longest_term_is_explained() -> None:
    assert [label for _, label in BUTTON.findall(with_terms("S_bb, and S_b"))] == ["S_bb", "S_b"]


@pytest.mark.parametrize("text", ["<i title='SALI'>x</i>", "SALIent", "uncertified", "no terms"])
def test_other_text_stays_as_it_is(text: str) -> None:
    assert with_terms(text) == text


def test_the_terms_of_the_entropy_are_those_of_the_measure(escape_map: EscapeMap) -> None:
    labels = [label for _, label in BUTTON.findall(with_terms(compute_basin_entropy(escape_map).describe()))]
    assert labels == ["S_b", "S_bb"]


def test_the_list_has_all_terms() -> None:
    assert all(f"<dt>{term}</dt>" in glossary_list() for term in GLOSSARY)
