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

from engine.expressions.calculus import derivative
from engine.expressions.graph import Graph, evaluate, make_graph
from engine.expressions.intervals import Enclosure, Interval, enclose
from engine.expressions.nodes import Expression, linear_combination
from engine.expressions.singularities import oblique_gradients
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
_SMALLEST_UNDEFINED, _SMALLEST = 2.0**-9, 2.0**-34
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
    """V and derivatives of it as programs.

    Attributes
    ----------
    slopes
        V, the derivatives along two directions, which vanish together at critical points only, and those along others.
    jacobian
        The x and y derivatives of the first and of the second of these two.
    curvatures
        V_xx, V_xy and V_yy.
    """

    slopes: Program
    jacobian: Program
    curvatures: Program

    @classmethod
    def of(cls, expression: Expression) -> Derivatives:
        """Those of an expression.

        Along a straight wall or valley the derivative is small, though those along x and y are large, so that it is the second.
        """
        along_x, along_y = derivative(expression, 0), derivative(expression, 1)
        oblique = [linear_combination([(b, along_x), (-a, along_y)]) for a, b in oblique_gradients(expression)]
        first, second, *others = [along_x, *oblique, along_y]
        return cls(
            make_graph((expression, first, second, *others)),
            make_graph(tuple(derivative(each, axis) for each in (first, second) for axis in (0, 1))),
            make_graph((derivative(along_x, 0), derivative(along_x, 1), derivative(along_y, 1))),
        )

    @property
    def operations(self) -> int:
        """Number of operations of the programs for a box."""
        return len(self.slopes[0].nodes) + len(self.jacobian[0].nodes)

    def slopes_at(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) the two derivatives at points (n, 2)."""
        return np.column_stack(evaluate(*self.slopes, *points.T)[1:3])

    def jacobian_at(self, points: np.ndarray) -> np.ndarray:
        """(n, 2, 2) their Jacobian matrix at points (n, 2)."""
        return np.column_stack(evaluate(*self.jacobian, *points.T)).reshape(-1, 2, 2)

    def hessian_at(self, points: np.ndarray) -> np.ndarray:
        """(n, 2, 2) the Hessian matrix of V at points (n, 2)."""
        vxx, vxy, vyy = evaluate(*self.curvatures, *points.T)
        return np.column_stack([vxx, vxy, vxy, vyy]).reshape(-1, 2, 2)


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
    found = found[np.abs(derivatives.hessian_at(found)).max(axis=(1, 2)) > _SUBNORMAL]
    distance = np.hypot(*found.T)
    nearest = float(distance[(distance >= _ZERO) & (distance <= 2.0**_OCTAVES)].min(initial=np.inf))
    if nearest == np.inf:
        origin = np.zeros((1, 2))
        is_one = len(found) or not derivatives.slopes_at(origin).any()
        return _with_indices(derivatives, origin if is_one else NO_POINTS)
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
    eigenvalues = np.abs(np.linalg.eigvalsh(derivatives.hessian_at(points[near])))
    flat = eigenvalues.min(axis=1) <= _SINGULAR_ON_A_CURVE * eigenvalues.max(axis=1)
    return bool(2 * np.count_nonzero(flat) > len(centres))


def _box(centres: np.ndarray, half: float) -> tuple[Interval, Interval]:
    x, y = (Interval(centre - half, centre + half) for centre in centres.T)
    return x, y


def _excludes_zero(slopes: Enclosure) -> np.ndarray:
    """(n,) whether a derivative vanishes nowhere in a box."""
    excluded: np.ndarray = np.any([each.excludes_zero() for each in slopes.values[1:]], axis=0)
    return excluded


def _solve(derivatives: Derivatives, centres: np.ndarray, half: float) -> tuple[np.ndarray, np.ndarray]:
    """(m, 2) the points that lie in boxes with one point each, and (n,) whether it is proved that a box has one or none.

    The operator of Krawczyk maps a box c ± h to K = c − Y f + (I − Y J)(± h), with the two derivatives f at c, their Jacobian
    matrix J on the box and Y its inverse at c. All points of the box lie in K; if K lies inside of it, it has exactly one.
    """
    jacobian = enclose(*derivatives.jacobian, *_box(centres, _ENLARGED * half))
    slopes = enclose(*derivatives.slopes, *_box(centres, 0.0))
    with np.errstate(all="ignore"):
        middle, spread = (each.reshape(-1, 2, 2) for each in _middle_and_spread(jacobian.values))
        slope, error = _middle_and_spread(slopes.values[1:3])
        inverse = _inverse(derivatives.jacobian_at(centres))
        step = -np.einsum("nij,nj->ni", inverse, slope)
        rest = np.abs(np.eye(2) - inverse @ middle) + np.abs(inverse) @ spread
        reach = _ENLARGED * half * rest.sum(axis=2) + np.einsum("nij,nj->ni", np.abs(inverse), error)
        reach = reach * (1.0 + _MARGIN) + _MARGIN * half
        known = jacobian.defined & slopes.defined & np.isfinite(step + reach).all(axis=1)
        single = known & (np.abs(step) + reach < _ENLARGED * half).all(axis=1)
        empty = known & (np.abs(step) - reach > half).any(axis=1)
    return _refined(derivatives, (centres + step)[single]), single | empty


def _middle_and_spread(values: list[Interval]) -> tuple[np.ndarray, np.ndarray]:
    """(n, k) the middles of k intervals, and half their lengths."""
    low, high = np.column_stack([each.low for each in values]), np.column_stack([each.high for each in values])
    return 0.5 * (low + high), 0.5 * (high - low)


def _inverse(matrices: np.ndarray) -> np.ndarray:
    """(n, 2, 2) inverse matrices; products of small entries do not underflow."""
    size = np.abs(matrices).max(axis=(1, 2))[:, None, None]
    (a, b), (c, d) = np.moveaxis(matrices / size, 0, -1)
    adjugate = np.moveaxis(np.array([[d, -b], [-c, a]]), -1, 0)
    inverse: np.ndarray = adjugate / (a * d - b * c)[:, None, None] / size
    return inverse


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
    with np.errstate(all="ignore"):
        step: np.ndarray = np.einsum("nij,nj->ni", _inverse(derivatives.jacobian_at(points)), derivatives.slopes_at(points))
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
    hessians = np.nan_to_num(derivatives.hessian_at(points))
    eigenvalues = np.linalg.eigvalsh(hessians)
    sizes = np.abs(eigenvalues)
    is_singular = sizes.min(axis=1) <= SINGULAR_RATIO * sizes.max(axis=1)
    return np.column_stack([points, np.where(is_singular, 0.0, np.sign(eigenvalues).prod(axis=1))])
