"""Kernels compiled in the background, while the server already answers."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from functools import partial

from app.runtime.process_state import ProcessState
from app.views.orbits import orbit_plots
from engine import CASES, prepare_kernels

# Below Bokeh's logger, so that `panel serve` shows it: the first start takes long enough to want a word.
log = logging.getLogger(f"bokeh.{__name__}")

STEPS: Mapping[str, Callable[[], None]] = {
    **{f"the kernels of case {name}": partial(prepare_kernels, potential) for name, potential in CASES.items()},
    "the panes of an orbit": orbit_plots.prepare,
}
"""What has to be compiled, or loaded from the cache, before the first visitor is served without a wait."""


def prepare_in_background(site: ProcessState, steps: Mapping[str, Callable[[], None]] = STEPS) -> threading.Thread:
    """Take the steps one after another in a thread of their own, then call the site prepared.

    A step that fails ends it, and the site has failed; so does a stop of the server, between two steps.
    """
    # A daemon: nobody waits for a compiler when the server is to stop.
    thread = threading.Thread(target=_prepare, args=(site, steps), name="preparation", daemon=True)
    thread.start()
    return thread


def prepare_now(steps: Mapping[str, Callable[[], None]] = STEPS) -> None:
    """Take the steps here and now, as for an image of a container that is to start without compiling."""
    for name, step in steps.items():
        log.info("preparing %s", name)
        step()


def _prepare(site: ProcessState, steps: Mapping[str, Callable[[], None]]) -> None:
    for name, step in steps.items():
        if site.stopping.is_set():
            return
        log.info("preparing %s", name)
        try:
            step()
        except Exception:
            log.exception("%s could not be prepared", name)
            site.failed.set()
            return
    site.prepared.set()
    log.info("ready")
