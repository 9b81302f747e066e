"""Computation of escape maps: all pixels at once, line by line along a parameter, or in blocks of rows for large maps."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_path, checks_types
from engine.maps.analyses.rounded_share import with_rounded_share
from engine.maps.map_store import open_map_store
from engine.maps.parameter_map import LinewiseRun
from engine.maps.result import PIXEL_ARRAYS, EscapeMap, collect_map, empty_arrays
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage, run_stages
from engine.propagation.fates import Fate

LARGEST_RUN = 2**20
"""Largest number of pixels whose orbits are in memory together. Larger maps are computed in blocks."""

_STORED_RUN = 2**18
"""Largest number of pixels of a block of a map with a store, which is saved between blocks."""

OnFrame = Callable[[EscapeMap], None]
"""A function that receives the map so far."""

type _Run = MapRun | LinewiseRun | BlockwiseRun
type _Restore = Callable[[EscapeMap], EscapeMap]


@shows_progress("escape map")
@checks_types(
    spec=MapSpec, resume=(EscapeMap, type(None)), store=(str, os.PathLike, type(None)),
    on_frame=(Callable, type(None)), execution=Execution,
)  # fmt: skip
def compute_map(
    spec: MapSpec,
    on_frame: OnFrame | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    resume: EscapeMap | None = None,
    store: str | os.PathLike[str] | None = None,
    on_progress: Callable[[float], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> EscapeMap:
    """Compute an escape map.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with the map so far, at increasing intervals: first at coarse resolution, then at full resolution,
        then with longer integration times. A map of more than 2²⁰ pixels is filled block by block.
    cancel, executor, on_progress
        Override the fields of `execution` that have these names. All other long functions have only the parameter `execution`.
    resume
        An earlier map, complete or cancelled, whose orbits are continued. Its spec must be equal, but its t_max may be smaller.
        Of a map of more than 2²⁰ pixels, finished rows are kept; it may be a frame or come from a file, and its t_max must be
        equal. Along a parameter, such a map cannot be resumed.
    store
        A file for the map so far, whose name ends in ".nc". The map is computed in blocks of rows and saved between them, at
        the end, and when it is cancelled. The same call with the same file continues, also after the process was killed. The
        map has no integration state. Not for a map along a parameter.
    execution
        How the computation runs. When it is cancelled, the map so far is returned, with ``complete`` False.

    Returns
    -------
    The `EscapeMap`. The arrays of a complete map are bit-identical for every executor, interruption and resumption.

    Raises
    ------
    ValueError
        When `resume` or `store` belongs to another map, both are given, or no exit is defined at an energy of `spec`.
    OSError
        When `store` cannot be read or written.
    BlockingIOError
        When another process is writing `store`.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map
    >>> escapes = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (40, 40), t_max=1e3))
    >>> escapes.complete, round(sum(escapes.fractions().values()), 12)
    (True, 1.0)
    """
    overrides: dict[str, Any] = {"cancel": cancel, "executor": executor, "on_progress": on_progress}
    execution = replace(execution, **{name: value for name, value in overrides.items() if value is not None})
    if store is not None:
        if resume is not None:
            raise ValueError("resume: must be None with a store, which holds the earlier map")
        return _compute_stored(spec, checked_path("store", store), on_frame, execution)
    if resume is not None:
        _check_resumable(spec, resume)
    work, restore = _begin_computation(spec, resume, coarse_first=on_frame is not None)
    return _run(work, restore, on_frame, execution)


def _run(work: _Run, restore: _Restore, on_frame: OnFrame | None, execution: Execution) -> EscapeMap:
    """Run a computation, and return its map in the units of the request."""
    run_stages(work, execution, None if on_frame is None else lambda frame: on_frame(restore(frame)))
    result = restore(with_rounded_share(work.result(), execution))
    if on_frame is not None and result.complete:
        on_frame(replace(result, batch=None))
    return result


def _compute_stored(spec: MapSpec, path: Path, on_frame: OnFrame | None, execution: Execution) -> EscapeMap:
    """Return a map of which the finished blocks are kept in a file."""
    with open_map_store(path, spec) as store:
        earlier = None if store.earlier is None else store.earlier.in_well_units()
        work = BlockwiseRun(spec.in_well_units(), _STORED_RUN, earlier)
        result = _run(work, partial(EscapeMap.restored, spec=spec), store.saving(on_frame), execution)
        store.save(result)
        return result


def _begin_computation(spec: MapSpec, resume: EscapeMap | None, *, coarse_first: bool) -> tuple[_Run, _Restore]:
    """Return the computation of a map, and a function that converts its maps to the units of the request."""
    keeps_states = _keeps_states(spec)
    if spec.plane.parameter is not None:
        # Each line has its own units, so its maps are converted already.
        return LinewiseRun(spec, resume, keeps_states=keeps_states), lambda linewise: linewise
    restore = partial(EscapeMap.restored, spec=spec)
    earlier = None if resume is None else resume.in_well_units()
    if not keeps_states:
        return BlockwiseRun(spec.in_well_units(), LARGEST_RUN, earlier), restore
    return MapRun(spec.in_well_units(), earlier, coarse_first=coarse_first), restore


def _check_resumable(spec: MapSpec, resume: EscapeMap) -> None:
    """Raise ValueError unless a map can be continued for a request."""
    different_fields = spec.different_fields(resume.spec)
    if not _keeps_states(spec) and spec.plane.parameter is None:
        if different_fields:
            raise ValueError(f"resume: a map with another {', '.join(different_fields)}; must be equal for more than 2²⁰ pixels")
        return
    if resume.batch is None:
        raise ValueError(
            "resume: frames and maps from files have no integration state; must be a map returned by compute_map, "
            "or use store to continue from a file"
        )
    if different_fields not in ([], ["t_max"]) or resume.spec.t_max > spec.t_max:
        raise ValueError(f"resume: a map with another {', '.join(different_fields)}; must be equal but for a smaller t_max")


def _keeps_states(spec: MapSpec) -> bool:
    """Return whether all orbits of a map are in memory together, so that they can be continued."""
    return spec.resolution[0] * spec.resolution[1] <= LARGEST_RUN


def row_blocks(spec: MapSpec, max_pixels: int) -> Iterator[np.ndarray]:
    """Divide the rows of a map into blocks. Each block contains the mirror images of its rows.

    Parameters
    ----------
    spec
        The map.
    max_pixels
        Largest number of pixels in a block, at least 1. A larger block contains only one row and its mirror image.

    Yields
    ------
    The increasing row numbers of each block. Together, the blocks contain every row once.
    """
    columns, rows = spec.resolution
    height = max(max_pixels // columns, 1)
    mirrored_axes = spec.plane.mirrored_axes
    has_mirrored_rows = mirrored_axes is not None and mirrored_axes[1]
    if not has_mirrored_rows:
        yield from (np.arange(begin, min(begin + height, rows)) for begin in range(0, rows, height))
        return
    half_height = max(height // 2, 1)
    for begin in range(0, (rows + 1) // 2, half_height):
        lower_rows = np.arange(begin, min(begin + half_height, (rows + 1) // 2))
        yield np.union1d(lower_rows, rows - 1 - lower_rows)


def _are_decided(escapes: EscapeMap) -> np.ndarray:
    """Return whether all pixels of a row are decided, (rows,)."""
    return (escapes.fate != Fate.NOT_COMPUTED).all(axis=1)


class BlockwiseRun:
    """Computes a map of one potential block by block, because all its orbits together need too much memory.

    Parameters
    ----------
    spec
        The request, `MapSpec.in_well_units`.
    max_pixels
        Largest number of pixels in a block, see `row_blocks`.
    earlier
        A map of the same request, whose finished rows are kept.
    """

    def __init__(self, spec: MapSpec, max_pixels: int, earlier: EscapeMap | None = None) -> None:
        self.spec, self._max_pixels = spec, max_pixels
        self._horizon = 0.0 if earlier is None else earlier.horizon
        self._arrays = empty_arrays(PIXEL_ARRAYS, spec.resolution[::-1])
        if earlier is not None:
            finished = _are_decided(earlier)
            for name, array in self._arrays.items():
                array[finished] = getattr(earlier, name)[finished]
        self._is_done = self._arrays["fate"][:, 0] != Fate.NOT_COMPUTED

    def stages(self, execution: Execution, _on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage computes a block."""
        for rows in row_blocks(self.spec, self._max_pixels):
            missing = rows[~self._is_done[rows]]
            if missing.size:
                yield partial(self._compute_block, missing, replace(execution, on_progress=None))

    def _compute_block(self, rows: np.ndarray, execution: Execution) -> None:
        """Compute the block with these rows."""
        run = MapRun(self.spec, rows=rows)
        run_stages(run, execution)
        block = run.frame()
        for name, array in self._arrays.items():
            array[rows] = getattr(block, name)
        self._is_done[rows] = _are_decided(block)
        self._horizon = block.horizon

    def progress(self) -> float:
        """Return the share of the rows that are done."""
        return float(self._is_done.mean())

    def frame(self) -> EscapeMap:
        """Return the map so far, with views of the arrays, because copies would need too much memory."""
        stage = {"stride": 1, "horizon": self._horizon, "progress": self.progress()}
        return collect_map(self.spec, self.spec.pixel_centres(), self._arrays, **stage)

    def result(self) -> EscapeMap:
        """Return the map so far. It has no integration state."""
        return self.frame()
