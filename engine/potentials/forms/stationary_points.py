"""Critical points of an expression in a stated region, with proof that there are no others.

The region is the disc of 16.2 times the distance of the nearest point from the origin. Newton's method from rings that are
uniform in the logarithm of the distance over 48 octaves shows this scale. Then the region is divided into boxes. A box is left
out if intervals prove that a component of the gradient does not vanish in it; one is solved if the operator of Krawczyk (1969,
Computing 4, 187) maps it into itself, which proves that exactly one point lies in it; others are divided. V may have poles and
walls at which it is not defined: boxes around them are divided down to a small size and then left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.expressions.graph import Graph, evaluate
from engine.expressions.intervals import Enclosure, Interval, enclose
from engine.potentials.forms.common_roots import UndecidedError
from engine.potentials.forms.critical_points import NO_POINTS, NotIsolatedError

Program = tuple[Graph, tuple[float, ...]]
"""A graph and its numbers."""

MOST_POINTS = 60
"""Largest number of critical points in the region."""

SINGULAR_RATIO = 1e-10
"""A Hessian is singular if the ratio of its eigenvalues is at most this."""

# Radius of the region in units of the distance of the nearest critical point; the smaller ones where V is not defined in it, has
# too many points, or needs too many boxes.
_FACTORS = (16.2, 8.1, 4.1, 2.1)
_OCTAVES, _PER_OCTAVE, _ANGLES = 24, 2, 32
# A point this close to the origin is the origin.
_ZERO = 2.0**-_OCTAVES
_NEWTON_STEPS, _LAST_STEPS = 60, 8
_SUBNORMAL = 1e-290
_CONVERGED = 1e-12
# Relative to their distance from the origin and to that of the nearest point, points closer than this are the same one.
_SAME = 1e-8
# Coordinates below this, in units of the distance of the nearest point, are rounding errors of zero.
_ROUNDING = 1e-13

# Boxes along a side of the region to begin with.
_SIDE = 32
# Operations on boxes, for each of the factors: at most a second. Most potentials need less than a tenth of them.
_MOST_WORK = 40_000_000
# Half the side of the smallest boxes, in units of the distance of the nearest point: where V is not defined, and elsewhere.
_SMALLEST_UNDEFINED, _SMALLEST = 2.0**-9, 2.0**-26
# Points that Newton's method finds are proved in boxes this much larger than those in which they were looked for.
_ENLARGED = 1.3
_QUARTERS = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
# Covers the rounding errors of the operator, relative to the box.
_MARGIN = 1e-9
# Boxes around a degenerate point are this close together.
_SAME_DEGENERATE = 1e-5
# Relative to its box, and to the larger eigenvalue: where Newton's method ends on a curve of critical points.
_NEAR_BOX, _SINGULAR_ON_A_CURVE = 8.0, 1e-6
# Boxes left at one size, where no proof succeeds: more than around some degenerate points.
_MOST_LEFT = 4_000


@dataclass(frozen=True)
class Derivatives:
    """V and its derivatives as programs.

    Attributes
    ----------
    slopes
        V, V_x and V_y.
    curvatures
        V_xx, V_xy and V_yy.
    """

    slopes: Program
    curvatures: Program

    @property
    def operations(self) -> int:
        """Number of operations of both programs."""
        return len(self.slopes[0].nodes) + len(self.curvatures[0].nodes)

    def at(self, points: np.ndarray) -> tuple[np.ndarray, ...]:
        """V_x, V_y, V_xx, V_xy and V_yy, each (n,), at points (n, 2)."""
        _, *slopes = evaluate(*self.slopes, *points.T)
        return (*slopes, *evaluate(*self.curvatures, *points.T))


def find_stationary_points(derivatives: Derivatives) -> np.ndarray:
    """(n, 3) the points with ∇V = 0 in the region, each once, with their indices; the origin, if it is one, is exactly (0, 0).

    The index is 1 for a minimum or a maximum, −1 for a saddle and 0 for a point whose Hessian is singular to rounding.

    Raises
    ------
    NotIsolatedError
        If the points form a curve.
    UndecidedError
        If there are too many points, V is not defined in a part of the region, or the proof needs too many boxes.
    """
    rings = _rings(2.0 ** np.linspace(-_OCTAVES, _OCTAVES, 2 * _OCTAVES * _PER_OCTAVE + 1))
    found = _newton(derivatives, rings)
    # Where V is flat its slopes are subnormal numbers, without digits.
    found = found[np.abs(derivatives.at(found)[2:]).max(axis=0) > _SUBNORMAL]
    distance = np.hypot(*found.T)
    nearest = float(distance[(distance >= _ZERO) & (distance <= 2.0**_OCTAVES)].min(initial=np.inf))
    if nearest == np.inf:
        origin = np.zeros((1, 2))
        slope = derivatives.at(origin)[:2]
        return _with_indices(derivatives, origin[[not np.any(slope)]] if not len(found) else origin)
    problem = ""
    for factor in _FACTORS:
        try:
            return _find_within(derivatives, nearest, factor)
        except UndecidedError as error:
            problem = problem or str(error)
    raise UndecidedError(problem)


def _find_within(derivatives: Derivatives, nearest: float, factor: float) -> np.ndarray:
    """The points within a multiple of the distance of the nearest one."""
    radius = factor * nearest
    region = f"within r = {radius:.6g}, {factor:g} times the distance of the nearest critical point from the origin"
    half, work, points = radius / _SIDE, 0, [NO_POINTS]
    centres = radius * np.linspace(-1.0, 1.0, _SIDE + 1)
    left = np.stack(np.meshgrid(centres, centres), axis=-1).reshape(-1, 2)
    while len(left) and half >= _SMALLEST * nearest:
        left = left[np.hypot(*np.maximum(np.abs(left) - half, 0.0).T) <= radius]
        work += len(left) * derivatives.operations
        if work > _MOST_WORK:
            raise UndecidedError(f"Whether all critical points {region} are known is not decided within the limit on the work.")
        slopes = enclose(*derivatives.slopes, *_box(left, half))
        if slopes.nowhere.any():
            raise UndecidedError(f"V is not defined everywhere {region}.")
        left, defined = (each[~_excludes_zero(slopes)] for each in (left, slopes.defined))
        if half < _SMALLEST_UNDEFINED * nearest:
            left = left[defined]
            if len(left) > _MOST_LEFT and _lies_on_curve(derivatives, left, half):
                raise NotIsolatedError
        roots, solved = _solve(derivatives, left, half)
        points.append(roots)
        half *= 0.5
        left = (left[~solved][:, None] + half * _QUARTERS).reshape(-1, 2)
    found = np.concatenate(points)
    unique = _distinct(found[np.hypot(*found.T) <= radius], nearest, _SAME)
    degenerate = _distinct(left, nearest, _SAME_DEGENERATE)
    if len(unique) + len(degenerate) > MOST_POINTS:
        raise UndecidedError(f"V has more than {MOST_POINTS} critical points {region}.")
    return np.concatenate([_with_indices(derivatives, unique), np.column_stack([degenerate, np.zeros(len(degenerate))])])


def _lies_on_curve(derivatives: Derivatives, centres: np.ndarray, half: float) -> bool:
    """Whether most of many boxes contain a point at which the Hessian is singular."""
    points = _refined(derivatives, centres)
    near = (np.abs(points - centres) <= _NEAR_BOX * half).all(axis=1)
    _, _, vxx, vxy, vyy = derivatives.at(points[near])
    eigenvalues = np.abs(np.linalg.eigvalsh(np.array([[vxx, vxy], [vxy, vyy]]).transpose(2, 0, 1)))
    flat = eigenvalues.min(axis=1) <= _SINGULAR_ON_A_CURVE * eigenvalues.max(axis=1)
    return bool(2 * np.count_nonzero(flat) > len(centres))


def _box(centres: np.ndarray, half: float) -> tuple[Interval, Interval]:
    x, y = (Interval(centre - half, centre + half) for centre in centres.T)
    return x, y


def _excludes_zero(slopes: Enclosure) -> np.ndarray:
    """(n,) whether V_x or V_y vanishes nowhere in a box."""
    _, along_x, along_y = slopes.values
    excluded: np.ndarray = along_x.excludes_zero() | along_y.excludes_zero()
    return excluded


def _solve(derivatives: Derivatives, centres: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """(m, 2) the points that lie in boxes with one point each, and (n,) whether it is proved that a box has one or none.

    The operator of Krawczyk maps a box c ± h to K = c − Y g + (I − Y H)(± h), with the gradient g at c, the Hessian H on the box
    and Y the inverse of the Hessian at c. All points of the box lie in K; if K lies inside of it, it has exactly one.
    """
    curvatures = enclose(*derivatives.curvatures, *_box(centres, _ENLARGED * half))
    slopes = enclose(*derivatives.slopes, *_box(centres, 0.0))
    with np.errstate(all="ignore"):
        middle, spread = (
            np.moveaxis(np.array([[xx, xy], [xy, yy]]), -1, 0)
            for xx, xy, yy in (
                [0.5 * (each.low + each.high) for each in curvatures.values],
                [0.5 * (each.high - each.low) for each in curvatures.values],
            )
        )
        _, _, vxx, vxy, vyy = derivatives.at(centres)
        adjugate = np.moveaxis(np.array([[vyy, -vxy], [-vxy, vxx]]), -1, 0)
        inverse = adjugate / (vxx * vyy - vxy * vxy)[:, None, None]
        gradient = np.column_stack([0.5 * (each.low + each.high) for each in slopes.values[1:]])
        error = np.column_stack([0.5 * (each.high - each.low) for each in slopes.values[1:]])
        step = -np.einsum("nij,nj->ni", inverse, gradient)
        rest = np.abs(np.eye(2) - inverse @ middle) + np.abs(inverse) @ spread
        reach = _ENLARGED * half * rest.sum(axis=2) + np.einsum("nij,nj->ni", np.abs(inverse), error)
        reach = reach * (1.0 + _MARGIN) + _MARGIN * half
        known = curvatures.defined & slopes.defined & np.isfinite(step).all(axis=1) & np.isfinite(reach).all(axis=1)
        single = known & (np.abs(step) + reach < _ENLARGED * half).all(axis=1)
        empty = known & (np.abs(step) - reach > half).any(axis=1)
    return _refined(derivatives, (centres + step)[single]), single | empty


def _rings(radii: np.ndarray) -> np.ndarray:
    """(n, 2) points on circles, not on the axes, where symmetry can lead Newton's method to the same point again."""
    angle = 0.1 + 2.0 * np.pi / _ANGLES * np.arange(_ANGLES)
    return np.stack([np.outer(radii, np.cos(angle)), np.outer(radii, np.sin(angle))], axis=-1).reshape(-1, 2)


def _newton(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """(n, 2) where Newton's method converges, with repetitions."""
    roots = [NO_POINTS]
    for _ in range(_NEWTON_STEPS):
        step = _newton_step(derivatives, points)
        length = np.hypot(*step.T)
        converged = length <= _CONVERGED * np.maximum(np.hypot(*points.T), _ZERO)
        points = points - step
        roots.append(points[converged])
        points = points[~converged & np.isfinite(length)]
    return np.concatenate(roots)


def _refined(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """(n, 2) after some steps of Newton's method."""
    for _ in range(_LAST_STEPS):
        points = points - _newton_step(derivatives, points)
    return points


def _newton_step(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """(n, 2) to subtract."""
    values = np.array(derivatives.at(points))
    with np.errstate(all="ignore"):
        # Products of small derivatives would underflow.
        gx, gy, vxx, vxy, vyy = values / np.abs(values[2:]).max(axis=0)
        step: np.ndarray = np.column_stack([vyy * gx - vxy * gy, vxx * gy - vxy * gx]) / (vxx * vyy - vxy * vxy)[:, None]
    return step


def _distinct(points: np.ndarray, nearest: float, same: float) -> np.ndarray:
    """Each point once, on the axes and at the origin exactly."""
    distance = np.hypot(*points.T)
    at_origin = distance < max(_ZERO, same * nearest)
    kept, left = [np.zeros(2)] if at_origin.any() else [], points[~at_origin]
    while len(left) and len(kept) <= MOST_POINTS:
        kept.append(left[0])
        left = left[np.hypot(*(left - left[0]).T) > same * (nearest + np.hypot(*left[0]))]
    unique = np.array(kept).reshape(-1, 2)
    return np.where(np.abs(unique) < _ROUNDING * nearest, 0.0, unique)


def _with_indices(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """(n, 3) points (n, 2) with their indices."""
    _, _, vxx, vxy, vyy = derivatives.at(points)
    eigenvalues = np.abs(np.linalg.eigvalsh(np.nan_to_num(np.array([[vxx, vxy], [vxy, vyy]])).transpose(2, 0, 1)))
    is_singular = eigenvalues.min(axis=1) <= SINGULAR_RATIO * eigenvalues.max(axis=1)
    return np.column_stack([points, np.where(is_singular, 0.0, np.sign(vxx * vyy - vxy * vxy))])
