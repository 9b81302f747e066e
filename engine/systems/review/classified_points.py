"""The critical points of a potential with their kinds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from engine.systems.potential import Potential

# Largest distance of a critical point from the exit saddle that is the same point, in units of length of the well.
_SAME_POINT = 1e-6


class PointKind(Enum):
    """The kind of a critical point. The value is the name of the kind in texts."""

    MINIMUM = "minimum"
    SADDLE = "saddle"
    MAXIMUM = "maximum"
    DEGENERATE = "degenerate point"


@dataclass(frozen=True)
class CriticalPoint:
    """A point (x, y) with ∇V = 0 and V = `energy`. `channel` is the number of the exit channel over this point; 0 without one."""

    x: float
    y: float
    kind: PointKind
    energy: float
    channel: int


def classify_points(potential: Potential) -> tuple[CriticalPoint, ...]:
    """Return all critical points, the nearest to the origin first; ValueError if they are not found."""
    points = [
        CriticalPoint(x, y, _kind(potential, x, y, index), float(potential.value(x, y)), _channel(potential, x, y))
        for (x, y), index in zip(potential.critical_points.tolist(), potential.well.critical_indices.tolist(), strict=True)
    ]
    return tuple(sorted(points, key=lambda point: math.hypot(point.x, point.y)))


def _kind(potential: Potential, x: float, y: float, index: float) -> PointKind:
    """Return the kind of a critical point with an index, see `Well.critical_indices`."""
    if index == 0.0:
        return PointKind.DEGENERATE
    if index < 0.0:
        return PointKind.SADDLE
    return PointKind.MINIMUM if np.trace(potential.hessian_matrix(x, y)) > 0.0 else PointKind.MAXIMUM


def _channel(potential: Potential, x: float, y: float) -> int:
    """Return the number of the channel over a point; 0 if there is none."""
    channels = np.flatnonzero(np.hypot(*(potential.saddles - [x, y]).T) < _SAME_POINT * potential.units.length)
    return int(channels[0]) + 1 if channels.size else 0


def point_at_origin(points: tuple[CriticalPoint, ...]) -> CriticalPoint | None:
    """Return the critical point at the origin; None if there is none."""
    return next((point for point in points if point.x == point.y == 0.0), None)


def minima_of(points: tuple[CriticalPoint, ...]) -> list[CriticalPoint]:
    """Return the minima, the nearest to the origin first."""
    return [point for point in points if point.kind is PointKind.MINIMUM]


def find_new_origin(potential: Potential, points: tuple[CriticalPoint, ...]) -> tuple[float, float] | None:
    """Return (x, y) of the nearest minimum if the clause ``well`` can move the origin of the axes there; otherwise None.

    Axes can be moved only once, and neither in a rotating frame nor with an escape radius.
    """
    nearest = next(iter(minima_of(points)), None)
    can_move = not any(potential.origin) and not potential.rotation and potential.escapes_over_saddles
    if not can_move or nearest is None or nearest is point_at_origin(points):
        return None
    return nearest.x, nearest.y
