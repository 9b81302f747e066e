"""The plots of the chosen orbits."""

from __future__ import annotations

import numpy as np

from app.views.orbits.orbit_plots import OrbitPlots
from engine import CASES, Plane, integrate_orbit, start_states
from plots.orbit_curves import compute_orbit_curves


def test_the_exits_are_those_of_the_potential_of_the_orbit() -> None:
    plots, exits = OrbitPlots(lambda interval: None), []
    for case, energy in (("I", 0.19), ("III", 0.3)):
        [start] = start_states(CASES[case], Plane.X_PX, energy, np.array([0.1]), np.array([0.0]))
        orbit = integrate_orbit(CASES[case], start, 10.0)
        plots.show([compute_orbit_curves(CASES[case], orbit)], 0)
        exits.append(len(plots.outlines._exits.data["xs"]))
    assert exits == [2, 4]
