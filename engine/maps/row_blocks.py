"""Maps in blocks of rows, which can be computed, stored and recomputed independently."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from engine.foundations.execution import Execution
from engine.maps.result import PIXEL_ARRAYS, EscapeMap, collect_map, empty_arrays
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage, run_stages


def row_blocks(spec: MapSpec, max_pixels: int) -> Iterator[np.ndarray]:
    """Divide the rows of a map into blocks; each block contains the mirror images of its rows.

    Parameters
    ----------
    spec
        The map.
    max_pixels
        Largest number of pixels in a block, at least 1. A block has at least one row and its mirror image.

    Yields
    ------
    Increasing row numbers of each block; together the blocks contain every row once.
    """
    columns, rows = spec.resolution
    height = max(max_pixels // columns, 1)
    mirrored = spec.plane.mirrored_axes
    if mirrored is None or not mirrored[1]:
        yield from (np.arange(low, min(low + height, rows)) for low in range(0, rows, height))
        return
    half = max(height // 2, 1)
    for low in range(0, (rows + 1) // 2, half):
        lower = np.arange(low, min(low + half, (rows + 1) // 2))
        yield np.union1d(lower, rows - 1 - lower)


class BlockStack:
    """The blocks of a map of one potential while they are computed, whose orbits together need too much memory.

    Parameters
    ----------
    spec
        The request, `MapSpec.in_well_units`.
    max_pixels
        See `row_blocks`.
    """

    def __init__(self, spec: MapSpec, max_pixels: int) -> None:
        self.spec, self._max_pixels = spec, max_pixels
        self._rows_done, self._horizon = 0, 0.0
        self._arrays = empty_arrays(PIXEL_ARRAYS, spec.resolution[::-1])

    def stages(self, execution: Execution, _on_change: OnChange) -> Iterator[Stage]:
        """See `Staged`: a stage computes a block."""
        for rows in row_blocks(self.spec, self._max_pixels):
            yield partial(self._compute, rows, replace(execution, on_progress=None))

    def _compute(self, rows: np.ndarray, execution: Execution) -> None:
        run = MapRun(self.spec, rows=rows)
        run_stages(run, execution)
        block = run.frame()
        for name, array in self._arrays.items():
            array[rows] = getattr(block, name)
        self._rows_done += rows.size
        self._horizon = block.horizon

    def progress(self) -> float:
        """Share of the rows that are done."""
        return self._rows_done / self.spec.resolution[1]

    def frame(self) -> EscapeMap:
        """The map so far, with views of the arrays; copies would need too much memory."""
        stage = {"stride": 1, "horizon": self._horizon, "progress": self.progress()}
        return collect_map(self.spec, self.spec.pixel_centres(), self._arrays, **stage)

    def result(self) -> EscapeMap:
        """The map so far; it has no integration state."""
        return self.frame()
