"""Computation of escape maps: all pixels at once, or in blocks of rows where memory requires it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import fields, replace

import numpy as np

from engine.foundations.execution import Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.maps.parameter_map import LineStack
from engine.maps.result import EscapeMap
from engine.maps.row_blocks import BlockStack
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import run_stages
from engine.maps.trust import compute_trust, estimate_rounded_share

LARGEST_RUN = 2**20
"""Largest number of pixels whose orbits are in memory together; larger maps are computed in blocks of rows, without resume."""

DEEP_PIXEL = 1e-7
"""Distance of pixels in units of the well below which a map says how many of them double precision does not support."""


@checks_types(spec=MapSpec, resume=(EscapeMap, type(None)), on_frame=(Callable, type(None)))
def compute_map(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    resume: EscapeMap | None = None,
    with_trust: bool = False,
    on_progress: Callable[[float], None] | None = None,
) -> EscapeMap:
    """Compute an escape map.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with the map so far, at increasing intervals (`frame_pause`): first coarse, then at full
        resolution, then with longer integration times. A map of more than `LARGEST_RUN` pixels is filled block by block.
    cancel
        When set, the map is returned as it is within about 0.1 s, with ``complete`` False.
    executor
        Any `concurrent.futures.Executor`; None for the default pool of this process.
    resume
        An earlier map, complete or cancelled, whose spec differs at most by a smaller t_max: its orbits are continued. Maps
        computed in blocks cannot be resumed.
    with_trust
        Whether to compute the reliability of each pixel as well (`compute_trust`) once the map is complete; when cancelled,
        pixels not tested yet are `Trust.NOT_TESTED`.
    on_progress
        Called in this thread with the share done, 0 to 1. None for a progress bar in a terminal or a notebook.

    Returns
    -------
    `EscapeMap`; a complete one has arrays that are bit-identical for every executor, interruption and resumption.

    Raises
    ------
    ValueError
        When `resume` belongs to another map, or no exit is defined at an energy of `spec`.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map
    >>> escapes = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 40), t_max=1e3))
    >>> escapes.complete, round(sum(escapes.fractions().values()), 12)
    (True, 1.0)
    """
    return run_map(spec, Execution(executor, cancel, on_progress), on_frame, resume=resume, with_trust=with_trust)


@shows_progress("escape map")
def run_map(
    spec: MapSpec,
    execution: Execution,
    on_frame: Callable[[EscapeMap], None] | None = None,
    *,
    resume: EscapeMap | None = None,
    with_trust: bool = False,
) -> EscapeMap:
    """`compute_map` with its execution as one object."""
    if resume is not None:
        _check_resumable(spec, resume)
    part = execution.part(0, 2) if with_trust else execution
    work = _begin(spec, resume, coarse_first=on_frame is not None)
    run_stages(work, part, None if on_frame is None else lambda frame: on_frame(_in_units_of(spec, frame)))
    result = _in_units_of(spec, _with_rounded_share(work.result(), part))
    if on_frame is not None and result.complete:
        on_frame(replace(result, batch=None))
    if not (with_trust and result.complete):
        return result
    return replace(result, trust=compute_trust(result, execution=execution.part(1, 2)).trust)


def _begin(spec: MapSpec, resume: EscapeMap | None, *, coarse_first: bool) -> MapRun | LineStack | BlockStack:
    """What computes a map; in units of the well unless it is one along a parameter."""
    keeps_states = spec.resolution[0] * spec.resolution[1] <= LARGEST_RUN
    if spec.plane.parameter is not None:
        return LineStack(spec, resume, keeps_states=keeps_states)
    if not keeps_states:
        return BlockStack(spec.in_well_units(), LARGEST_RUN)
    earlier = None if resume is None else resume.in_well_units()
    return MapRun(spec.in_well_units(), earlier, coarse_first=coarse_first)


def _in_units_of(spec: MapSpec, found: EscapeMap) -> EscapeMap:
    """A map of `_begin` in the units of its request."""
    return found if spec.plane.parameter is not None else found.restored(spec)


def _check_resumable(spec: MapSpec, resume: EscapeMap) -> None:
    if resume.batch is None:
        raise ValueError("resume: this map has no integration state; must be a map returned by compute_map, not a frame")
    different = [field.name for field in fields(spec) if getattr(resume.spec, field.name) != getattr(spec, field.name)]
    if different not in ([], ["t_max"]) or resume.spec.t_max > spec.t_max:
        raise ValueError(f"resume: a map with another {', '.join(different)}; must be equal but for a smaller t_max")


def _with_rounded_share(result: EscapeMap, execution: Execution) -> EscapeMap:
    """A map in units of the well, in a deep zoom with the share of pixels that double precision does not support."""
    pixels = (np.ptp(axis) / max(axis.size - 1, 1) for axis in (result.x, result.ordinate))
    is_deep = result.spec.plane.parameter is None and 0.0 < min(pixels) < DEEP_PIXEL
    if not (result.complete and is_deep):
        return result
    share = estimate_rounded_share(result, replace(execution, on_progress=None))
    return result if execution.is_cancelled else replace(result, rounded_share=share)
