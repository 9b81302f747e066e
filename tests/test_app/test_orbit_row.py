"""Panes come with the orbits that they need."""

from __future__ import annotations

from app.views.orbit_panes import OrbitPanes
from app.views.orbit_row import OrbitRow
from app.views.separation_pane import SeparationPane


def test_panes_come_and_go_with_the_orbits() -> None:
    row = OrbitRow(OrbitPanes(), SeparationPane())
    shown = []
    for orbits in (0, 1, 2, 5, 0):
        row.follow(orbits)
        shown.append(len(row.layout().objects))
    assert shown == [3, 4, 5, 5, 3]
