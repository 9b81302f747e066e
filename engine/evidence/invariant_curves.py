"""Closed invariant curves on the section y = 0, and the side of such a curve on which a point lies.

In a system of two degrees of freedom, an orbit cannot cross an invariant torus of its own energy. A quasi-periodic orbit meets
the section in one closed curve, or in a chain of closed curves around the islands of a resonance. An orbit that starts on one
side of these curves stays on that side.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from engine.integrator.kernels.rotation_loop import arrange_loop

if TYPE_CHECKING:
    import shapely

MOST_ISLANDS = 24
"""Largest number of islands of a chain whose curves are searched."""

LEAST_POINTS = 40
"""Smallest number of points of a loop."""

# Distance from the polygon within which the curve is assumed to lie, in units of the height g θ/8 of an arc. The arc turns by θ
# over a gap g between points. With even gaps, the polygon turns by θ at each point. Near a resonance p/q, the points form q
# bunches with wide gaps between them. At the edge of a bunch, the polygon turns only by θ/2, the angle between the curve and the
# gap. Even then, the curve stays within a quarter of the margin.
_MARGIN_FACTOR = 8.0
# Largest accepted margin, relative to the square root of the enclosed area.
_LARGEST_RELATIVE_MARGIN = 0.1


@dataclass(frozen=True, eq=False)
class InvariantCurve:
    """The loops in which one invariant torus meets the section; no orbit of the same energy crosses them.

    Attributes
    ----------
    loops
        One polygon per loop, in the plane (x, px).
    margins
        For each loop, the distance from its polygon within which the exact curve lies.
    """

    loops: tuple[shapely.Polygon, ...]
    margins: tuple[float, ...]

    @property
    def area(self) -> float:
        """Area enclosed by all loops, dimensionless."""
        return float(sum(loop.area for loop in self.loops))

    def find_side(self, points: np.ndarray) -> np.ndarray:
        """Find on which side of the torus points of the section lie.

        The torus divides its energy surface into two parts. Crossing a loop changes the part, and the flow maps the interiors of
        the loops onto each other. Therefore the interiors form one side, and the section outside all loops forms the other.

        Parameters
        ----------
        points
            (n, 2) x and px, finite.

        Returns
        -------
        (n,) int8: −1 inside a loop, 1 outside all loops, 0 within the margin of a loop.
        """
        import shapely

        side = np.ones(len(points), np.int8)
        for outer, inner in self._bounds:
            # Each call prepares the polygons again, because pickling drops their preparation.
            shapely.prepare([outer, inner])
            in_outer = shapely.contains_xy(outer, *points.T)
            # 0 within the margin, −1 inside.
            side[in_outer] = 0
            side[in_outer] -= shapely.contains_xy(inner, *points[in_outer].T)
        return side

    @cached_property
    def _bounds(self) -> list[tuple[shapely.Polygon, shapely.Polygon]]:
        """For each loop, a polygon that contains the exact curve and one that the exact curve contains."""
        return [
            (loop.buffer(margin, quad_segs=1), loop.buffer(-margin, quad_segs=1))
            for loop, margin in zip(self.loops, self.margins, strict=True)
        ]


def find_invariant_curve(points: np.ndarray) -> InvariantCurve | None:
    """Connect the section points of a quasi-periodic orbit to closed curves.

    Parameters
    ----------
    points
        (n, 2) x and px of successive section points of one orbit, finite.

    Returns
    -------
    A curve with one loop per island, or one loop for an orbit around a fixed point. None if there are too few points, or if the
    points do not lie densely enough on smooth curves without self-intersections.
    """
    for island_count in range(1, MOST_ISLANDS + 1):
        if len(points) < island_count * LEAST_POINTS:
            break
        loops = _find_loops(points, island_count)
        if loops:
            polygons, margins = zip(*loops, strict=True)
            return InvariantCurve(polygons, margins)
    return None


def _find_loops(points: np.ndarray, island_count: int) -> list[tuple[shapely.Polygon, float]]:
    """Return the loop around each island of a chain, with its margin; an empty list if any loop is not closed or not smooth."""
    loops = []
    for island in range(island_count):
        loop = _find_loop(np.ascontiguousarray(points[island::island_count]))
        if loop is None:
            return []
        loops.append(loop)
    return loops


def _find_loop(points: np.ndarray) -> tuple[shapely.Polygon, float] | None:
    """Return the loop through successive points of a rotation and its margin; None if they are not on a smooth closed curve."""
    import shapely

    loop = np.empty_like(points)
    # The kernel writes the points into `loop` in their order along the curve. It returns −1 if there is no closed curve.
    height = arrange_loop(points, loop)
    if height < 0.0:
        return None
    margin = _MARGIN_FACTOR * height
    polygon = shapely.Polygon(loop)
    is_smooth = margin <= _LARGEST_RELATIVE_MARGIN * np.sqrt(polygon.area) and polygon.is_valid
    return (polygon, margin) if is_smooth else None
