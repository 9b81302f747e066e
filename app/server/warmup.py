"""Compile the kernels in the background while the server already answers."""

from __future__ import annotations

import gc
import logging
import threading
from collections.abc import Callable, Mapping
from functools import partial

from app.runtime.process_state import ProcessState
from app.views.analysis import statistics
from app.views.orbits import orbit_plots
from engine import CASES, Potential
from engine.integrator.portable_kernels import kernel_module
from engine.warmup import prepare_for_evidence, prepare_for_maps, prepare_kernels, reserve_catalogue

# A child of Bokeh's logger, so that `panel serve` shows the messages.
log = logging.getLogger(f"bokeh.{__name__}")

_PURPOSES: Mapping[str, Callable[[Potential], None]] = {
    "maps": prepare_for_maps,
    "evidence": prepare_for_evidence,
    "orbits and analyses": prepare_kernels,
}


def _prepare_cases(*purposes: str) -> dict[str, Callable[[], object]]:
    """Steps that prepare the three cases for some purposes."""
    return {
        f"the kernels of case {name} for {purpose}": partial(_PURPOSES[purpose], potential)
        for purpose in purposes
        for name, potential in CASES.items()
    }


STEPS: Mapping[str, Callable[[], object]] = {
    **_prepare_cases("maps"),
    "the kernels of browsers": kernel_module,
    **_prepare_cases("evidence", "orbits and analyses"),
    "the panes of an orbit": orbit_plots.prepare,
    "the charts of statistics": statistics.prepare,
    "the integrators of the catalogue, to be compiled when they are needed": reserve_catalogue,
}
"""Functions that compile kernels or load them from the disk cache, by what they prepare, in the order of need."""


def start_warmup(state: ProcessState, steps: Mapping[str, Callable[[], object]] = STEPS) -> threading.Thread:
    """Run the steps in a thread, then set `state.kernels_ready`.

    A failed step ends the thread and sets `state.kernels_failed`. A shutdown ends it before the next step.
    """
    # A daemon thread, because a compilation cannot be cancelled.
    thread = threading.Thread(target=_warm_up, args=(state, steps), name="warmup", daemon=True)
    thread.start()
    return thread


def warm_up(steps: Mapping[str, Callable[[], object]] = STEPS) -> None:
    """Run the steps in this thread, for example to fill the kernel cache of a container image."""
    for name, step in steps.items():
        log.info("preparing %s", name)
        step()


def _warm_up(state: ProcessState, steps: Mapping[str, Callable[[], object]]) -> None:
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
    # Modules, compiled code and defaults live as long as the process, so the garbage collector can skip them.
    gc.freeze()
    state.kernels_ready.set()
    log.info("ready")
