"""Before the first visitor: compile the kernels, or load them from the cache."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np

from app.paper_energies import ENERGIES
from app.views import orbit_panes
from engine import CASES, MapSpec, Plane, compute_map, integrate_orbit, start_states

# Below Bokeh's logger, so that `panel serve` shows it: the first start takes long enough to want a word.
log = logging.getLogger(f"bokeh.{__name__}")


def on_server_loaded(_context: Any) -> None:
    """Run every kernel of every case once; the first time on a machine that takes some seconds a case."""
    for name, potential in CASES.items():
        log.info("preparing the kernels of case %s", name)
        energy = ENERGIES[name].first
        compute_map(MapSpec(potential, Plane.X_PX, energy, (2, 2), t_max=10.0))
        integrate_orbit(potential, start_states(potential, Plane.X_PX, energy, np.zeros(1), np.zeros(1))[0], 10.0)
    orbit_panes.prepare()
    log.info("ready")
