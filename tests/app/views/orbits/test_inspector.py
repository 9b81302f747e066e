"""The inspector hides its parts without orbits, and keeps them."""

from __future__ import annotations

from dataclasses import fields

import pytest

from app.browser.components.orbit_components import OrbitPlayer
from app.state.view_state import ViewState
from app.views.components.collapsible_section import at_once
from app.views.orbits.inspector import Inspector
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot

WITHOUT_ORBITS = "without-orbits"
"""CSS class with which the figures are hidden."""


@pytest.fixture
def inspector() -> Inspector:
    state = ViewState()
    controls = OrbitControls(state, OrbitActions(**{field.name: lambda *_: None for field in fields(OrbitActions)}))
    plots = OrbitPlots(state, lambda interval: None)
    return Inspector(controls, OrbitPlayer(lambda t: None), plots, SeparationPlot(state), at_once)


def test_nothing_is_made_before_the_first_start(inspector: Inspector) -> None:
    before = list(inspector.layout())
    inspector.follow(0, 0)
    assert list(inspector.layout()) == before
    inspector.follow(1, 1)
    assert len(inspector.layout()) > len(before)


def test_parts_stay_on_the_page_when_the_orbits_are_removed(inspector: Inspector) -> None:
    inspector.follow(2, 2)
    parts = list(inspector.layout())
    head = parts[0]
    assert head.visible
    assert WITHOUT_ORBITS not in inspector.layout().css_classes
    inspector.follow(0, 0)
    assert list(inspector.layout()) == parts
    assert not head.visible
    assert WITHOUT_ORBITS in inspector.layout().css_classes
    inspector.follow(1, 1)
    assert head.visible
    assert WITHOUT_ORBITS not in inspector.layout().css_classes


def test_a_start_without_an_orbit_has_a_verdict_but_no_figures(inspector: Inspector) -> None:
    inspector.follow(1, 1)
    inspector.follow(1, 0)
    assert next(iter(inspector.layout())).visible
    assert WITHOUT_ORBITS in inspector.layout().css_classes
