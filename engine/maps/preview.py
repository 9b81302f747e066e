"""Previews of maps: coarse, and with a short integration time."""

from __future__ import annotations

import threading
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from engine.dynamics.fates import Fate
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.results.arrays import read_only

PREVIEW_SIDE = 76
"""Largest number of columns or rows of a preview."""

PREVIEW_TIME = 100.0
"""Longest integration time of a preview, in units of the well."""


def preview_spec(spec: MapSpec) -> MapSpec:
    """The request for a preview of a map: the same plane, energy and window, coarser and shorter."""
    columns, rows = (min(side, PREVIEW_SIDE) for side in spec.resolution)
    return replace(
        spec, resolution=(columns, rows), t_max=min(spec.t_max, PREVIEW_TIME * spec.potential.units.time), certify=False
    )


def compute_preview(spec: MapSpec, executor: Executor | None = None, cancel: threading.Event | None = None) -> EscapeMap:
    """Compute the preview of a map.

    Parameters
    ----------
    spec
        The request for the preview, from `preview_spec`.
    executor
        Any `concurrent.futures.Executor`; None for the default pool of this process.
    cancel
        When set, the work stops within about 0.1 s.

    Returns
    -------
    `EscapeMap`; orbits that have not escaped by the end are `Fate.NOT_COMPUTED`, as the integration time is too short to call
    them bounded.
    """
    result = compute_map(spec, None, cancel, executor)
    fate = np.where(result.fate == Fate.BOUNDED, Fate.NOT_COMPUTED, result.fate).astype(result.fate.dtype)
    return replace(result, fate=read_only(fate), batch=None, complete=False)
