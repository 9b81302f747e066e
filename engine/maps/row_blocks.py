"""A map cut into bands of rows, each of which can be computed, kept and lost on its own."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from engine.dynamics.planes import Plane
from engine.maps.spec import MapSpec


def row_blocks(spec: MapSpec, most: int) -> Iterator[np.ndarray]:
    """Numbers of rows, rising, that together hold every pixel once; on (x, px) each band with its mirror image.

    Parameters
    ----------
    spec
        The map.
    most
        Most pixels of a band, 1 or more; a band has one row at least, and on (x, px) one and its image.
    """
    columns, rows = spec.resolution
    height = max(most // columns, 1)
    if spec.plane is not Plane.X_PX:
        yield from (np.arange(low, min(low + height, rows)) for low in range(0, rows, height))
        return
    half = max(height // 2, 1)
    for low in range(0, (rows + 1) // 2, half):
        lower = np.arange(low, min(low + half, (rows + 1) // 2))
        yield np.union1d(lower, rows - 1 - lower)
