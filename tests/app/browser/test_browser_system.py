"""A system for the browser: distinguishable, small, with the default windows."""

from __future__ import annotations

import threading

import numpy as np

from app.browser.browser_system import make_browser_system, system_key
from engine import CASES, Plane, System, default_window
from engine.execution import Execution


def test_windows_between_tabulated_energies_are_nearly_default_windows() -> None:
    system = make_browser_system(CASES["III"], 0.2, 1.0, execution=Execution(cancel=threading.Event()))
    table = system.windows[Plane.X_PX.key]
    for energy in (0.3, 0.45, 0.8):
        window = default_window(CASES["III"], Plane.X_PX, energy)
        edge = np.interp(energy, table["energies"], [edges[1] for edges in table["windows"]])
        assert abs(edge - window.x_high) < 0.01


def test_each_potential_has_its_key() -> None:
    systems = (System("I"), System("II"), System("I", parameters={"epsilon": 1.1}), System("typed", "x²+y²-x²y²"))
    assert len({system_key(system.potential) for system in systems}) == len(systems)
