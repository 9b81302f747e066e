"""Paths of cells from the origin to the edge of the plane: whether there are any, and where they can be closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from engine.systems.landscape.cells import Cells, are_at_origin

if TYPE_CHECKING:
    from scipy.sparse import csr_array

# Length, along a path, of a cell that is not undecided. Sums of such lengths are exact and below 1.
_SHORT = 2.0**-24


class CellPaths:
    """The paths of cells from the origin to the edge of the plane with the fewest undecided cells.

    A cell is free if V never exceeds h on it, and no barrier passes it. A cell is undecided if V = h may pass it, or if it lies
    on both sides of a barrier without being cut in two.

    Parameters
    ----------
    cells
        Cells on which V can be as low as h.
    pairs
        Pairs (m, 2) of connected nodes, see `find_connections`.
    energy
        h, dimensionless.

    Attributes
    ----------
    least_undecided
        The number of undecided cells on these paths; infinite if no path leads to the edge.
    are_reached
        (n,) whether cells hang together with those at the origin.
    are_to_divide
        (n,) the undecided cells on these paths; the cells cut by the barriers on them if there are no undecided cells.
    """

    def __init__(self, cells: Cells, pairs: np.ndarray, energy: float) -> None:
        from scipy.sparse.csgraph import dijkstra

        self._cells, parts = cells, 2 * cells.sides.shape[1]
        is_cut = cells.barrier >= 0
        self._is_free = (cells.high <= energy) & ~is_cut & ~cells.is_at_end
        is_undecided = ~self._is_free & ~is_cut
        # The last two nodes are the origin and the edge of the plane.
        self._origin, self._edge = cells.size + parts, cells.size + parts + 1
        self._pairs = np.concatenate([pairs, self._pairs_at_ends()])
        lengths = np.append(np.where(is_undecided, 1.0, _SHORT), np.full(parts + 2, _SHORT))
        from_origin, from_edge = dijkstra(_directed_graph(self._pairs, lengths), indices=[self._origin, self._edge])
        self.least_undecided = float(np.floor(from_origin[self._edge]))
        are_on_paths = from_origin + from_edge - lengths < self.least_undecided + 0.5
        self.are_reached = self._of_cells(np.isfinite(from_origin))
        self.are_to_divide = self._of_cells(are_on_paths) & (is_undecided if self.least_undecided else is_cut)

    def _of_cells(self, are_nodes: np.ndarray) -> np.ndarray:
        """Return flags (n,) of the cells, given those of all nodes. A cut cell has the flag if one of the parts has it."""
        cells, is_cut = self._cells, self._cells.barrier >= 0
        flags = are_nodes[: cells.size].copy()
        parts = are_nodes[cells.size : self._origin].reshape(-1, 2).any(axis=1)
        flags[is_cut] = parts[cells.barrier[is_cut]]
        return flags

    @property
    def are_joined_by_free_cells(self) -> bool:
        """Whether free cells lead from the origin to the edge."""
        from scipy.sparse.csgraph import connected_components

        if self.least_undecided:
            return False
        is_free = np.ones(self._edge + 1, bool)
        is_free[: self._cells.size], is_free[self._cells.size : self._origin] = self._is_free, False
        pairs = self._pairs[is_free[self._pairs].all(axis=1)]
        _, labels = connected_components(_directed_graph(pairs, np.ones(len(is_free))), directed=False)
        return bool(labels[self._origin] == labels[self._edge])

    def _pairs_at_ends(self) -> np.ndarray:
        """Return the pairs of the origin and of the edge of the plane with the cells there."""
        cells = self._cells
        first = np.flatnonzero(are_at_origin(cells.level, cells.index))
        are_at_edge, is_cut = cells.are_at_edge, cells.barrier >= 0
        parts = cells.size + 2 * cells.barrier[are_at_edge & is_cut]
        last = np.concatenate([np.flatnonzero(are_at_edge & ~is_cut), parts, parts + 1])
        ends = np.repeat([self._origin, self._edge], [len(first), len(last)])
        return np.column_stack([ends, np.concatenate([first, last])])


def _directed_graph(pairs: np.ndarray, lengths: np.ndarray) -> csr_array:
    """Return the graph with both directions of pairs (m, 2) of nodes; an edge has the length (n,) of the node where it ends."""
    from scipy.sparse import coo_array

    start, end = np.concatenate([pairs, pairs[:, ::-1]]).T
    # Nodes can be paired twice, and the lengths of equal edges would be added.
    graph = coo_array((np.ones(len(start)), (start, end)), shape=(len(lengths), len(lengths))).tocsr()
    graph.data = lengths[graph.indices]
    return graph
