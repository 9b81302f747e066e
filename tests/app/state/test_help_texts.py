"""Every picture and plot has a short help text."""

from __future__ import annotations

import re

import pytest

from app.state.help_texts import HELP_TEXTS, title_with_help
from app.views.maps.map_plots import MAPS
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES
from plots.pictures.sweep_panels import CURVE_PANELS


def test_every_picture_plot_and_measure_has_a_help_text() -> None:
    plots = {
        *(quantity.name for quantity in ORBIT_QUANTITIES),
        "separation",
        "histogram",
        "probabilities",
        "uncertainty",
        "survival",
        "watch",
        "shares",
        *(panel.name for panel in CURVE_PANELS),
    }
    assert {"well", *MAPS} | plots <= set(HELP_TEXTS)


@pytest.mark.parametrize("name", HELP_TEXTS)
def test_a_help_text_is_two_to_four_sentences(name: str) -> None:
    text = HELP_TEXTS[name]
    assert 2 <= len(re.split(r"(?<=\.) ", text)) <= 4
    assert text.endswith(".")


def test_a_title_has_a_button_that_opens_its_help_text() -> None:
    html = title_with_help("A < B", "basins")
    assert re.search(r"<button[^>]* popovertarget='help-basins' aria-label='About: A &lt; B'>", html)
    assert html.count(HELP_TEXTS["basins"]) == 1
    assert re.search(r"<p id='help-basins'[^>]* popover>", html)
