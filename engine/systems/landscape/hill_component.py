"""Proof by intervals that the component of {V ≤ h} around the origin is bounded, or that it is not.

The plane is divided into cells, which grow with the distance from the origin. A cell is left out if a lower bound of V on the
cell exceeds h. The remaining cells that hang together with those at the origin contain the component. If none of them reaches the
edge of the plane, the component is bounded. Cells that V = h may pass are divided until this is shown, or until cells on which V
never exceeds h lead to the edge. Barriers, such as lines across the saddles of exits, divide the component: only the part on the
inner side of all barriers is examined.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from enum import Enum
from typing import Self

import numpy as np

from engine.expressions.calculus import slopes
from engine.expressions.evaluation import evaluate
from engine.expressions.graph import Graph, make_graph
from engine.expressions.intervals import Interval, enclose
from engine.expressions.nodes import Expression

FARTHEST = 2.0**20
"""Distance of the edge of the plane, in units of length: a component that reaches it counts as unbounded."""

MOST_CELLS = 60_000
"""Largest number of cells of all sizes on which V is bounded by default. This takes up to half a second."""

# Number of cells along each side of the plane, before any is divided.
_COARSEST = 32
# Largest number of divisions of a cell.
_MOST_DIVISIONS = 20
# Number of divisions by which cells lag behind in a proof, for each factor of 2 in their distance from the origin, because most
# openings are near it.
_LAG = 0.7
# Index shifts of the eight neighbours of a cell.
_NEIGHBOURS = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j])
# Steps that put a 0 after each bit of an index below 2^32: shifts, and masks of the bits that remain.
_BIT_GAPS = [(2**k, (2**64 - 1) // (2**2**k + 1)) for k in (4, 3, 2, 1, 0)]
# Sample points of a cell, from 0 to 1 along its sides.
_SAMPLES = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, 3)] * 2), axis=-1).reshape(-1, 2)


Program = tuple[Graph, tuple[float, ...]]
"""A graph and its numbers."""

_Bounds = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class Extent(Enum):
    """What is known of the size of a component."""

    BOUNDED = "bounded"
    UNBOUNDED = "unbounded"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Barrier:
    """A curve with two ends that divides the plane near it. Both ends lie where V > h.

    Attributes
    ----------
    position
        Returns, for points x and y, their signed distance from the curve, negative on the inner side, and their position along
        the curve. From −1 to 1, the curve is the barrier; farther out, the distance is that from its continuation. Only the sign
        of the distance counts.
    """

    position: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]

    @classmethod
    def parabola(cls, middle: np.ndarray, outward: np.ndarray, bend: float, half_length: float) -> Self:
        """Return the barrier u = a q² up to |q| = `half_length`, with u along a unit vector (2,) from `middle`, a the `bend`."""

        def position(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            dx, dy = x - middle[0], y - middle[1]
            u, q = outward[0] * dx + outward[1] * dy, outward[0] * dy - outward[1] * dx
            return u - bend * q**2, q / half_length

        return cls(position)


@dataclass(frozen=True)
class _Cells:
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

    def take(self, selection: np.ndarray) -> _Cells:
        return _Cells(*(getattr(self, each.name)[selection] for each in fields(self)))

    def join(self, other: _Cells) -> _Cells:
        return _Cells(*(np.concatenate([getattr(self, each.name), getattr(other, each.name)]) for each in fields(self)))

    def quarters(self, selection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return level and index of the quarters of some cells."""
        quarters = 2 * self.index[selection][:, None] + [[0, 0], [1, 0], [0, 1], [1, 1]]
        return np.repeat(self.level[selection] + 1, 4), quarters.reshape(-1, 2)

    @property
    def size(self) -> int:
        return len(self.level)

    @property
    def are_at_edge(self) -> np.ndarray:
        last = (_COARSEST << self.level[:, None]) - 1
        return ((self.index == 0) | (self.index == last)).any(axis=1)


class ComponentSearch:
    """Examines components of {V ≤ h} around the origin for one V.

    Parameters
    ----------
    expression
        V.
    length
        Size of the region around the origin in which cells have about the same size, dimensionless.
    """

    def __init__(self, expression: Expression, length: float) -> None:
        self._program: Program = make_graph((expression, *slopes(expression)))
        self._value: Program = make_graph((expression,))
        self._length = length

    def examine(self, energy: float, barriers: Sequence[Barrier] = (), most_cells: int = MOST_CELLS) -> Extent:
        """Return the extent of the component at an energy, on the inner side of the barriers, as proved.

        The result is undecided if V must be bounded on more than `most_cells` cells.
        """
        return self._examine(energy, barriers, self.bounds, _LAG, most_cells)

    def is_open(self, energy: float, barriers: Sequence[Barrier] = ()) -> bool:
        """Return whether the component is unbounded, as proved or, where the proof is undecided, by samples of V."""
        extent = self.examine(energy, barriers)
        if extent is Extent.UNDECIDED:
            extent = self._examine(energy, barriers, self._sampled_bounds, 0.0, MOST_CELLS)
        return extent is Extent.UNBOUNDED

    def _examine(self, energy: float, barriers: Sequence[Barrier], bounds: _Bounds, lag: float, most_cells: int) -> Extent:
        """Apply `examine` with a function that returns the bounds of V on cells.

        `lag` is the number of divisions by which cells lag behind for each factor of 2 in their distance from the origin.
        """
        whole_plane = np.stack(np.meshgrid(np.arange(_COARSEST), np.arange(_COARSEST)), axis=-1).reshape(-1, 2)
        cells = self._make_cells(np.zeros(len(whole_plane), int), whole_plane, energy, barriers, bounds)
        examined = len(whole_plane)
        for most_divisions in range(1, _MOST_DIVISIONS + 1):
            neighbours = _neighbours(cells)
            pairs = _connections(cells, *neighbours)
            is_reached = _spread_from_origin(cells, pairs)
            if not (is_reached & cells.are_at_edge).any():
                return Extent.BOUNDED
            is_below = cells.high <= energy
            # Cells that contain points of barriers are left out.
            is_free = is_below & (cells.barrier < 0) & ~cells.is_at_end
            is_free_node = np.append(is_free, np.zeros(2 * len(barriers), bool))
            if (_spread_from_origin(cells, pairs[is_free_node[pairs].all(axis=1)]) & is_free & cells.are_at_edge).any():
                return Extent.UNBOUNDED
            is_due = cells.level + lag * self._log_distance(cells) < most_divisions
            joins_sides = cells.is_at_end | _are_beside_other_barriers(cells, *neighbours)
            is_divided = is_reached & (~is_below | joins_sides) & is_due
            level, index = cells.quarters(is_divided)
            examined += len(level)
            if examined > most_cells:
                break
            parts = self._make_cells(level, index, energy, barriers, bounds)
            cells = cells.take(is_reached & ~is_divided).join(parts)
        return Extent.UNDECIDED

    def _make_cells(
        self, level: np.ndarray, index: np.ndarray, energy: float, barriers: Sequence[Barrier], bounds: _Bounds
    ) -> _Cells:
        """Return the cells on which V can be as low as the energy."""
        first, last = self._edges(level, index), self._edges(level, index + 1)
        low, high = bounds(first, last)
        is_kept = ~(low > energy)
        level, index, first, last, low, high = (each[is_kept] for each in (level, index, first, last, low, high))
        x, y = _samples(first, last)
        sides = np.ones((len(level), len(barriers)), int)
        is_cut, is_beyond = (np.zeros((len(level), len(barriers)), bool) for _ in range(2))
        for k, barrier in enumerate(barriers):
            distance, along = barrier.position(x, y)
            is_inner, is_outer = (distance < 0.0).all(axis=1), (distance > 0.0).all(axis=1)
            sides[:, k] = np.where(is_inner, -1, is_outer)
            is_cut[:, k] = (sides[:, k] == 0) & (np.abs(along) <= 1.0).all(axis=1)
            is_beyond[:, k] = (along > 1.0).all(axis=1) | (along < -1.0).all(axis=1)
        # A cell that two barriers cut counts as cut by none, so that it connects both sides until it is divided. The same holds
        # for cells at the origin, where the component begins.
        is_in_two_parts = (is_cut.sum(axis=1) == 1) & ~_are_at_origin(level, index)
        barrier_of = np.where(is_in_two_parts, is_cut.argmax(axis=1) if barriers else 0, -1)
        is_at_end = (barrier_of < 0) & ((sides == 0) & ~is_beyond).any(axis=1)
        return _Cells(level, index, low, high, barrier_of, is_at_end, sides)

    def _edges(self, level: np.ndarray, index: np.ndarray) -> np.ndarray:
        """Return the lower edges (n, 2) of cells. Neighbours of any size have the same edge to the bit."""
        share = index / (_COARSEST << level)[:, None] - 0.5
        return self._length * np.sinh(2.0 * np.arcsinh(FARTHEST) * share)

    def _log_distance(self, cells: _Cells) -> np.ndarray:
        """Return the binary logarithm of the distance of cells (n,) from the origin, which is at least about 0."""
        return np.log2(1.0 + np.hypot(*self._edges(cells.level, cells.index + 0.5).T) / self._length)

    def bounds(self, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return bounds of V on cells with corners (n, 2): those of its terms, or those from its slopes, which are narrower."""
        x, y = (Interval(first[:, axis], last[:, axis]) for axis in (0, 1))
        value, along_x, along_y = enclose(*self._program, x, y).values
        middle = 0.5 * (first + last)
        centre = enclose(*self._program, *(Interval(middle[:, axis], middle[:, axis]) for axis in (0, 1))).values[0]
        with np.errstate(invalid="ignore", over="ignore"):
            half_x, half_y = np.maximum(last - middle, middle - first).T
            change = along_x.magnitude * half_x + along_y.magnitude * half_y
            change = np.where(np.isfinite(change), change * (1.0 + 1e-15), np.inf)
            low, high = np.fmax(value.low, centre.low - change), np.fmin(value.high, centre.high + change)
        return low, high

    def _sampled_bounds(self, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the lowest and the highest value of V at nine points of each cell; infinite where V is not defined."""
        values = np.nan_to_num(evaluate(*self._value, *_samples(first, last))[0], nan=np.inf, neginf=-np.inf, posinf=np.inf)
        return values.min(axis=1), values.max(axis=1)


def _samples(first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return x and y of nine points of each cell with corners (n, 2), of shape (2, n, 9)."""
    return np.moveaxis(first[:, None] + _SAMPLES * (last - first)[:, None], -1, 0)


def _are_at_origin(level: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return which cells (n,) touch the origin."""
    half = (_COARSEST // 2) << level[:, None]
    return ((index == half) | (index == half - 1)).all(axis=1)


def _spread_from_origin(cells: _Cells, pairs: np.ndarray) -> np.ndarray:
    """Return which cells (n,) hang together with those at the origin by pairs of connected nodes, see `_connections`."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    nodes = cells.size + 2 * cells.sides.shape[1]
    count, labels = connected_components(coo_array((np.ones(len(pairs), bool), pairs.T), shape=(nodes, nodes)), directed=False)
    is_reached_label = np.zeros(count, bool)
    is_reached_label[labels[: cells.size][_are_at_origin(cells.level, cells.index)]] = True
    is_reached = is_reached_label[labels]
    # A cut cell counts as reached if one of its parts is.
    part = cells.size + 2 * cells.barrier
    return np.where(cells.barrier >= 0, is_reached[part] | is_reached[np.minimum(part + 1, nodes - 1)], is_reached[: cells.size])


def _connections(cells: _Cells, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return pairs (m, 2) of connected nodes: cells, or parts of cells that a barrier cuts in two, given the cells that touch.

    Behind the cells, each barrier has two nodes: the parts of its cells on its inner side, and those on its outer side.
    """
    is_cut_first, is_cut_second = cells.barrier[first] >= 0, cells.barrier[second] >= 0
    pairs = [np.column_stack([first, second])[~is_cut_first & ~is_cut_second]]
    for cut, other in ((first[is_cut_first], second[is_cut_first]), (second[is_cut_second], first[is_cut_second])):
        barrier = cells.barrier[cut]
        side = cells.sides[other, barrier]
        for part, is_beside in ((0, side <= 0), (1, side >= 0)):
            node = cells.size + 2 * barrier + part
            has_another_barrier = cells.barrier[other] >= 0
            neighbour = np.where(has_another_barrier, cells.size + 2 * cells.barrier[other], other)
            is_same = has_another_barrier & (cells.barrier[other] == barrier)
            pairs.append(np.column_stack([node, neighbour])[is_beside & ~is_same])
            # Both parts of a neighbour that another barrier cuts.
            pairs.append(np.column_stack([node, neighbour + 1])[is_beside & ~is_same & has_another_barrier])
    return np.concatenate(pairs)


def _are_beside_other_barriers(cells: _Cells, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Return which cells (n,) are cut by a barrier and touch a cell that another barrier cuts.

    Such cells connect both sides of both barriers until they are divided.
    """
    barriers = cells.barrier[first], cells.barrier[second]
    is_pair = (barriers[0] >= 0) & (barriers[1] >= 0) & (barriers[0] != barriers[1])
    are_beside = np.zeros(cells.size, bool)
    are_beside[first[is_pair]] = are_beside[second[is_pair]] = True
    return are_beside


def _neighbours(cells: _Cells) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices of cells that touch, at an edge or a corner, each pair with the smaller cell first."""
    places = _places(cells.level, cells.index)
    order = np.argsort(places)
    beside = cells.index[:, None] + _NEIGHBOURS
    is_inside = ((beside >= 0) & (beside < _COARSEST << cells.level[:, None, None])).all(axis=2)
    first = np.nonzero(is_inside)[0]
    wanted = _places(cells.level[first], beside[is_inside])
    # The only cell that can contain the place beside the first cell.
    second = order[np.maximum(np.searchsorted(places[order], wanted, side="right") - 1, 0)]
    divisions = 2 * (_MOST_DIVISIONS - cells.level[second])
    is_found = (cells.level[second] <= cells.level[first]) & (wanted >> divisions == places[second] >> divisions)
    return first[is_found], second[is_found]


def _places(level: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return the places (n,) of cells in the Z-order, in which all parts of a cell follow each other."""
    places = index << (_MOST_DIVISIONS - level)[:, None]
    # The bits of both indices alternate.
    for shift, mask in _BIT_GAPS:
        places = (places | places << shift) & mask
    return places[:, 0] | places[:, 1] << 1
