"""The plots on the page depend on the number of orbits."""

from __future__ import annotations

from app.views.orbits.orbit_layout import OrbitLayout
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.separation_plot import SeparationPlot


def test_plots_are_added_and_removed_with_the_orbits() -> None:
    row = OrbitLayout(OrbitPlots(), SeparationPlot())
    shown = []
    for orbits in (0, 1, 2, 5, 0):
        row.follow(orbits)
        shown.append(len(row.layout().objects))
    assert shown == [0, 4, 5, 5, 0]
