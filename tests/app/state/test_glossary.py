"""Terms are explained where they first occur in a text."""

from __future__ import annotations

import re

import pytest

from app.state.glossary import GLOSSARY, with_terms

BUTTON = re.compile(r"<button[^>]* popovertarget='([^']*)'>([^<]*)</button>")


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


@pytest.mark.parametrize("text", ["<i title='SALI'>x</i>", "SALIent", "on evidences", "no terms"])
def test_other_text_stays_as_it_is(text: str) -> None:
    assert with_terms(text) == text
