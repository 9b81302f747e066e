"""The texts of the tour are short, and name what the page has."""

from __future__ import annotations

import re

import pytest

from app.state.tour import TOUR, TourStep

WORDS = 45
"""Largest number of words of a text, which a small box holds."""


@pytest.mark.parametrize("step", TOUR, ids=lambda step: step.title)
def test_a_step_has_at_most_two_short_sentences_about_at_least_one_part(step: TourStep) -> None:
    assert 1 <= len(re.findall(r"[.?!](?:\s|$)", step.text)) <= 2
    assert len(step.text.split()) <= WORDS
    assert step.about
