"""Cells of several sizes touch their neighbours."""

from __future__ import annotations

import numpy as np

from engine.systems.landscape.cells import COARSEST, Cells, find_neighbours


def plain_cells(level: np.ndarray, index: np.ndarray) -> Cells:
    """Return cells without barriers."""
    count = len(level)
    bounds, flags = np.zeros(count), np.zeros(count, bool)
    return Cells(level, index, bounds, bounds, np.full(count, -1), flags, np.zeros((count, 0), int))


def randomly_divided(chance: np.random.Generator) -> Cells:
    """Return cells that cover the plane, except for some that are left out, after random divisions."""
    side = np.arange(COARSEST)
    cells = plain_cells(np.zeros(COARSEST**2, int), np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2))
    for _ in range(4):
        is_divided = chance.random(cells.size) < 0.2
        is_kept = chance.random(cells.size) < 0.9
        cells = cells.take(is_kept & ~is_divided).join(plain_cells(*cells.quarters(is_divided)))
    return cells


def test_cells_touch_where_their_edges_meet() -> None:
    chance = np.random.default_rng(3)
    for _ in range(5):
        cells = randomly_divided(chance)
        size = 0.5 ** cells.level[:, None]
        low, high = cells.index * size, (cells.index + 1) * size
        touch = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2) & ~np.eye(cells.size, dtype=bool)
        pairs = np.column_stack(find_neighbours(cells))
        found = np.zeros_like(touch)
        found[pairs[:, 0], pairs[:, 1]] = found[pairs[:, 1], pairs[:, 0]] = True
        np.testing.assert_array_equal(found, touch)
