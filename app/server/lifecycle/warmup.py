"""Compilation of the kernels in the background, while the server already answers."""

from __future__ import annotations

import gc
import logging
import threading
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from app.runtime.process_state import ProcessState
from app.views.components import histograms
from app.views.orbits import orbit_plots
from engine import CASES, Potential, integrate_orbit, start_states
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.jobs.job import run_job
from engine.maps.warmup import (
    call_after_maps,
    prepare_for_evidence,
    prepare_for_maps,
    reserve_catalogue,
    small_map,
)
from engine.slices.planes import SECTION
from plots.browser.compiled_files import browser_kernels
from plots.layers.table import LAYERS

# A child of Bokeh's logger, so that `panel serve` shows the messages.
log = logging.getLogger(f"bokeh.{__name__}")


def prepare_for_orbits(potential: Potential) -> None:
    """Compile the kernels of single orbits, or load them from the cache."""
    start = start_states(potential, SECTION, potential.well.energy_at(0.5), np.zeros(1), np.zeros(1))[0]
    # Any short orbit compiles the kernels.
    call_after_maps(lambda: integrate_orbit(potential, start, 10.0 * potential.units.time))


def prepare_for_layers(potential: Potential) -> None:
    """Compile the kernels of the layers, or load them from the cache."""
    execution = DEFAULT_EXECUTION.in_this_thread()
    # A count of 1 is enough to compile the kernels.
    settings = {name: 1 for name, layer in LAYERS.items() if layer.count is not None}
    # Some layers concern escaping orbits, which exist above the escape energy only, and others concern bounded orbits.
    for spec in (small_map(potential, potential.well.energy_at(multiple)) for multiple in (0.5, 1.01)):
        jobs = [layer.job(spec, settings) for layer in LAYERS.values() if not layer.refusal(spec)]
        call_after_maps(*(partial(run_job, job, execution, {}) for job in jobs))


_PREPARATIONS: Mapping[str, Callable[[Potential], None]] = {
    "maps": prepare_for_maps,
    "evidence": prepare_for_evidence,
    "orbits": prepare_for_orbits,
    "layers": prepare_for_layers,
}


def _prepare_cases(*purposes: str) -> dict[str, Callable[[], object]]:
    """Return the steps that prepare all cases of the paper for some purposes."""
    return {
        f"the kernels of case {name} for {purpose}": partial(_PREPARATIONS[purpose], potential)
        for purpose in purposes
        for name, potential in CASES.items()
    }


STEPS: Mapping[str, Callable[[], object]] = {
    **_prepare_cases("maps"),
    "the kernels of browsers": browser_kernels,
    **_prepare_cases("evidence", "orbits", "layers"),
    "the panes of an orbit": orbit_plots.prepare,
    "the histograms": histograms.prepare,
    "the integrators of the catalogue, to be compiled when they are needed": reserve_catalogue,
}
"""Functions that compile kernels or load them from the disk cache, by what they prepare, in the order in which it is needed."""


def start_warmup(state: ProcessState, steps: Mapping[str, Callable[[], object]] = STEPS) -> threading.Thread:
    """Run the steps in a thread, then set `state.kernels_ready`.

    A failed step ends the thread and sets `state.kernels_failed`. A shutdown ends the thread before the next step.
    """
    # A daemon thread does not keep the process alive: a compilation cannot be cancelled.
    thread = threading.Thread(target=_warm_up_server, args=(state, steps), name="warmup", daemon=True)
    thread.start()
    return thread


def warm_up() -> None:
    """Run the steps in this thread, to fill the kernel cache of a container image."""
    for name, step in STEPS.items():
        log.info("preparing %s", name)
        step()


def _warm_up_server(state: ProcessState, steps: Mapping[str, Callable[[], object]]) -> None:
    for name, step in steps.items():
        if state.stopping.is_set():
            return
        log.info("preparing %s", name)
        try:
            step()
        except Exception:
            log.exception("%s could not be prepared", name)
            state.kernels_failed.set()
            return
    # Modules and compiled code exist as long as the process, so the garbage collector can skip them.
    gc.freeze()
    state.kernels_ready.set()
    log.info("ready")
