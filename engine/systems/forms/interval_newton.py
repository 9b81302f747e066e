"""Critical points in boxes: interval proofs that a box contains none, or exactly one, and Newton's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.expressions.calculus import curvatures, derivative, slopes
from engine.expressions.evaluation import evaluate
from engine.expressions.graph import Graph, make_graph
from engine.expressions.intervals import Enclosure, Interval, enclose
from engine.expressions.nodes import Expression, X, Y, expand, linear_combination
from engine.expressions.singularities import has_central_part, oblique_gradients, singular_bases

Program = tuple[Graph, tuple[float, ...]]
"""A graph and its numbers."""

# Factor by which the box of a proof is larger than the searched box, because a point may be on the edge of the searched box.
_ENLARGEMENT = 1.3
# Margin for the rounding errors of Krawczyk's operator, as a share of the box.
_MARGIN = 1e-9
# Number of steps of Newton's method that refine a point.
_REFINING_STEPS = 8
# Cost of operations on intervals in units of a sum or a product.
_COSTS = {"sin": 10, "cos": 10, "exp": 4, "log": 4, "power": 4}
# Sample points of a box, in units of half its side. They are slightly outside the edges, because a wall may run along an edge.
_SAMPLES = 1.1 * np.stack(np.meshgrid(*[np.linspace(-1.0, 1.0, 3)] * 2), axis=-1).reshape(-1, 2)


@dataclass(frozen=True)
class Derivatives:
    """V and its derivatives as programs.

    Attributes
    ----------
    value_and_slopes
        V, its derivatives along two directions that are not parallel, and its derivatives along further directions.
    jacobian
        The derivatives along x and y of the first two derivatives in `value_and_slopes`.
    curvatures
        V_xx, V_xy and V_yy.
    bases
        Divisors and arguments of roots and logarithms.
    """

    value_and_slopes: Program
    jacobian: Program
    curvatures: Program
    bases: Program

    @classmethod
    def of(cls, expression: Expression) -> Derivatives:
        """Return the derivatives of an expression.

        The second direction is along a straight wall, if there is one: the derivative of V along a wall is small, while those
        along x and y are large.
        """
        along_x, along_y = slopes(expression)
        oblique = [linear_combination([(b, along_x), (-a, along_y)]) for a, b in oblique_gradients(expression)]
        first, second, *other_slopes = [along_x, *oblique, along_y]
        if has_central_part(expression):
            # The derivative along circles around a body at the origin is also small.
            other_slopes.append(linear_combination([(1.0, expand(X, along_y)), (-1.0, expand(Y, along_x))]))
        return cls(
            make_graph((expression, first, second, *other_slopes)),
            make_graph(tuple(derivative(each, axis) for each in (first, second) for axis in (0, 1))),
            make_graph(curvatures(expression)),
            make_graph(singular_bases(expression)),
        )

    @property
    def operations(self) -> int:
        """Number of operations on intervals for a box, in units of a sum."""
        return sum(_COSTS.get(node.kind, 1) for graph, _ in (self.value_and_slopes, self.jacobian) for node in graph.nodes)

    def slopes_at(self, points: np.ndarray) -> np.ndarray:
        """Return the first two derivatives of V in `value_and_slopes` at points (n, 2), of the same shape."""
        return np.column_stack(evaluate(*self.value_and_slopes, *points.T)[1:3])

    def jacobian_at(self, points: np.ndarray) -> np.ndarray:
        """Return the Jacobian matrices of `slopes_at` at points (n, 2), of shape (n, 2, 2)."""
        return np.column_stack(evaluate(*self.jacobian, *points.T)).reshape(-1, 2, 2)

    def is_singular_in(self, centres: np.ndarray, half_side: float) -> np.ndarray:
        """Return whether a base has both signs, or is not defined, at nine points of each box, of shape (n,)."""
        x, y = np.moveaxis(centres[:, None] + half_side * _SAMPLES, -1, 0)
        is_singular = np.zeros(len(centres), bool)
        for base in evaluate(*self.bases, x, y):
            is_singular |= np.isnan(base).any(axis=1) | ((base < 0.0).any(axis=1) & (base > 0.0).any(axis=1))
        return is_singular

    def hessian_at(self, points: np.ndarray) -> np.ndarray:
        """Return the Hessian matrices of V at points (n, 2), of shape (n, 2, 2)."""
        vxx, vxy, vyy = evaluate(*self.curvatures, *points.T)
        return np.column_stack([vxx, vxy, vxy, vyy]).reshape(-1, 2, 2)


def box_intervals(centres: np.ndarray, half_side: float) -> tuple[Interval, Interval]:
    """Return the x and y intervals of square boxes, given by their centres (n, 2) and half a side."""
    x, y = (Interval(centre - half_side, centre + half_side) for centre in centres.T)
    return x, y


def excludes_zero(value_and_slopes: Enclosure) -> np.ndarray:
    """Return, for each box, whether at least one derivative vanishes nowhere in the box, of shape (n,)."""
    _value, *slopes = value_and_slopes.values
    return np.any([slope.excludes_zero() for slope in slopes], axis=0)


def solve_boxes(derivatives: Derivatives, centres: np.ndarray, half_side: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (m, 2) of boxes with exactly one point, and whether each box (n,) is proved to have one point or none.

    The operator of Krawczyk maps a box c ± h to K = c − Y f + (I − Y J)(± h). Here, f are the two derivatives at c, J is their
    Jacobian matrix on the box, and Y is the inverse of the Jacobian matrix at c. All critical points of the box are in K. If K is
    inside the box, the box has exactly one critical point.
    """
    jacobian = enclose(*derivatives.jacobian, *box_intervals(centres, _ENLARGEMENT * half_side))
    centre_values = enclose(*derivatives.value_and_slopes, *box_intervals(centres, 0.0))
    with np.errstate(all="ignore"):
        midpoint, radius = (each.reshape(-1, 2, 2) for each in _midpoint_and_radius(jacobian.values))
        slope, error = _midpoint_and_radius(centre_values.values[1:3])
        inverse = _inverse(derivatives.jacobian_at(centres))
        step = -np.einsum("nij,nj->ni", inverse, slope)
        # Bounds of |I − Y J|, and half the sides of K.
        deviation = np.abs(np.eye(2) - inverse @ midpoint) + np.abs(inverse) @ radius
        reach = _ENLARGEMENT * half_side * deviation.sum(axis=2) + np.einsum("nij,nj->ni", np.abs(inverse), error)
        reach = reach * (1.0 + _MARGIN) + _MARGIN * half_side
        is_known = jacobian.defined_everywhere & centre_values.defined_everywhere & np.isfinite(step + reach).all(axis=1)
        has_one = is_known & (np.abs(step) + reach < _ENLARGEMENT * half_side).all(axis=1)
        is_empty = is_known & (np.abs(step) - reach > half_side).any(axis=1)
    return refine(derivatives, (centres + step)[has_one]), has_one | is_empty


def _midpoint_and_radius(values: list[Interval]) -> tuple[np.ndarray, np.ndarray]:
    """Return the midpoints of k intervals and half their lengths, each of shape (n, k)."""
    low, high = np.column_stack([each.low for each in values]), np.column_stack([each.high for each in values])
    return 0.5 * (low + high), 0.5 * (high - low)


def _inverse(matrices: np.ndarray) -> np.ndarray:
    """Return inverse matrices, of shape (n, 2, 2). Products of small entries do not underflow."""
    magnitude = np.abs(matrices).max(axis=(1, 2))[:, None, None]
    (a, b), (c, d) = np.moveaxis(matrices / magnitude, 0, -1)
    adjugate = np.moveaxis(np.array([[d, -b], [-c, a]]), -1, 0)
    return adjugate / (a * d - b * c)[:, None, None] / magnitude


def refine(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Improve points (n, 2) by a fixed number of steps of Newton's method."""
    for _ in range(_REFINING_STEPS):
        points = points - newton_step(derivatives, points)
    return points


def newton_step(derivatives: Derivatives, points: np.ndarray) -> np.ndarray:
    """Return the steps of Newton's method from points (n, 2). The caller subtracts them."""
    with np.errstate(all="ignore"):
        step: np.ndarray = np.einsum("nij,nj->ni", _inverse(derivatives.jacobian_at(points)), derivatives.slopes_at(points))
    return step
