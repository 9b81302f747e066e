"""Closed invariant curves on the section y = 0, and what they part.

At one energy an orbit of two degrees of freedom cannot pass through an invariant torus. A quasi-periodic orbit pierces the
section in a closed curve, or in a chain of them around the islands of a resonance; what is on one side stays there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

MOST_ISLANDS = 24
"""Longest chain of islands that is looked for."""

_FEWEST_POINTS = 40
# How near to the polygon the curve is taken to be, in units of the height g θ/8 of an arc that turns by θ over a gap g between
# points. Where gaps are even the polygon turns by θ at a point. Near a resonance p/q the points gather in q bunches with wide
# gaps between them; at the edge of a bunch it turns by θ/2, the angle between the curve and the gap. So the curve is within a
# quarter of the margin.
_MARGIN = 8.0
# Largest margin, in units of the square root of the enclosed area.
_WIDEST = 0.1


@dataclass(frozen=True, eq=False)
class InvariantCurve:
    """All loops in which one torus pierces the section: a wall that no orbit of the same energy passes.

    Attributes
    ----------
    loops
        A polygon for each loop, in the plane (x, px).
    margins
        How near to its polygon each loop is known to be.
    """

    loops: tuple[shapely.Polygon, ...]
    margins: tuple[float, ...]

    @property
    def area(self) -> float:
        """Enclosed by all loops together, dimensionless."""
        return float(sum(loop.area for loop in self.loops))

    def find_side(self, points: np.ndarray) -> np.ndarray:
        """(n,) int8 side of the torus on which each of the (n, 2) points lies: −1 in a loop, 1 outside all, 0 too near to tell.

        The torus cuts its energy surface in two. Stepping across a loop changes the part, and the flow carries the loops' insides
        into each other: these are the one side, and all of the section outside the loops is the other.
        """
        side = np.ones(len(points), np.int8)
        for outer, inner in self._bounds:
            near = shapely.contains_xy(outer, *points.T)
            side[near] = 0
            side[near] -= shapely.contains_xy(inner, *points[near].T)
        return side

    @cached_property
    def _bounds(self) -> list[tuple[shapely.Polygon, shapely.Polygon]]:
        """What each loop certainly lies within, and what certainly lies within it."""
        polygons = [
            (loop.buffer(margin, quad_segs=1), loop.buffer(-margin, quad_segs=1))
            for loop, margin in zip(self.loops, self.margins, strict=True)
        ]
        shapely.prepare([polygon for pair in polygons for polygon in pair])
        return polygons

    def mirrored(self) -> InvariantCurve:
        """Its image under (x, px) → (−x, −px)."""
        return InvariantCurve(tuple(shapely.transform(loop, np.negative) for loop in self.loops), self.margins)


def find_invariant_curve(points: np.ndarray) -> InvariantCurve | None:
    """The closed curves that the section points of a quasi-periodic orbit lie on.

    Parameters
    ----------
    points
        (n, 2) successive points x, px of one orbit, finite.

    Returns
    -------
    A curve with as many loops as the orbit's chain has islands, one for an orbit about a fixed point; None when the points
    are too few, or not dense enough on smooth curves that do not cross themselves.
    """
    for islands in range(1, MOST_ISLANDS + 1):
        if len(points) < islands * _FEWEST_POINTS:
            break
        loops = _close_chain(points, islands)
        if loops:
            polygons, margins = zip(*loops, strict=True)
            return InvariantCurve(polygons, margins)
    return None


def _close_chain(points: np.ndarray, islands: int) -> list[tuple[shapely.Polygon, float]]:
    """The loops of a chain of so many islands; none when any of them does not close."""
    loops = []
    for first in range(islands):
        loop = _close(points[first::islands])
        if loop is None:
            return []
        loops.append(loop)
    return loops


def _close(points: np.ndarray) -> tuple[shapely.Polygon, float] | None:
    """The loop through successive points of a rotation and its margin; None when they do not lie on one."""
    order = _order_along(points)
    if order is None:
        return None
    loop = points[order]
    margin = _MARGIN * float(_arc_heights(loop).max())
    polygon = shapely.Polygon(loop)
    fits = margin <= _WIDEST * np.sqrt(polygon.area) and polygon.is_valid
    return (polygon, margin) if fits else None


def _order_along(points: np.ndarray) -> np.ndarray | None:
    """The order of successive points of a rotation along their closed curve; None when they are not those of one.

    The neighbours of the first point are the points of the nearest returns ahead and behind, a and b steps later. No point comes
    nearer, so there are at most a + b (three-gap theorem, Sós 1958), in the order of the rotation by p/(a + b) with p a ≡ 1.
    """
    away = points[1:] - points[0]
    distance = np.hypot(*away.T)
    ahead = away @ away[np.argmin(distance)] > 0.0
    if ahead.all():
        return None
    a = 1 + int(np.argmin(np.where(ahead, distance, np.inf)))
    b = 1 + int(np.argmin(np.where(ahead, np.inf, distance)))
    if math.gcd(a, b) != 1 or len(points) > a + b:
        return None
    return np.argsort(np.arange(len(points)) * pow(a, -1, a + b) % (a + b))


def _arc_heights(loop: np.ndarray) -> np.ndarray:
    """How high a curve arches over the gap after each point of a closed loop, by the sharper of the turns at its ends."""
    step = np.roll(loop, -1, axis=0) - loop
    before = np.roll(step, 1, axis=0)
    cross = before[:, 0] * step[:, 1] - before[:, 1] * step[:, 0]
    turn = np.abs(np.arctan2(cross, np.sum(before * step, axis=1)))
    heights: np.ndarray = np.hypot(*step.T) * np.maximum(turn, np.roll(turn, -1)) / 8.0
    return heights
