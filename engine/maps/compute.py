"""Maps of escapes, computed: at once, or band by band where memory asks for it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

import numpy as np

from engine.dynamics.fates import Fate
from engine.execution import is_cancelled
from engine.maps.result import IMAGES, EscapeMap
from engine.maps.row_blocks import row_blocks
from engine.maps.run import MapRun, carry_through
from engine.maps.spec import MapSpec
from engine.maps.trust import compute_trust

LARGEST_RUN = 2**20
"""Most pixels whose orbits are held in memory at once; larger maps are computed in bands of rows, which keep results only."""

_SHORTEST_PAUSE, _LONGEST_PAUSE = 0.1, 1.0
# Of the time that has passed, the share that one frame lasts.
_PAUSE_SHARE = 0.3


def compute_map(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    resume: EscapeMap | None = None,
    with_trust: bool = False,
) -> EscapeMap:
    """Compute a map of escapes.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with the map so far, often at first: coarse pixels first, then all, then longer horizons
        (`frame_pause`). A map of more than `LARGEST_RUN` pixels comes band by band.
    cancel
        When set, the map is returned as it is within about 0.1 s, with ``complete`` False.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    resume
        An earlier map, finished or cancelled, whose spec differs at most by a smaller or equal t_max: its orbits go on
        from where they are. Maps computed in bands hold none.
    with_trust
        Whether to find out which pixels to trust, too (`compute_trust`), once the map is whole; when cancelled, pixels not tested
        yet are `Trust.NOT_TESTED`.

    Returns
    -------
    `EscapeMap`; fates, escape times, and the crossings of what escapes, are equal to the bit whatever the executor, the
    interruptions and the resumptions. Which certificate a bounded orbit has may depend on these.

    Raises
    ------
    ValueError
        When `resume` belongs to another map, or no exit is defined at an energy that `spec` asks for.
    """
    if resume is not None:
        _check_resumable(spec, resume)
    if spec.resolution[0] * spec.resolution[1] > LARGEST_RUN:
        result = _compute_in_bands(spec, on_frame, cancel, executor)
    else:
        result = _compute_at_once(spec, on_frame, cancel, executor, resume)
    if not (with_trust and result.complete):
        return result
    return replace(result, trust=compute_trust(result, None, cancel, executor).trust)


def _compute_at_once(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None,
    cancel: threading.Event | None,
    executor: Executor | None,
    resume: EscapeMap | None,
) -> EscapeMap:
    run = MapRun(spec, resume)
    if on_frame is None:
        # Nobody looks at coarse stages.
        run.stride = 1
    begun = time.monotonic()
    due: float | None = None

    def publish(stage_over: bool) -> None:
        nonlocal due
        now = time.monotonic()
        # The first frame is the whole of the coarsest stage.
        if on_frame is None or (now < due if due is not None else not stage_over):
            return
        frame = run.frame()
        if not frame.complete:
            on_frame(frame)
            due = time.monotonic() + frame_pause(now - begun)

    carry_through(run, executor, cancel, publish)
    result = run.result()
    if on_frame is not None and result.complete:
        on_frame(replace(result, batch=None))
    return result


def frame_pause(elapsed: float) -> float:
    """Seconds to wait after a frame that came `elapsed` seconds into the work: a quick map need not show every stage of it."""
    return min(max(_SHORTEST_PAUSE, _PAUSE_SHARE * elapsed), _LONGEST_PAUSE)


def _check_resumable(spec: MapSpec, resume: EscapeMap) -> None:
    if resume.batch is None:
        raise ValueError("resume: this map holds no orbits to go on from; give one that compute_map returned, not a frame")
    if replace(resume.spec, t_max=spec.t_max) != spec or resume.spec.t_max > spec.t_max:
        raise ValueError(f"resume: a map of {resume.spec} cannot go on to {spec}; all but a larger t_max must be equal")


def _compute_in_bands(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None,
    cancel: threading.Event | None,
    executor: Executor | None,
) -> EscapeMap:
    canvas = _blank(spec)
    done = 0
    for rows in row_blocks(spec, LARGEST_RUN):
        run = MapRun(spec, rows=rows)
        carry_through(run, executor, cancel)
        part = run.frame()
        for name in IMAGES:
            getattr(canvas, name)[rows] = getattr(part, name)
        done += rows.size
        stopped = is_cancelled(cancel)
        canvas = replace(canvas, progress=done / spec.resolution[1], horizon=part.horizon)
        if stopped:
            break
        if on_frame is not None:
            on_frame(_read_only(canvas))
    return replace(_read_only(canvas), complete=not np.any(canvas.fate == Fate.NOT_COMPUTED))


def _read_only(canvas: EscapeMap) -> EscapeMap:
    """The same map for others to look at; a copy would not be within the bound on memory."""
    images: dict[str, Any] = {name: getattr(canvas, name).view() for name in IMAGES}
    for image in images.values():
        image.flags.writeable = False
    return replace(canvas, **images)


def _blank(spec: MapSpec) -> EscapeMap:
    """A map of which nothing is known."""
    x, ordinate = spec.pixel_centres()
    images: dict[str, Any] = {name: np.full((ordinate.size, x.size), value, dtype) for name, (dtype, value) in IMAGES.items()}
    return EscapeMap(spec, x, ordinate, stride=1, horizon=0.0, progress=0.0, complete=False, **images)
