"""Division of a map into blocks of rows that can be computed, stored and recomputed independently."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine.maps.spec import MapSpec


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
