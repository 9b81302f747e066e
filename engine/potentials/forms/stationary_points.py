"""Critical points of an expression in a stated region: the disc of 16.2 times the distance of the nearest one from the origin.

Newton's method starts on a grid that is uniform in the logarithm of the distance over 48 octaves, which shows the scale of the
well, and then on a grid over the region. The sum of the indices must be the number of turns of the gradient along the edge of the
region (Poincaré–Hopf theorem); if it is not, a finer grid follows. The region is smaller if V is not defined in all of it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from engine.potentials.forms.common_roots import UndecidedError
from engine.potentials.forms.critical_points import NO_POINTS, NotIsolatedError

Gradient = Callable[[Any, Any], tuple[Any, Any]]
Value = Callable[[Any, Any], Any]
Hessian = Callable[[Any, Any], tuple[Any, Any, Any]]

MOST_POINTS = 60
"""Largest number of critical points in the region."""

# Radius of the region in units of the distance of the nearest critical point; the smaller ones where V is not defined in it, or
# has too many points.
_FACTORS = (16.2, 8.1, 4.1, 2.1)
_OCTAVES, _PER_OCTAVE, _ANGLES = 24, 2, 32
# A point this close to the origin is the origin.
_ZERO = 2.0**-_OCTAVES
# Points along a side of the grids over the region, and rings around the origin.
_SIDES = (48, 160)
_RINGS = 40
_NEWTON_STEPS = 60
_CONVERGED = 1e-12
# Relative to their distance from the origin and to that of the nearest point, points closer than this are the same one.
_SAME = 1e-8
# Coordinates below this, in units of the distance of the nearest point, are rounding errors of zero.
_ROUNDING = 1e-13
SINGULAR_RATIO = 1e-10
"""A Hessian is singular if the ratio of its eigenvalues is at most this."""

# The same for points that Newton's method finds along a curve of them, where it converges slowly.
_SINGULAR_ON_A_CURVE = 1e-6

# Radius of the circles around poles, in units of the distance of the nearest critical point or of another pole.
_POLE_CIRCLE = 1e-3

# Sample points of a circle, to start with and at most. A turn of the slope within 1e-9 radians needs some 30 more than the first.
_SAMPLES, _MOST_SAMPLES = 721, 20_000
# Largest rotation of a vector, in radians, and largest change of the logarithm of its length between neighbouring sample points
# of a circle. A vector that turns fast is short there: its length shows a whole turn between two points.
_LARGEST_ROTATION, _LARGEST_GROWTH = 0.5, 1.0


def find_stationary_points(value: Value, gradient: Gradient, hessian: Hessian, poles: np.ndarray = NO_POINTS) -> np.ndarray:
    """(n, 3) the points with ∇V = 0 in the region, each once, with their indices; the origin, if it is one, is exactly (0, 0).

    The index is 1 for a minimum or a maximum, −1 for a saddle and 0 for a point whose Hessian is singular to rounding.

    Parameters
    ----------
    value, gradient, hessian
        V, (V_x, V_y) and (V_xx, V_xy, V_yy) as functions of arrays x and y.
    poles
        (m, 2) points at which V is not defined; each has an index, too.

    Raises
    ------
    NotIsolatedError
        If the points form a curve.
    UndecidedError
        If there are too many points, V is not defined in the region, or the sum of the indices is wrong.
    """
    radii = 2.0 ** np.linspace(-_OCTAVES, _OCTAVES, 2 * _OCTAVES * _PER_OCTAVE + 1)
    near = _newton(gradient, hessian, _rings(radii), 2.0**_OCTAVES)
    distance = np.hypot(*near.T)
    nearest = float(distance[distance >= _ZERO].min(initial=np.inf))
    if nearest == np.inf:
        return _with_indices(hessian, np.zeros((min(len(near), 1), 2)))
    problem = ""
    for factor in _FACTORS:
        try:
            return _with_indices(hessian, _find_within(value, gradient, hessian, poles, near, nearest, factor))
        except UndecidedError as error:
            problem = problem or str(error)
    raise UndecidedError(problem)


def _with_indices(hessian: Hessian, points: np.ndarray) -> np.ndarray:
    """(n, 3) points (n, 2) with their indices."""
    vxx, vxy, vyy = (np.broadcast_to(entry, len(points)) for entry in hessian(*points.T))
    eigenvalues = np.abs(np.linalg.eigvalsh(np.nan_to_num(np.array([[vxx, vxy], [vxy, vyy]])).transpose(2, 0, 1)))
    is_singular = eigenvalues.min(axis=1) <= SINGULAR_RATIO * eigenvalues.max(axis=1)
    return np.column_stack([points, np.where(is_singular, 0.0, np.sign(vxx * vyy - vxy * vxy))])


def _find_within(
    value: Value,
    gradient: Gradient,
    hessian: Hessian,
    poles: np.ndarray,
    near: np.ndarray,
    nearest: float,
    factor: float,
) -> np.ndarray:
    """The points within a multiple of the distance of the nearest one."""
    radius = factor * nearest
    region = f"within r = {radius:.6g}, {factor:g} times the distance of the nearest critical point from the origin"
    x, y = (radius * _rings(np.linspace(0.02, 1.0, 50))).T
    if not np.isfinite([value(x, y), *gradient(x, y)]).all():
        raise UndecidedError(f"V is not defined everywhere {region}.")
    at_poles = _index_sum_of_poles(gradient, poles[np.hypot(*poles.T) < radius], nearest)
    for side in _SIDES:
        axis = np.linspace(-radius, radius, side)
        grid = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
        rings = _rings(np.geomspace(radius / 256.0, radius, _RINGS))
        points = _distinct(_newton(gradient, hessian, np.concatenate([near, grid, rings]), radius), nearest)
        if len(points) > MOST_POINTS:
            if _are_degenerate(hessian, points):
                raise NotIsolatedError
            raise UndecidedError(f"V has more than {MOST_POINTS} critical points {region}.")
        if winding_number(gradient, radius) == _index_sum(hessian, points) + at_poles:
            return points
    raise UndecidedError(
        f"Not all critical points {region} were found: the sum of their indices is wrong (Poincaré–Hopf theorem)."
    )


def _rings(radii: np.ndarray) -> np.ndarray:
    """(n, 2) points on circles, not on the axes, where symmetry can lead Newton's method to the same point again."""
    angle = 0.1 + 2.0 * np.pi / _ANGLES * np.arange(_ANGLES)
    return np.stack([np.outer(radii, np.cos(angle)), np.outer(radii, np.sin(angle))], axis=-1).reshape(-1, 2)


def _newton(gradient: Gradient, hessian: Hessian, points: np.ndarray, radius: float) -> np.ndarray:
    """(n, 2) where Newton's method converges within a radius, with repetitions."""
    roots = []
    with np.errstate(all="ignore"):
        for _ in range(_NEWTON_STEPS):
            (gx, gy), (vxx, vxy, vyy) = gradient(*points.T), hessian(*points.T)
            step = np.stack(np.broadcast_arrays(vyy * gx - vxy * gy, vxx * gy - vxy * gx), axis=-1)
            step = step / np.broadcast_to(vxx * vyy - vxy * vxy, len(points))[:, None]
            still = (np.broadcast_to(gx, len(points)) == 0.0) & (np.broadcast_to(gy, len(points)) == 0.0)
            length = np.where(still, 0.0, np.hypot(*step.T))
            distance = np.hypot(*points.T)
            converged = length <= _CONVERGED * np.maximum(distance, _ZERO)
            following = points - np.where(still[:, None], 0.0, step)
            roots.append(following[converged & (distance <= radius)])
            points = following[~converged & np.isfinite(length)]
    return np.concatenate(roots)


def _distinct(points: np.ndarray, nearest: float) -> np.ndarray:
    """Each point once, on the axes exactly; no more than one beyond the largest number."""
    distance = np.hypot(*points.T)
    kept = [np.zeros(2)] if np.any(distance < _ZERO) else []
    left = points[distance >= _ZERO]
    while len(left) and len(kept) <= MOST_POINTS:
        kept.append(left[0])
        left = left[np.hypot(*(left - left[0]).T) > _SAME * (nearest + np.hypot(*left[0]))]
    unique = np.array(kept).reshape(-1, 2)
    return np.where(np.abs(unique) < _ROUNDING * nearest, 0.0, unique)


def _are_degenerate(hessian: Hessian, points: np.ndarray) -> bool:
    """Whether most of the Hessians are singular."""
    vxx, vxy, vyy = (np.broadcast_to(entry, len(points)) for entry in hessian(*points.T))
    largest, smallest = np.linalg.svd(np.array([[vxx, vxy], [vxy, vyy]]).transpose(2, 0, 1), compute_uv=False).T
    return bool(np.mean(smallest <= _SINGULAR_ON_A_CURVE * largest) > 0.5)


def _index_sum_of_poles(gradient: Gradient, poles: np.ndarray, nearest: float) -> int:
    """Turns of the gradient on small circles around poles."""
    apart = np.hypot(*(poles[:, None] - poles).T)
    radius = _POLE_CIRCLE * min(nearest, apart[apart > 0.0].min(initial=np.inf))
    turns = 0
    for pole_x, pole_y in poles.tolist():
        turns += winding_number(partial(_gradient_from, gradient, pole_x, pole_y), radius)
    return turns


def _gradient_from(gradient: Gradient, x0: float, y0: float, x: np.ndarray, y: np.ndarray) -> tuple[Any, Any]:
    """The gradient at a place relative to another one."""
    return gradient(x0 + x, y0 + y)


def _index_sum(hessian: Hessian, points: np.ndarray) -> int:
    """The number of minima and maxima without that of saddles."""
    vxx, vxy, vyy = (np.broadcast_to(entry, len(points)) for entry in hessian(*points.T))
    return int(np.sign(vxx * vyy - vxy * vxy).sum())


def winding_number(vector: Callable[[np.ndarray, np.ndarray], tuple[Any, Any]], radius: float) -> int:
    """Number of counterclockwise turns of a vector, as a function of x and y, along a circle about the origin.

    By the Poincaré–Hopf theorem it is the sum of the indices of the vector's zeros inside the circle. For the gradient of a
    potential the index is +1 at a minimum or maximum and −1 at a saddle. If the indices of a list of critical points have
    another sum, the list is incomplete or includes a degenerate point.

    Raises
    ------
    UndecidedError
        If the vector is not defined somewhere on the circle, or turns too often along it.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, _SAMPLES)
    while angle.size <= _MOST_SAMPLES:
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        first, second = vector(x, y)
        second, first, _ = np.broadcast_arrays(second, first, x)
        if not np.isfinite([first, second]).all():
            raise UndecidedError("The slope of V is not defined everywhere on a circle around critical points or around a pole.")
        rotation = np.diff(np.arctan2(second, first))
        rotation = (rotation + np.pi) % (2.0 * np.pi) - np.pi
        with np.errstate(divide="ignore", invalid="ignore"):
            growth = np.abs(np.diff(np.log(np.hypot(first, second))))
        too_large = np.flatnonzero((np.abs(rotation) > _LARGEST_ROTATION) | (growth > _LARGEST_GROWTH))
        if not too_large.size:
            return round(float(rotation.sum()) / (2.0 * np.pi))
        angle = np.insert(angle, too_large + 1, 0.5 * (angle[too_large] + angle[too_large + 1]))
    raise UndecidedError("The slope of V turns too often on a circle around critical points or around a pole.")
