"""Potentials that cannot be shown are refused with a reason."""

from __future__ import annotations

from engine import POTENTIALS, parse_formula, review_potential
from plots.pictures.palette import MOST_CHANNELS
from plots.texts.accepted_potentials import page_refusal
from tests.channel_family import channel_family

HENON_HEILES = "½(x² + y²) + x²y − y³/3"


def test_more_exits_than_colours_are_rejected() -> None:
    assert "colours" in str(page_refusal(review_potential(channel_family(MOST_CHANNELS + 1))))


def test_an_escape_energy_beyond_the_largest_number_is_refused() -> None:
    assert "energies up to 1e+09" in str(page_refusal(review_potential(parse_formula("(x² + y²)/2 + 1e-7y³"))))


def test_energies_beyond_the_largest_number_are_refused_without_an_escape_energy() -> None:
    review = review_potential(parse_formula("−1e9/√(r² + 0.0001); escape 10"))
    assert "energies up to 1e+09" in str(page_refusal(review))


def test_known_potentials_are_accepted() -> None:
    assert [name for name in POTENTIALS if page_refusal(review_potential(POTENTIALS[name]))] == []
