"""The density of a long path: how often it passes each pixel, as an opacity."""

from __future__ import annotations

import numpy as np

from engine import Window

# Twice the pixels of the plot, for high-density screens.
PIXELS = 600
"""Columns and rows of a density image."""

FAINTEST, _OPAQUE = 50, 255
# Segments of the path that are drawn at a time, which bounds the memory.
_AT_A_TIME = 4096


def shade_path(x: np.ndarray, y: np.ndarray, window: Window) -> np.ndarray:
    """The opacity of a path over a window.

    Parameters
    ----------
    x, y
        (n,) points of the path, n ≥ 2, joined by straight lines.
    window
        What is drawn.

    Returns
    -------
    (`PIXELS`, `PIXELS`) uint8, row 0 lowest: 0 where the path does not pass, and from `FAINTEST` to 255 by rank of how often it
    passes, so that each step of opacity has as many pixels.
    """
    return _by_rank(count_passes(x, y, window))


def count_passes(x: np.ndarray, y: np.ndarray, window: Window) -> np.ndarray:
    """(`PIXELS`, `PIXELS`) int64: how often a path passes each pixel; parameters as in `shade_path`."""
    columns = PIXELS * (x - window.x_low) / (window.x_high - window.x_low)
    rows = PIXELS * (y - window.ordinate_low) / (window.ordinate_high - window.ordinate_low)
    counts = np.zeros(PIXELS**2, np.int64)
    for begin in range(0, len(x) - 1, _AT_A_TIME):
        piece = slice(begin, begin + _AT_A_TIME + 1)
        column, row = _points_between(columns[piece], rows[piece])
        inside = (column >= 0) & (column < PIXELS) & (row >= 0) & (row < PIXELS)
        counts += np.bincount(PIXELS * row[inside] + column[inside], minlength=counts.size)
    return counts.reshape(PIXELS, PIXELS)


def _points_between(columns: np.ndarray, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pixels along the lines between points, each line without its end; at most one pixel apart."""
    across, up = np.diff(columns), np.diff(rows)
    steps = np.maximum(np.ceil(np.maximum(np.abs(across), np.abs(up))), 1.0).astype(np.int64)
    line = np.repeat(np.arange(len(steps)), steps)
    share = (np.arange(len(line)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[line]
    column = np.floor(columns[:-1][line] + share * across[line])
    row = np.floor(rows[:-1][line] + share * up[line])
    return column.astype(np.int64), row.astype(np.int64)


def _by_rank(counts: np.ndarray) -> np.ndarray:
    shaded = np.zeros(counts.shape, np.uint8)
    passed = counts > 0
    if passed.any():
        _, place, sizes = np.unique(counts[passed], return_inverse=True, return_counts=True)
        rank = np.cumsum(sizes) / sizes.sum()
        share = (rank - rank[0]) / max(1.0 - rank[0], np.finfo(float).tiny)
        shaded[passed] = np.rint(FAINTEST + (_OPAQUE - FAINTEST) * share)[place]
    return shaded
