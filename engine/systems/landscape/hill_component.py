"""Proof by intervals that the component of {V ≤ h} around the origin is bounded, or that it is not.

The plane is divided into cells, which grow with the distance from the origin. A cell is left out if a lower bound of V on the
cell exceeds h. The remaining cells that hang together with those at the origin contain the component. If none of them reaches the
edge of the plane, the component is bounded. If cells on which V never exceeds h lead to the edge, it is unbounded. Otherwise, the
cells that V = h may pass are divided where they matter: on the paths to the edge with the fewest such cells. Barriers, such as
lines across the saddles of exits, divide the component: only the part on the inner side of all barriers is examined.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Self

import numpy as np

from engine.expressions.calculus import slopes
from engine.expressions.evaluation import evaluate
from engine.expressions.graph import Graph, make_graph
from engine.expressions.intervals import Interval, enclose
from engine.expressions.nodes import Expression
from engine.systems.landscape.cell_paths import CellPaths
from engine.systems.landscape.cells import (
    COARSEST,
    MOST_DIVISIONS,
    Cells,
    are_at_origin,
    are_beside_other_barriers,
    find_connections,
    find_neighbours,
)

FARTHEST = 2.0**20
"""Distance of the edge of the plane, in units of length: a component that reaches it counts as unbounded."""

# Largest number of cells of all sizes on which V is bounded, and of rounds in which cells are divided. This takes up to a second.
_MOST_CELLS = 20_000
_MOST_ROUNDS = 150
# Number of divisions by which cells lag behind for each factor of 2 in their distance from the origin. A path is closed with
# fewer cells near the origin.
_LAG = 0.7
# Number of divisions in which cells may lag behind in the same round. With more, cells are divided far away in vain; with fewer,
# there are more rounds.
_TURNS = 3.0
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
        self._length = length

    def examine(self, energy: float, barriers: Sequence[Barrier] = ()) -> Extent:
        """Return the extent of the component at an energy, on the inner side of the barriers, as proved."""
        return self._examine(energy, barriers, self.bounds)

    def sample(self, energy: float, barriers: Sequence[Barrier] = ()) -> Extent:
        """Apply `examine` without proof: V and its slopes are computed at nine points of each cell."""
        return self._examine(energy, barriers, self._sampled_bounds)

    def _examine(self, energy: float, barriers: Sequence[Barrier], bounds: _Bounds) -> Extent:
        whole_plane = np.stack(np.meshgrid(np.arange(COARSEST), np.arange(COARSEST)), axis=-1).reshape(-1, 2)
        cells = self._make_cells(np.zeros(len(whole_plane), int), whole_plane, energy, barriers, bounds)
        examined = len(whole_plane)
        for _ in range(_MOST_ROUNDS):
            neighbours = find_neighbours(cells)
            cells = cells.connecting_both_sides(are_beside_other_barriers(cells, *neighbours))
            paths = CellPaths(cells, find_connections(cells, *neighbours), energy)
            if paths.least_undecided == np.inf:
                return Extent.BOUNDED
            if paths.are_joined_by_free_cells:
                return Extent.UNBOUNDED
            divisible = paths.are_to_divide & (cells.level < MOST_DIVISIONS)
            if not divisible.any():
                break
            turn = cells.level + _LAG * self._log_distance(cells)
            is_divided = divisible & (turn < turn[divisible].min() + _TURNS)
            level, index = cells.quarters(is_divided)
            examined += len(level)
            if examined > _MOST_CELLS:
                break
            cells = cells.take(paths.are_reached & ~is_divided).join(self._make_cells(level, index, energy, barriers, bounds))
        return Extent.UNDECIDED

    def _make_cells(
        self, level: np.ndarray, index: np.ndarray, energy: float, barriers: Sequence[Barrier], bounds: _Bounds
    ) -> Cells:
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
        is_in_two_parts = (is_cut.sum(axis=1) == 1) & ~are_at_origin(level, index)
        barrier_of = np.where(is_in_two_parts, is_cut.argmax(axis=1) if barriers else 0, -1)
        is_at_end = (barrier_of < 0) & ((sides == 0) & ~is_beyond).any(axis=1)
        return Cells(level, index, low, high, barrier_of, is_at_end, sides)

    def _edges(self, level: np.ndarray, index: np.ndarray) -> np.ndarray:
        """Return the lower edges (n, 2) of cells. Neighbours of any size have the same edge to the bit."""
        share = index / (COARSEST << level)[:, None] - 0.5
        return self._length * np.sinh(2.0 * np.arcsinh(FARTHEST) * share)

    def _log_distance(self, cells: Cells) -> np.ndarray:
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
        """Return estimates of the lowest and the highest value of V on cells from nine points; infinite where V is not defined.

        With the largest slopes at these points, V may be higher between them: a ridge can be narrower than a cell.
        """
        value, along_x, along_y = evaluate(*self._program, *_samples(first, last))
        value = np.nan_to_num(value, nan=np.inf, neginf=-np.inf, posinf=np.inf)
        # No point of a cell is farther from one of the nine points than a quarter of its sides.
        quarter_x, quarter_y = (0.25 * (last - first)).T
        with np.errstate(invalid="ignore", over="ignore"):
            rise = np.abs(along_x).max(axis=1) * quarter_x + np.abs(along_y).max(axis=1) * quarter_y
        return value.min(axis=1), value.max(axis=1) + np.where(np.isfinite(rise), rise, np.inf)


def _samples(first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return x and y of nine points of each cell with corners (n, 2), of shape (2, n, 9)."""
    return np.moveaxis(first[:, None] + _SAMPLES * (last - first)[:, None], -1, 0)
