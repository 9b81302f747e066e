"""The inspector shows what the number of orbits needs."""

from __future__ import annotations

from dataclasses import fields

from app.views.orbits.inspector import Inspector
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot


def make_inspector() -> Inspector:
    nothing = OrbitActions(*[lambda *_: None] * len(fields(OrbitActions)))
    return Inspector(OrbitControls(nothing), Playback(lambda t: None), OrbitPlots(lambda interval: None), SeparationPlot())


def test_values_and_plots_are_added_and_removed_with_the_orbits() -> None:
    inspector = make_inspector()
    shown = []
    for orbits in (0, 1, 2, 5, 0):
        inspector.follow(orbits, orbits)
        shown.append(len(inspector.layout().objects))
    # Head, three plots of an orbit, one of two, values to unfold, and verdicts: the same for any number of orbits.
    entry = shown[0]
    assert [count - entry for count in shown] == [0, 8, 8, 8, 0]


def test_a_start_without_an_orbit_has_values_but_no_plots() -> None:
    inspector = make_inspector()
    before = len(inspector.layout().objects)
    inspector.follow(1, 0)
    assert len(inspector.layout().objects) == before + 4
    inspector.follow(2, 1)
    assert len(inspector.layout().objects) == before + 8
