"""Computation of escape maps: all pixels at once, or in blocks of rows where memory requires it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import fields, replace
from typing import Any

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checks_types
from engine.maps.parameter_map import LineStack
from engine.maps.result import EscapeMap
from engine.maps.rounded_share import estimate_rounded_share
from engine.maps.row_blocks import BlockStack
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import run_stages

LARGEST_RUN = 2**20
"""Largest number of pixels whose orbits are in memory together; larger maps are computed in blocks of rows, without resume."""

DEEP_PIXEL = 1e-7
"""Distance of pixels in units of the well below which a map says how many of them double precision does not support."""


@shows_progress("escape map")
@checks_types(spec=MapSpec, resume=(EscapeMap, type(None)), on_frame=(Callable, type(None)), execution=Execution)
def compute_map(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    resume: EscapeMap | None = None,
    on_progress: Callable[[float], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> EscapeMap:
    """Compute an escape map.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with the map so far, at increasing intervals: first coarse, then at full resolution, then with
        longer integration times. A map of more than 2²⁰ pixels is filled block by block.
    cancel, executor, on_progress
        Fields of `execution`, which they replace where they are given: ``execution=Execution(executor, cancel)`` is the way
        of all long functions. They stay legal.
    resume
        An earlier map, complete or cancelled, whose spec differs at most by a smaller t_max: its orbits are continued. Maps
        computed in blocks cannot be resumed.
    execution
        How the computation runs. When it is cancelled, the map is returned as it is, with ``complete`` False.

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
    given: dict[str, Any] = {"cancel": cancel, "executor": executor, "on_progress": on_progress}
    execution = replace(execution, **{name: value for name, value in given.items() if value is not None})
    if resume is not None:
        _check_resumable(spec, resume)
    work = _begin(spec, resume, coarse_first=on_frame is not None)
    run_stages(work, execution, None if on_frame is None else lambda frame: on_frame(_in_units_of(spec, frame)))
    result = _in_units_of(spec, _with_rounded_share(work.result(), execution))
    if on_frame is not None and result.complete:
        on_frame(replace(result, batch=None))
    return result


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
