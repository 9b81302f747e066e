"""The inspector shows what the number of orbits needs."""

from __future__ import annotations

from dataclasses import fields

from app.views.components.plots import FigurePane
from app.views.orbits.inspector import Inspector
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot


def make_inspector() -> Inspector:
    nothing = OrbitActions(*[lambda *_: None] * len(fields(OrbitActions)))
    return Inspector(OrbitControls(nothing), Playback(lambda t: None), OrbitPlots(lambda interval: None), SeparationPlot())


def shown_parts(inspector: Inspector) -> int:
    """How many parts are shown."""
    parts = inspector.layout().objects
    return sum((part.object if isinstance(part, FigurePane) else part).visible for part in parts)


def test_values_and_plots_are_shown_and_hidden_with_the_orbits() -> None:
    inspector = make_inspector()
    shown = []
    for orbits in (0, 1, 2, 5, 0, 1):
        inspector.follow(orbits, orbits)
        shown.append(shown_parts(inspector))
    # One column of values and four plots of an orbit.
    entry = shown[0]
    assert [count - entry for count in shown] == [0, 5, 5, 5, 0, 5]


def test_what_was_shown_once_stays_on_the_page() -> None:
    inspector = make_inspector()
    inspector.follow(2, 2)
    parts = inspector.layout().objects
    for orbits in (0, 1, 2):
        inspector.follow(orbits, orbits)
        assert inspector.layout().objects == parts


def test_a_start_without_an_orbit_has_values_but_no_plots() -> None:
    inspector = make_inspector()
    before = shown_parts(inspector)
    inspector.follow(1, 0)
    assert shown_parts(inspector) == before + 1
    inspector.follow(2, 1)
    assert shown_parts(inspector) == before + 5
