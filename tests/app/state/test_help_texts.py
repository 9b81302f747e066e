"""Every picture and plot has a short help text."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from app.state.help_texts import HELP_TEXTS, help_details
from app.views.analysis.energy_curves import TITLES as CURVES
from app.views.maps.map_plots import TITLES


def test_every_picture_has_a_help_text() -> None:
    assert set(TITLES) <= set(HELP_TEXTS)


def test_every_plot_has_a_help_text() -> None:
    assert {"path", "sali", "r2", "distance", "histogram", "probabilities"} <= set(HELP_TEXTS)


def test_every_measure_has_a_help_text() -> None:
    assert {"uncertainty", "survival", *CURVES} <= set(HELP_TEXTS)


@pytest.mark.parametrize("name", HELP_TEXTS)
def test_a_help_text_is_two_to_four_sentences(name: str) -> None:
    text = HELP_TEXTS[name]
    assert 2 <= len(re.split(r"(?<=\.) ", text)) <= 4
    assert text.endswith(".")


@pytest.mark.parametrize("name", HELP_TEXTS)
def test_help_is_a_disclosure_widget(name: str) -> None:
    details = ElementTree.fromstring(help_details(name))
    assert details.tag == "details"
    assert details.findtext("summary") == "What is this?"
    assert details.findtext("p") == HELP_TEXTS[name]


def test_help_inherits_its_colours() -> None:
    assert not re.search(r"#[0-9a-f]{3}|rgb|background", help_details("basins"), re.IGNORECASE)
