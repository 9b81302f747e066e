"""Ridges of Lagrangian descriptors lie on the stable and unstable manifolds of Lyapunov orbits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import KDTree

from engine import CASES, EscapeMap, MapSpec, Plane, compute_lagrangian_descriptor, compute_map, find_stable_manifolds
from engine.results import StableManifolds

# The (y, py) slice of the Hénon–Heiles system is (x, px) of case II.
SPEC = MapSpec(CASES["II"], Plane.X_PX, 1 / 6 + 0.02, (160, 160), t_max=100.0)
DURATION = 15.0
STEEPEST = 0.9
"""Quantile of the magnitude of the gradient above which pixels can be on a ridge."""


def find_ridges(values: np.ndarray) -> np.ndarray:
    """Return columns and rows, of shape (n, 2), of pixels of ridges: their gradients are steep, and maxima along the gradient."""
    slope, along = np.gradient(values)
    steepness = np.hypot(along, slope)
    known = np.isfinite(steepness) & (steepness > 0.0)
    filled = np.where(known, steepness, 0.0)
    step = np.where(known, [slope / steepness, along / steepness], 0.0)
    sides = [ndimage.map_coordinates(filled, np.indices(values.shape) + sign * step, order=1) for sign in (1.0, -1.0)]
    on_ridge = known & (steepness >= np.maximum(*sides)) & (steepness > np.quantile(steepness[known], STEEPEST))
    return np.argwhere(on_ridge)[:, ::-1]


@cache
def stable_manifolds(images: int) -> StableManifolds:
    return find_stable_manifolds(SPEC.potential, SPEC.energy, images=images)


@pytest.fixture(scope="module")
def escapes() -> EscapeMap:
    return compute_map(SPEC)


def manifold_points(images: int, sign: float) -> np.ndarray:
    """Return columns and rows, of shape (n, 2), of points of the stable manifolds; with `sign` −1, of the unstable manifolds."""
    window, (columns, rows) = SPEC.find_window(), SPEC.resolution
    points = []
    for arc in stable_manifolds(images).arcs:
        column = (arc.x - window.x_low) / (window.x_high - window.x_low) * columns - 0.5
        row = (sign * arc.ordinate - window.ordinate_low) / (window.ordinate_high - window.ordinate_low) * rows - 0.5
        lengths = np.hypot(np.diff(column), np.diff(row))
        places = np.concatenate([[0.0], np.cumsum(lengths)])
        dense = np.arange(0.0, places[-1], 0.2)
        points.append(np.column_stack([np.interp(dense, places, column), np.interp(dense, places, row)]))
    return np.concatenate(points)


def share_within_a_pixel(points: np.ndarray, others: np.ndarray) -> float:
    return float(np.mean(KDTree(others).query(points)[0] <= 1.0))


@pytest.mark.parametrize(("direction", "sign"), [("forward", 1.0), ("backward", -1.0)])
def test_ridges_lie_on_the_manifolds_of_their_direction_of_time(direction: str, sign: float, escapes: EscapeMap) -> None:
    descriptor = compute_lagrangian_descriptor(escapes, duration=DURATION, direction=direction).descriptor
    ridges = find_ridges(descriptor)
    assert len(ridges) > 500
    assert share_within_a_pixel(ridges, manifold_points(3, sign)) > 0.98
    # Only the first two images distinguish the directions of time, because later images lie close together.
    first, wrong = manifold_points(2, sign), manifold_points(2, -sign)
    assert share_within_a_pixel(ridges, first) > 0.85 > 2.0 * share_within_a_pixel(ridges, wrong)
    assert share_within_a_pixel(first, ridges) > 0.75
