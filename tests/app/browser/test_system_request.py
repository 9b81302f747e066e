"""A system for the browser: distinguishable, small, with the default windows."""

from __future__ import annotations

import numpy as np
from app.browser.system_request import BrowserSystemRequest, system_key
from app.state.system import System

from engine import CASES, Plane, default_window
from engine.service import Jobs
from tests.engine.jobs.inbox import Inbox


def test_windows_between_tabulated_energies_are_nearly_default_windows() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(BrowserSystemRequest(CASES["III"], 0.2, 1.0), inbox.result, inbox.error)
    assert inbox.done.wait(60)
    table = inbox.results[0].windows[Plane.X_PX.name]
    for energy in (0.3, 0.45, 0.8):
        window = default_window(CASES["III"], Plane.X_PX, energy)
        edge = np.interp(energy, table["energies"], [edges[1] for edges in table["windows"]])
        assert abs(edge - window.x_high) < 0.01


def test_each_potential_has_its_key() -> None:
    systems = (System("I"), System("II"), System("I", epsilon=1.1), System("typed", "x²+y²-x²y²"))
    assert len({system_key(system.potential) for system in systems}) == len(systems)
