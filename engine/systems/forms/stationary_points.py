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
from engine.systems.forms.interval_newton import Derivatives, box_intervals, excludes_zero, newton_step, refine, solve_boxes

MOST_POINTS = 60
"""Largest number of critical points in the region."""

# Regions, tried in turn: radius in units of the distance of the nearest critical point, and largest number of operations on
# boxes. 6e7 operations take a second. The next region is tried if V is not defined in the whole region, or if the region has too
# many points or needs too many operations.
_REGIONS = ((16.2, 30_000_000), (8.1, 10_000_000), (4.1, 5_000_000), (2.1, 5_000_000))
# The rings of starts have radii from 2^−24 to 2^24.
_OCTAVES = 24
# Number of rings per octave.
_RINGS_PER_OCTAVE = 2
# Number of starts on a ring.
_STARTS_PER_RING = 32
# Distance from the origin below which a point counts as the origin.
_ORIGIN_RADIUS = 2.0**-_OCTAVES
# Largest number of steps of Newton's method from a start.
_NEWTON_STEPS = 60
# Second derivatives up to this magnitude do not count, because they are near the subnormal numbers.
_SMALLEST_CURVATURE = 1e-290
# Length of a step below which Newton's method has converged, relative to the distance from the origin.
_STEP_TOLERANCE = 1e-12
# Largest slope at a point, relative to its largest second derivative times its distance from the origin. Where the Hessian is
# singular to rounding, a step can be 0 although the slope is not. The slope of exp(k r) is 1/(k r) in this unit, and k r is at
# most 710, or a few times as much off the direction in which the exponent grows.
_SLOPE_TOLERANCE = 1e-4
# Distance up to which points are the same, relative to their distance from the origin plus that of the nearest point.
_DUPLICATE_TOLERANCE = 1e-8
# The same distance for degenerate points, whose places are less accurate.
_DEGENERATE_TOLERANCE = 1e-5
# Largest ratio of the eigenvalues of a singular Hessian. For polynomials, rounding errors of the coefficients decide
# (`critical_points`). For expressions, the error of the second derivatives is not known.
_SINGULAR_RATIO = 1e-10
# Coordinates below this, in units of the distance of the nearest point, are rounding errors of zero.
_ROUNDING = 1e-13

# Message if the search needs too many operations or misses a point, with {} for the region.
_UNDECIDED = "Whether all critical points {} are known is not decided within the limit on the work."

# Radius of the region in half sides of an initial box; even, so that one box is centred on the origin.
_HALF_SIDES_PER_RADIUS = 32
# Centres of the four parts of a box, in units of half the side of a part.
_QUARTERS = np.array([[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]])
# Half the side of the smallest boxes on walls, in units of the distance of the nearest point.
_SMALLEST_HALF_SIDE_ON_WALL = 2.0**-9
# Half the side of the smallest boxes elsewhere, in the same units.
_SMALLEST_HALF_SIDE = 2.0**-34
# Largest distance of a box around a pole from a box in which V is not defined, in half sides of a box.
_POLE_REACH = 64.0
# Largest number of boxes of one small size. If there are more, the points are tested for a curve.
_MANY_BOXES = 4_000
# Largest distance of a point of a curve from the centre of its box, in half sides: the reach of Newton's method.
_NEWTON_REACH = 8.0
# Largest ratio of the eigenvalues of the Hessian at a point of a curve.
_SINGULAR_RATIO_ON_CURVE = 1e-6


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
    starts = _points_on_rings(2.0 ** np.linspace(-_OCTAVES, _OCTAVES, 2 * _OCTAVES * _RINGS_PER_OCTAVE + 1))
    roots = _newton_roots(derivatives, starts)
    # Where V is flat, its slopes are subnormal numbers without significant digits.
    newton_points = roots[np.abs(derivatives.hessian_at(roots)).max(axis=(1, 2)) > _SMALLEST_CURVATURE]
    distances = np.hypot(*newton_points.T)
    distances = distances[(distances >= _ORIGIN_RADIUS) & (distances <= 2.0**_OCTAVES)]
    nearest = float(distances.min()) if distances.size else 1.0
    errors = []
    for factor, operations in _REGIONS:
        try:
            return _find_within(derivatives, newton_points, nearest, factor, int(effort * operations))
        except UndecidedError as error:
            errors.append(error)
    # The largest region, which is the first, has the most informative message.
    raise errors[0]


def _find_within(
    derivatives: Derivatives, newton_points: np.ndarray, nearest: float, factor: float, operations: int
) -> np.ndarray:
    """Find the points up to `factor` times the distance `nearest`. The result must contain `newton_points`."""
    radius = factor * nearest
    region = f"within r = {radius:.6g}, {factor:g} times the distance of the nearest critical point from the origin"
    solved_points, centres, half_side = _divide_boxes(derivatives, nearest, radius, operations, region)
    unique = _distinct(solved_points[np.hypot(*solved_points.T) <= radius], nearest, _DUPLICATE_TOLERANCE)
    # The remaining boxes are around poles or degenerate points.
    is_defined = enclose(*derivatives.value_and_slopes, *box_intervals(centres, half_side)).defined_everywhere
    is_at_pole = _are_near(centres, centres[~is_defined], _POLE_REACH * half_side)
    degenerate = _distinct(centres[~is_at_pole], nearest, _DEGENERATE_TOLERANCE)
    if len(unique) + len(degenerate) > MOST_POINTS:
        raise UndecidedError(f"V has more than {MOST_POINTS} critical points {region}.")
    all_points = np.concatenate([unique, degenerate])
    expected = newton_points[np.hypot(*newton_points.T) <= radius]
    if not _are_near(expected, all_points, _DEGENERATE_TOLERANCE * (nearest + np.hypot(*expected.T))).all():
        raise UndecidedError(_UNDECIDED.format(region))
    return np.concatenate([_with_indices(derivatives, unique), np.column_stack([degenerate, np.zeros(len(degenerate))])])


def _divide_boxes(
    derivatives: Derivatives, nearest: float, radius: float, operations: int, region: str
) -> tuple[np.ndarray, np.ndarray, float]:
    """Divide the region into boxes, until each is left out, is solved or has the smallest size.

    Returns the points (n, 2) of solved boxes, the centres (m, 2) of the remaining boxes, and half the side of these boxes. The
    text `region` is for messages.
    """
    half_side = radius / _HALF_SIDES_PER_RADIUS
    solved_points = [NO_POINTS]
    side = radius * np.linspace(-1.0, 1.0, _HALF_SIDES_PER_RADIUS + 1)
    # Centres of the boxes that are neither left out nor solved.
    centres = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    while len(centres) and half_side >= _SMALLEST_HALF_SIDE * nearest:
        # Leave out boxes outside the disc.
        centres = centres[np.hypot(*np.maximum(np.abs(centres) - half_side, 0.0).T) <= radius]
        operations -= len(centres) * derivatives.operations
        if operations < 0:
            raise UndecidedError(_UNDECIDED.format(region))
        enclosure = enclose(*derivatives.value_and_slopes, *box_intervals(centres, half_side))
        if enclosure.defined_nowhere.any():
            raise UndecidedError(f"V is not defined everywhere {region}.")
        can_have_zero = ~excludes_zero(enclosure)
        centres, is_defined = centres[can_have_zero], enclosure.defined_everywhere[can_have_zero]
        if half_side < _SMALLEST_HALF_SIDE_ON_WALL * nearest:
            centres = centres[is_defined | ~derivatives.is_singular_in(centres, half_side)]
            if len(centres) > _MANY_BOXES and _lie_on_curve(derivatives, centres, half_side):
                raise NotIsolatedError
        roots, is_solved = solve_boxes(derivatives, centres, half_side)
        solved_points.append(roots)
        half_side *= 0.5
        centres = (centres[~is_solved][:, None] + half_side * _QUARTERS).reshape(-1, 2)
    return np.concatenate(solved_points), centres, half_side


def _are_near(points: np.ndarray, targets: np.ndarray, distance: float | np.ndarray) -> np.ndarray:
    """Return whether each point (n, 2) is within a distance, a number or (n,), of any of the targets (m, 2)."""
    nearest_distance = np.hypot(*np.moveaxis(points[:, None] - targets, -1, 0)).min(axis=1, initial=np.inf)
    return nearest_distance <= distance


def _lie_on_curve(derivatives: Derivatives, centres: np.ndarray, half_side: float) -> bool:
    """Return whether most boxes, with centres (n, 2), are near a point with a singular Hessian."""
    points = refine(derivatives, centres)
    is_near = (np.abs(points - centres) <= _NEWTON_REACH * half_side).all(axis=1)
    eigenvalues = np.abs(np.linalg.eigvalsh(derivatives.hessian_at(points[is_near])))
    is_singular = eigenvalues.min(axis=1) <= _SINGULAR_RATIO_ON_CURVE * eigenvalues.max(axis=1)
    return bool(2 * np.count_nonzero(is_singular) > len(centres))


def _points_on_rings(radii: np.ndarray) -> np.ndarray:
    """Return points (n, 2) on circles, but not on the axes, from which symmetry can lead Newton's method to the same points."""
    angle = 0.1 + 2.0 * np.pi / _STARTS_PER_RING * np.arange(_STARTS_PER_RING)
    return np.stack([np.outer(radii, np.cos(angle)), np.outer(radii, np.sin(angle))], axis=-1).reshape(-1, 2)


def _newton_roots(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return the points (m, 2) to which Newton's method converges from starts (n, 2), with repetitions."""
    roots = [NO_POINTS]
    for _ in range(_NEWTON_STEPS):
        step = newton_step(derivatives, points)
        length = np.hypot(*step.T)
        has_converged = length <= _STEP_TOLERANCE * np.maximum(np.hypot(*points.T), _ORIGIN_RADIUS)
        points = points - step
        roots.append(points[has_converged])
        points = points[~has_converged & np.isfinite(length)]
    return _without_slopes(derivatives, np.concatenate(roots))


def _without_slopes(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return those points (m, 2) at which V has no slope, up to rounding."""
    slope, curvature = np.abs(derivatives.slopes_at(points)).max(axis=1), np.abs(derivatives.jacobian_at(points)).max(axis=(1, 2))
    distance = np.maximum(np.hypot(*points.T), _ORIGIN_RADIUS)
    return points[slope <= _SLOPE_TOLERANCE * curvature * distance]


def _distinct(points: np.ndarray, nearest: float, tolerance: float) -> np.ndarray:
    """Return points (m, 2) without repetitions; points on the axes and at the origin are exact."""
    distance = np.hypot(*points.T)
    is_origin = distance < max(_ORIGIN_RADIUS, tolerance * nearest)
    kept = [np.zeros(2)] if is_origin.any() else []
    remaining = points[~is_origin]
    # One point above the limit suffices for a refusal.
    while len(remaining) and len(kept) <= MOST_POINTS:
        first = remaining[0]
        kept.append(first)
        remaining = remaining[np.hypot(*(remaining - first).T) > tolerance * (nearest + np.hypot(*first))]
    unique = np.array(kept).reshape(-1, 2)
    return np.where(np.abs(unique) < _ROUNDING * nearest, 0.0, unique)


def _with_indices(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return points (n, 2) with their indices, of shape (n, 3)."""
    hessians = np.nan_to_num(derivatives.hessian_at(points))
    eigenvalues = np.linalg.eigvalsh(hessians)
    magnitudes = np.abs(eigenvalues)
    is_singular = magnitudes.min(axis=1) <= _SINGULAR_RATIO * magnitudes.max(axis=1)
    return np.column_stack([points, np.where(is_singular, 0.0, np.sign(eigenvalues).prod(axis=1))])
