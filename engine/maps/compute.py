"""Computation of escape maps: all pixels at once, or in blocks of rows where memory requires it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.maps.parameter_map import LineStack
from engine.maps.result import PIXEL_ARRAYS, EscapeMap
from engine.maps.row_blocks import row_blocks
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.trust import compute_trust, estimate_rounded_share
from engine.propagation.fates import Fate

LARGEST_RUN = 2**20
"""Largest number of pixels whose orbits are in memory together; larger maps are computed in blocks of rows, without resume."""

DEEP_PIXEL = 1e-7
"""Distance of pixels in units of the well below which a map says how many of them double precision does not support."""

_MIN_PAUSE, _MAX_PAUSE = 0.1, 1.0
# Pause between frames as a share of the time elapsed.
_PAUSE_SHARE = 0.3


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
    if spec.plane.parameter is not None:
        result = _run_stages(LineStack(spec, resume, keeps_states=_fits_memory(spec)), part, on_frame)
    else:
        well_spec, earlier = spec.in_well_units(), resume.in_well_units() if resume is not None else None
        publish = None if on_frame is None else lambda frame: on_frame(frame.restored(spec))
        if _fits_memory(spec):
            result = _run_stages(MapRun(well_spec, earlier, coarse_first=on_frame is not None), part, publish)
        else:
            result = _compute_in_blocks(well_spec, part, publish)
        result = result.restored(spec)
    if not (with_trust and result.complete):
        return result
    return replace(result, trust=compute_trust(result, execution=execution.part(1, 2)).trust)


def _fits_memory(spec: MapSpec) -> bool:
    """Whether the states of all orbits are kept in memory."""
    return spec.resolution[0] * spec.resolution[1] <= LARGEST_RUN


def _check_resumable(spec: MapSpec, resume: EscapeMap) -> None:
    if resume.batch is None:
        raise ValueError("resume: this map has no integration state; must be a map returned by compute_map, not a frame")
    if replace(resume.spec, t_max=spec.t_max) != spec or resume.spec.t_max > spec.t_max:
        raise ValueError(f"resume: a map of {resume.spec} cannot be continued to {spec}; must be equal but for a smaller t_max")


def _run_stages(run: MapRun | LineStack, execution: Execution, on_frame: Callable[[EscapeMap], None] | None) -> EscapeMap:
    throttle = _FrameThrottle(run, on_frame) if on_frame is not None else None

    def publish(stage_over: bool) -> None:
        if throttle is not None:
            throttle(stage_over)
        execution.report(run.progress)

    run.run(execution, publish)
    result = _with_rounded_share(run.result(), execution)
    if on_frame is None:
        return result
    if result.complete:
        on_frame(replace(result, batch=None))
    return result


def _with_rounded_share(result: EscapeMap, execution: Execution) -> EscapeMap:
    """A map in units of the well, in a deep zoom with the share of pixels that double precision does not support."""
    pixels = (np.ptp(axis) / max(axis.size - 1, 1) for axis in (result.x, result.ordinate))
    is_deep = result.spec.plane.parameter is None and 0.0 < min(pixels) < DEEP_PIXEL
    if not (result.complete and is_deep):
        return result
    share = estimate_rounded_share(result, replace(execution, on_progress=None))
    return result if execution.is_cancelled else replace(result, rounded_share=share)


class _FrameThrottle:
    """Progress callback of a run that publishes incomplete frames, with growing pauses between them."""

    def __init__(self, run: MapRun | LineStack, on_frame: Callable[[EscapeMap], None]) -> None:
        self._run, self._on_frame = run, on_frame
        self._started = time.monotonic()
        self._next_frame: float | None = None

    def __call__(self, stage_over: bool) -> None:
        now = time.monotonic()
        # The first frame is published when the coarsest stage is over.
        is_due = stage_over if self._next_frame is None else now >= self._next_frame
        if not is_due:
            return
        frame = self._run.frame()
        if not frame.complete:
            self._on_frame(frame)
            self._next_frame = time.monotonic() + frame_pause(now - self._started)


def frame_pause(elapsed: float) -> float:
    """Pause in seconds after a frame, given the time in seconds since the start of the computation."""
    return min(max(_MIN_PAUSE, _PAUSE_SHARE * elapsed), _MAX_PAUSE)


def _compute_in_blocks(spec: MapSpec, execution: Execution, on_frame: Callable[[EscapeMap], None] | None) -> EscapeMap:
    whole = _empty_map(spec)
    rows_done = 0
    for rows in row_blocks(spec, LARGEST_RUN):
        run = MapRun(spec, rows=rows)
        run.run(execution)
        block = run.frame()
        for name in PIXEL_ARRAYS:
            getattr(whole, name)[rows] = getattr(block, name)
        rows_done += rows.size
        cancelled = execution.is_cancelled
        whole = replace(whole, progress=rows_done / spec.resolution[1], horizon=block.horizon)
        if cancelled:
            break
        if on_frame is not None:
            on_frame(_read_only_views(whole))
        execution.report(partial(getattr, whole, "progress"))
    result = replace(_read_only_views(whole), complete=not np.any(whole.fate == Fate.NOT_COMPUTED))
    return _with_rounded_share(result, execution)


def _empty_map(spec: MapSpec) -> EscapeMap:
    """A map without any computed pixels, whose arrays can be written."""
    x, ordinate = spec.pixel_centres()
    arrays: dict[str, Any] = {
        name: np.full((ordinate.size, x.size), value, dtype) for name, (dtype, value) in PIXEL_ARRAYS.items()
    }
    return EscapeMap(spec, x, ordinate, stride=1, horizon=0.0, progress=0.0, complete=False, **arrays)


def _read_only_views(escape_map: EscapeMap) -> EscapeMap:
    """The same map with read-only views of its arrays; copies would need too much memory."""
    views: dict[str, Any] = {name: read_only(getattr(escape_map, name).view()) for name in PIXEL_ARRAYS}
    return replace(escape_map, **views)
