"""A quick look at a map: coarse, and followed for a short time only, for somebody who passes by."""

from __future__ import annotations

import threading
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from engine.dynamics.fates import Fate
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec

PREVIEW_SIDE = 75
"""Most columns and rows of a preview."""

PREVIEW_TIME = 100.0
"""A preview follows orbits for this long."""


def preview_spec(spec: MapSpec) -> MapSpec:
    """The map that is computed for a quick look at another: its plane, energy and window."""
    columns, rows = (min(side, PREVIEW_SIDE) for side in spec.resolution)
    return replace(spec, resolution=(columns, rows), t_max=min(spec.t_max, PREVIEW_TIME), certify=False)


def compute_preview(spec: MapSpec, executor: Executor | None = None, cancel: threading.Event | None = None) -> EscapeMap:
    """A quick look at a map.

    Parameters
    ----------
    spec
        The request for a preview, from `preview_spec`.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, the work stops within about 0.1 s.

    Returns
    -------
    `EscapeMap`; orbits still inside in the end are `Fate.NOT_COMPUTED`, as so short a time says nothing of them.
    """
    result = compute_map(spec, None, cancel, executor)
    fate = np.where(result.fate == Fate.BOUNDED, Fate.NOT_COMPUTED, result.fate).astype(result.fate.dtype)
    fate.flags.writeable = False
    return replace(result, fate=fate, batch=None, complete=False)
