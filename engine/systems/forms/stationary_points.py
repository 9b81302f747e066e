"""Critical points of an expression in a stated region, with proof that there are no others.

The region is a disc about the origin with a radius of 16.2 times the distance of the nearest point. Newton's method finds this
distance from starts on rings, two per factor of 2 in radius. If no point is found, the distance is 1. Then the region is divided
into boxes. A box is left out if intervals prove that a derivative does not vanish in the box. A box is solved if the operator of
Krawczyk (1969, Computing 4, 187) proves that the box contains exactly one point. Other boxes are divided. Boxes that contain a
wall, where V is not defined, are divided down to a small size, then left out. Boxes around poles are divided down to the smallest
size.
"""

from __future__ import annotations

import numpy as np

from engine.expressions.intervals import enclose
from engine.systems.forms.form import NO_POINTS, NotIsolatedError, UndecidedError
from engine.systems.forms.interval_newton import Derivatives, box, excludes_zero, newton_step, refined, solve

MOST_POINTS = 60
"""Largest number of critical points in the region."""

# Regions, tried in turn: radius in units of the distance of the nearest critical point, and largest number of operations on
# boxes. 6e7 operations take a second. The next region is tried if V is not defined in the whole region, or if the region has too
# many points or needs too many operations.
_REGIONS = ((16.2, 30_000_000), (8.1, 10_000_000), (4.1, 5_000_000), (2.1, 5_000_000))
# The rings of starts have radii from 2^−24 to 2^24.
_OCTAVES = 24
# Number of rings per octave.
_PER_OCTAVE = 2
# Number of starts on a ring.
_ANGLES = 32
# Distance from the origin below which a point counts as the origin.
_ZERO = 2.0**-_OCTAVES
# Largest number of steps of Newton's method from a start.
_NEWTON_STEPS = 60
# Second derivatives up to this magnitude are near the subnormal numbers.
_SUBNORMAL = 1e-290
# Length of a step below which Newton's method has converged, relative to the distance from the origin.
_TOLERANCE = 1e-12
# Distance below which points are the same, relative to their distance from the origin plus the distance of the nearest point.
_SAME = 1e-8
# The same distance for degenerate points, whose places are less accurate.
_SAME_DEGENERATE = 1e-5
# Largest ratio of the eigenvalues of a singular Hessian. For polynomials, rounding errors of the coefficients decide
# (`critical_points`). For expressions, the error of the second derivatives is not known.
_SINGULAR_RATIO = 1e-10
# Coordinates below this, in units of the distance of the nearest point, are rounding errors of zero.
_ROUNDING = 1e-13

# Initial number of boxes along a side of the region.
_SIDE = 32
# Centres of the four parts of a box, in units of half the side of a part.
_QUARTERS = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
# Half the side of the smallest boxes on walls, in units of the distance of the nearest point.
_SMALLEST_ON_WALL = 2.0**-9
# Half the side of the smallest boxes elsewhere, in the same units.
_SMALLEST = 2.0**-34
# Largest distance of a box around a pole from a box in which V is not defined, in half sides of a box.
_AROUND_POLE = 64.0
# Largest number of boxes of one small size. If there are more, the points are tested for a curve.
_MANY_BOXES = 4_000
# Largest distance of a point of a curve from the centre of its box, in half sides: the reach of Newton's method.
_NEAR_BOX = 8.0
# Largest ratio of the eigenvalues of the Hessian at a point of a curve.
_SINGULAR_ON_A_CURVE = 1e-6


def find_stationary_points(derivatives: Derivatives, effort: float = 1.0) -> np.ndarray:
    """Find x, y and index of each point with ∇V = 0 in the region, of shape (n, 3).

    A point at the origin is exactly (0, 0). The index is 1 for a minimum or a maximum, −1 for a saddle and 0 for a point whose
    Hessian is singular to rounding.

    Parameters
    ----------
    derivatives
        V and its derivatives.
    effort
        Factor by which the limits on the operations are multiplied.

    Raises
    ------
    NotIsolatedError
        If the points form a curve.
    UndecidedError
        If there are too many points, V is not defined in a part of the region, or the proof takes too long.
    """
    rings = _rings(2.0 ** np.linspace(-_OCTAVES, _OCTAVES, 2 * _OCTAVES * _PER_OCTAVE + 1))
    roots = _newton(derivatives, rings)
    # Where V is flat, its slopes are subnormal numbers without significant digits.
    newton_points = roots[np.abs(derivatives.hessian_at(roots)).max(axis=(1, 2)) > _SUBNORMAL]
    distance = np.hypot(*newton_points.T)
    distance = distance[(distance >= _ZERO) & (distance <= 2.0**_OCTAVES)]
    nearest = float(distance.min()) if distance.size else 1.0
    problem = ""
    for factor, operations in _REGIONS:
        try:
            return _find_within(derivatives, newton_points, nearest, factor, int(effort * operations))
        except UndecidedError as error:
            # The first region has the most informative message.
            problem = problem or str(error)
    raise UndecidedError(problem)


def _find_within(
    derivatives: Derivatives, newton_points: np.ndarray, nearest: float, factor: float, operations: int
) -> np.ndarray:
    """Find the points up to `factor` times the distance `nearest`. The result must contain `newton_points`."""
    radius = factor * nearest
    region = f"within r = {radius:.6g}, {factor:g} times the distance of the nearest critical point from the origin"
    undecided = UndecidedError(f"Whether all critical points {region} are known is not decided within the limit on the work.")
    half = radius / _SIDE
    points = [NO_POINTS]
    side = radius * np.linspace(-1.0, 1.0, _SIDE + 1)
    # Centres of the boxes that are neither left out nor solved.
    centres = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    while len(centres) and half >= _SMALLEST * nearest:
        # Leave out boxes outside the disc.
        centres = centres[np.hypot(*np.maximum(np.abs(centres) - half, 0.0).T) <= radius]
        operations -= len(centres) * derivatives.operations
        if operations < 0:
            raise undecided
        slopes = enclose(*derivatives.slopes, *box(centres, half))
        if slopes.nowhere.any():
            raise UndecidedError(f"V is not defined everywhere {region}.")
        can_have_zero = ~excludes_zero(slopes)
        centres, is_defined = centres[can_have_zero], slopes.defined[can_have_zero]
        if half < _SMALLEST_ON_WALL * nearest:
            centres = centres[is_defined | ~derivatives.is_singular_in(centres, half)]
            if len(centres) > _MANY_BOXES and _lie_on_curve(derivatives, centres, half):
                raise NotIsolatedError
        roots, is_solved = solve(derivatives, centres, half)
        points.append(roots)
        half *= 0.5
        centres = (centres[~is_solved][:, None] + half * _QUARTERS).reshape(-1, 2)
    all_roots = np.concatenate(points)
    unique = _distinct(all_roots[np.hypot(*all_roots.T) <= radius], nearest, _SAME)
    # The remaining boxes are around poles or degenerate points.
    is_defined = enclose(*derivatives.slopes, *box(centres, half)).defined
    is_at_pole = _are_near(centres, centres[~is_defined], _AROUND_POLE * half)
    degenerate = _distinct(centres[~is_at_pole], nearest, _SAME_DEGENERATE)
    if len(unique) + len(degenerate) > MOST_POINTS:
        raise UndecidedError(f"V has more than {MOST_POINTS} critical points {region}.")
    all_points = np.concatenate([unique, degenerate])
    expected = newton_points[np.hypot(*newton_points.T) <= radius]
    if not _are_near(expected, all_points, _SAME_DEGENERATE * (nearest + np.hypot(*expected.T))).all():
        raise undecided
    return np.concatenate([_with_indices(derivatives, unique), np.column_stack([degenerate, np.zeros(len(degenerate))])])


def _are_near(points: np.ndarray, others: np.ndarray, distance: float | np.ndarray) -> np.ndarray:
    """Return whether each point (n, 2) is within a distance of any of the others (m, 2)."""
    nearest_distance = np.hypot(*np.moveaxis(points[:, None] - others, -1, 0)).min(axis=1, initial=np.inf)
    return nearest_distance <= distance


def _lie_on_curve(derivatives: Derivatives, centres: np.ndarray, half: float) -> bool:
    """Return whether most boxes are near a point with a singular Hessian."""
    points = refined(derivatives, centres)
    is_near = (np.abs(points - centres) <= _NEAR_BOX * half).all(axis=1)
    eigenvalues = np.abs(np.linalg.eigvalsh(derivatives.hessian_at(points[is_near])))
    is_singular = eigenvalues.min(axis=1) <= _SINGULAR_ON_A_CURVE * eigenvalues.max(axis=1)
    return bool(2 * np.count_nonzero(is_singular) > len(centres))


def _rings(radii: np.ndarray) -> np.ndarray:
    """Return points (n, 2) on circles, but not on the axes, where symmetry can lead Newton's method to the same point again."""
    angle = 0.1 + 2.0 * np.pi / _ANGLES * np.arange(_ANGLES)
    return np.stack([np.outer(radii, np.cos(angle)), np.outer(radii, np.sin(angle))], axis=-1).reshape(-1, 2)


def _newton(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return the points (n, 2) to which Newton's method converges, with repetitions."""
    roots = [NO_POINTS]
    for _ in range(_NEWTON_STEPS):
        step = newton_step(derivatives, points)
        length = np.hypot(*step.T)
        has_converged = length <= _TOLERANCE * np.maximum(np.hypot(*points.T), _ZERO)
        points = points - step
        roots.append(points[has_converged])
        points = points[~has_converged & np.isfinite(length)]
    return np.concatenate(roots)


def _distinct(points: np.ndarray, nearest: float, same: float) -> np.ndarray:
    """Remove repetitions, and make points on the axes and at the origin exact."""
    distance = np.hypot(*points.T)
    is_origin = distance < max(_ZERO, same * nearest)
    kept = [np.zeros(2)] if is_origin.any() else []
    remaining = points[~is_origin]
    while len(remaining) and len(kept) <= MOST_POINTS:
        first = remaining[0]
        kept.append(first)
        remaining = remaining[np.hypot(*(remaining - first).T) > same * (nearest + np.hypot(*first))]
    unique = np.array(kept).reshape(-1, 2)
    return np.where(np.abs(unique) < _ROUNDING * nearest, 0.0, unique)


def _with_indices(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return points (n, 2) with their indices, of shape (n, 3)."""
    hessians = np.nan_to_num(derivatives.hessian_at(points))
    eigenvalues = np.linalg.eigvalsh(hessians)
    magnitudes = np.abs(eigenvalues)
    is_singular = magnitudes.min(axis=1) <= _SINGULAR_RATIO * magnitudes.max(axis=1)
    return np.column_stack([points, np.where(is_singular, 0.0, np.sign(eigenvalues).prod(axis=1))])
