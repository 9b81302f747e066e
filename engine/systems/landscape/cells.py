"""Cells of several sizes that cover a part of the plane, and may be cut in two by barriers.

A cell has a column and a row among the cells of its size, as in a quadtree.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

COARSEST = 8
"""Number of cells along each side of the plane, before any is divided."""

MOST_DIVISIONS = 24
"""Largest number of divisions of a cell."""

# Index shifts of the eight neighbours of a cell.
_NEIGHBOURS = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j])
# Steps that put a 0 after each bit of an index below 2^32: shifts, and masks of the bits that remain.
_BIT_GAPS = [(2**k, (2**64 - 1) // (2**2**k + 1)) for k in (4, 3, 2, 1, 0)]


@dataclass(frozen=True)
class Cells:
    """Cells of several sizes that do not overlap.

    Attributes
    ----------
    level
        (n,) number of divisions.
    index
        (n, 2) column and row among the cells of this size.
    low, high
        (n,) bounds of V on the cells.
    barrier
        (n,) the barrier that cuts the cell in two, from 0; −1 for none.
    is_at_end
        (n,) whether the cell lies on both sides of a barrier, but does not count as cut in two, such as a cell at its end.
    sides
        (n, barriers) −1 on the inner side of a barrier, 1 on the outer side, 0 if the cell is on both sides.
    """

    level: np.ndarray
    index: np.ndarray
    low: np.ndarray
    high: np.ndarray
    barrier: np.ndarray
    is_at_end: np.ndarray
    sides: np.ndarray

    def take(self, selection: np.ndarray) -> Cells:
        """Return some of the cells."""
        return Cells(*(getattr(self, each.name)[selection] for each in fields(self)))

    def join(self, other: Cells) -> Cells:
        """Return these and other cells."""
        return Cells(*(np.concatenate([getattr(self, each.name), getattr(other, each.name)]) for each in fields(self)))

    def connecting_both_sides(self, selection: np.ndarray) -> Cells:
        """Return the cells, some of which do not count as cut by a barrier."""
        barrier = np.where(selection, -1, self.barrier)
        return replace(self, barrier=barrier, is_at_end=self.is_at_end | selection)

    def quarters(self, selection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return level and index of the quarters of some cells."""
        quarters = 2 * self.index[selection][:, None] + [[0, 0], [1, 0], [0, 1], [1, 1]]
        return np.repeat(self.level[selection] + 1, 4), quarters.reshape(-1, 2)

    @property
    def size(self) -> int:
        """The number of cells."""
        return len(self.level)

    @property
    def are_at_edge(self) -> np.ndarray:
        """Whether cells (n,) touch the edge of the plane."""
        last = (COARSEST << self.level[:, None]) - 1
        return ((self.index == 0) | (self.index == last)).any(axis=1)


def are_at_origin(level: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return which cells (n,) touch the origin."""
    half = (COARSEST // 2) << level[:, None]
    return ((index == half) | (index == half - 1)).all(axis=1)


def find_connections(cells: Cells, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return pairs (m, 2) of connected nodes: cells, or parts of cells that a barrier cuts in two, given the cells that touch.

    Behind the cells, each barrier has two nodes: the parts of its cells on its inner side, and those on its outer side.
    Cells cut by different barriers do not touch.
    """
    is_cut_first, is_cut_second = cells.barrier[first] >= 0, cells.barrier[second] >= 0
    pairs = [np.column_stack([first, second])[~is_cut_first & ~is_cut_second]]
    for cut, other in ((first[is_cut_first], second[is_cut_first]), (second[is_cut_second], first[is_cut_second])):
        barrier = cells.barrier[cut]
        side = cells.sides[other, barrier]
        for part, is_beside in ((0, side <= 0), (1, side >= 0)):
            is_other = is_beside & (cells.barrier[other] < 0)
            pairs.append(np.column_stack([cells.size + 2 * barrier + part, other])[is_other])
    return np.concatenate(pairs)


def are_beside_other_barriers(cells: Cells, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return which cells (n,) are cut by a barrier and touch a cell that another barrier cuts.

    They connect both sides of their barriers until they are divided.
    """
    barriers = cells.barrier[first], cells.barrier[second]
    is_pair = (barriers[0] >= 0) & (barriers[1] >= 0) & (barriers[0] != barriers[1])
    are_beside = np.zeros(cells.size, bool)
    are_beside[first[is_pair]] = are_beside[second[is_pair]] = True
    return are_beside


def find_neighbours(cells: Cells) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of cells that touch, at an edge or a corner, each pair with the smaller cell first."""
    places = _places(cells.level, cells.index)
    order = np.argsort(places)
    beside = cells.index[:, None] + _NEIGHBOURS
    is_inside = ((beside >= 0) & (beside < COARSEST << cells.level[:, None, None])).all(axis=2)
    first = np.nonzero(is_inside)[0]
    wanted = _places(cells.level[first], beside[is_inside])
    # The only cell that can contain the place beside the first cell.
    second = order[np.maximum(np.searchsorted(places[order], wanted, side="right") - 1, 0)]
    divisions = 2 * (MOST_DIVISIONS - cells.level[second])
    is_found = (cells.level[second] <= cells.level[first]) & (wanted >> divisions == places[second] >> divisions)
    return first[is_found], second[is_found]


def _places(level: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return the places (n,) of cells in the Z-order, in which all parts of a cell follow each other."""
    places = index << (MOST_DIVISIONS - level)[:, None]
    # The bits of both indices alternate.
    for shift, mask in _BIT_GAPS:
        places = (places | places << shift) & mask
    return places[:, 0] | places[:, 1] << 1
