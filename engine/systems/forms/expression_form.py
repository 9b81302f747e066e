"""Potentials that are expressions of x and y with powers, roots, exp, log, sin and cos."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from engine.expressions.calculus import curvatures, derivative, replace_parts, slopes, substitute
from engine.expressions.evaluation import evaluate, evaluate_at
from engine.expressions.graph import make_graph
from engine.expressions.nodes import Expression, Sum, X, Y, as_terms, from_terms, linear_combination, multiply, number, power
from engine.expressions.parity import EVEN, is_even, parity
from engine.expressions.polynomials import Terms
from engine.expressions.singularities import repeated_factors, singular_bases
from engine.expressions.text import write_expression
from engine.foundations.arrays import read_only
from engine.systems.forms.form import NO_POINTS, Flow, NotIsolatedError, UndecidedError
from engine.systems.forms.interval_newton import Derivatives
from engine.systems.forms.polynomial_form import PolynomialForm, checked_form
from engine.systems.forms.stationary_points import find_stationary_points
from engine.systems.well_units import nearest_power_of_two

MOST_CONVOLUTIONS = 120
"""Largest number of products and functions in the graph of gradient and Hessian. It limits their cost and compile time."""

# Number of cached searches for zeros, of about 0.1 kB each.
_CACHED_SEARCHES = 1024
# Largest number of operations of a search for zeros, as a share of the limit for critical points.
_EFFORT = 0.1

# Highest order n of a rotational symmetry, by 2π/n, that is searched.
_HIGHEST_ORDER = 12
# Largest difference of V before and after a rotation that leaves V unchanged, relative to the largest V on the circle.
_ROTATION_ERROR = 1e-11
# Radii of the circles on which V is compared, dimensionless.
_RADII = 2.0 ** np.arange(-6.0, 3.0)[:, None]
# Angles of the points on each circle, in radians. They have no symmetry of their own.
_ANGLES = np.array([0.2, 0.9, 2.1, 3.3, 4.6, 5.9])
# Number of bisections that locate a change of sign.
_BISECTIONS = 52
# Values of an expression up to this count as 0, relative to its curvature or to its largest term.
_ZERO_TOLERANCE = 1e-14
# An angle in radians that is not 2π/n: only V with all rotations is invariant.
_ARBITRARY_ANGLE = 1.0


@dataclass(frozen=True)
class ExpressionForm:
    """V as an expression, with numbers in place of its parameters.

    Polynomials that are divisors, or arguments of roots and logarithms, are expanded about their isolated zero: (x − 1)² + y² in
    place of x² − 2x + y² + 1, which would lose digits near the zero.
    """

    expression: Expression

    def __post_init__(self) -> None:
        # An expression that is refused because of its size is not searched for zeros.
        if self.limits_refusal() is None:
            object.__setattr__(self, "expression", replace_parts(self.expression, _expansions_about_zeros(self.expression)))

    def __repr__(self) -> str:
        return f"ExpressionForm({self.text})"

    @property
    def definition(self) -> Expression:
        """The expression, from which kernels are generated."""
        return self.expression

    @property
    def text(self) -> str:
        """The formula."""
        return write_expression(self.expression)

    @property
    def length(self) -> float:
        """The distance of the nearest critical point from the origin, rounded to a power of 2; 1 if no such point is known."""
        try:
            distance = np.hypot(*self.find_critical_points()[:, :2].T)
        except (UndecidedError, NotIsolatedError):
            return 1.0
        distance = distance[distance > 0.0]
        return nearest_power_of_two(float(distance.min())) if distance.size else 1.0

    @property
    def mirror_in_x(self) -> bool:
        """Whether V contains only even powers of x."""
        return parity(self.expression, 0) == EVEN

    @property
    def mirror_in_y(self) -> bool:
        """Whether V contains only even powers of y."""
        return parity(self.expression, 1) == EVEN

    @property
    def has_constant(self) -> bool:
        """Whether V has a constant term."""
        return isinstance(self.expression, Sum) and self.expression.constant != 0.0

    def value(self, x: Any, y: Any) -> Any:
        """Return V at (x, y). Arrays broadcast. The value is NaN where V is not defined."""
        return self._evaluate(x, y, self.expression)[0]

    def magnitude(self, x: Any, y: Any) -> Any:
        """Return |V| at (x, y), of which rounding errors are a share unless terms cancel. Arrays broadcast."""
        return np.abs(self.value(x, y))

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return (V_x, V_y)."""
        along_x, along_y = self._evaluate(x, y, *slopes(self.expression))
        return along_x, along_y

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """Return (V_xx, V_xy, V_yy)."""
        vxx, vxy, vyy = self._evaluate(x, y, *curvatures(self.expression))
        return vxx, vxy, vyy

    @staticmethod
    def _evaluate(x: Any, y: Any, *expressions: Expression) -> list[Any]:
        """Return the values of expressions at (x, y)."""
        graph, numbers = make_graph(expressions)
        # The index () makes numbers of arrays without axes.
        return [value[()] for value in evaluate(graph, numbers, x, y)]

    def force(self, axis: int) -> ExpressionForm:
        """Return −∂V/∂x (axis 0) or −∂V/∂y (axis 1)."""
        return ExpressionForm(linear_combination([(-1.0, derivative(self.expression, axis))]))

    def find_critical_points(self) -> np.ndarray:
        """Find critical points in a region and their indices, of shape (n, 3); see `engine.systems.forms.stationary_points`."""
        found = self._search_result
        if isinstance(found, Exception):
            raise type(found)(*found.args)
        return found

    @cached_property
    def _search_result(self) -> np.ndarray | NotIsolatedError | UndecidedError:
        """The critical points, or the error of the search, which takes seconds."""
        if any(self._changes_sign(base) for base in repeated_factors(self.expression)):
            return NotIsolatedError()
        try:
            return find_stationary_points(Derivatives.of(self.expression))
        except (NotIsolatedError, UndecidedError) as error:
            return error

    def _changes_sign(self, base: Expression) -> bool:
        """Return whether an expression has values of both signs at the points of the circles."""
        values = self._evaluate(_RADII * np.cos(_ANGLES), _RADII * np.sin(_ANGLES), base)[0]
        return bool(np.any(values < 0.0) and np.any(values > 0.0))

    def descent_flow(self, length: float, sign: float) -> Flow:
        """Return the flow −sign ∇V with limited speed.

        The limit is the slope of the quadratic part of V at `length`; with a body at the origin, the mean slope at `length`.
        """
        curvature = np.abs(self.hessian(0.0, 0.0)).max()
        if np.isfinite(curvature):
            largest_speed = float(length * curvature)
        else:
            slopes_around = self.gradient(length * np.cos(_ANGLES), length * np.sin(_ANGLES))
            largest_speed = float(np.hypot(*slopes_around).mean())

        graph, numbers = make_graph(slopes(self.expression))

        def velocity(_time: float, place: np.ndarray) -> np.ndarray:
            # Products of Python's numbers give no warning where exponentials overflow.
            along_x, along_y = map(float, evaluate_at(graph, numbers, *place.tolist()))
            factor = -sign / (1.0 + math.hypot(along_x, along_y) / largest_speed)
            return np.array([factor * along_x, factor * along_y])

        return velocity

    @cached_property
    def singular_points(self) -> np.ndarray:
        """Isolated zeros of divisors and of the arguments of roots and logarithms, of shape (n, 2)."""
        zeros = [_isolated_zeros(base) for base in singular_bases(self.expression)]
        return read_only(np.concatenate([NO_POINTS, *zeros]))

    def points_on_singular_curves(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return points (n, 2) at which a divisor, or the argument of a root or logarithm, changes its sign.

        The changes are searched between neighbours on a grid of points x, y, of two dimensions each.
        """
        lines = ((x, y), (x.T, y.T))
        changes = [self._sign_changes(base, *line) for base in singular_bases(self.expression) for line in lines]
        return np.concatenate([NO_POINTS, *changes])

    def _sign_changes(self, base: Expression, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Return the points (n, 2) at which an expression changes its sign between neighbours on lines, found by bisection."""
        points, sign = np.stack([x, y], axis=-1), np.sign(self._evaluate(x, y, base)[0])
        changes = sign[:, :-1] * sign[:, 1:] < 0.0
        first, last, first_sign = points[:, :-1][changes], points[:, 1:][changes], sign[:, :-1][changes]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (first + last)
            is_before = (np.sign(self._evaluate(*middle.T, base)[0]) == first_sign)[:, None]
            first, last = np.where(is_before, middle, first), np.where(is_before, last, middle)
        return 0.5 * (first + last)

    def plus(self, terms: Terms) -> ExpressionForm:
        """Return V plus a polynomial."""
        return ExpressionForm(linear_combination([(1.0, self.expression), (1.0, from_terms(terms))]))

    def scaled(self, length: float, energy: float) -> ExpressionForm:
        """Return V(length x, length y) / energy, in units of length and energy."""
        x, y = (linear_combination([(length, axis)]) for axis in (X, Y))
        return ExpressionForm(linear_combination([(1.0 / energy, substitute(self.expression, x, y))]))

    def with_parameters(self, omega_1: float, omega_2: float, epsilon: float) -> ExpressionForm:
        """Return ε V, but keep its constant and linear terms about the origin, and scale its quadratic terms by ω1 and ω2."""
        vxx, vxy, vyy = map(float, self.hessian(0.0, 0.0))
        along_x, along_y = map(float, self.gradient(0.0, 0.0))
        changes = {
            (0, 0): float(self.value(0.0, 0.0)) * (1.0 - epsilon),
            (1, 0): along_x * (1.0 - epsilon),
            (0, 1): along_y * (1.0 - epsilon),
            (2, 0): 0.5 * vxx * (omega_1**2 - epsilon),
            (1, 1): vxy * (omega_1 * omega_2 - epsilon),
            (0, 2): 0.5 * vyy * (omega_2**2 - epsilon),
        }
        return ExpressionForm(linear_combination([(epsilon, self.expression), (1.0, from_terms(changes))]))

    def moved(self, x: float, y: float) -> ExpressionForm:
        """Return V with the origin moved to (x, y)."""
        axes = (linear_combination([(1.0, axis), (place, number(1.0))]) for axis, place in ((X, x), (Y, y)))
        return ExpressionForm(substitute(self.expression, *axes))

    def count_rotations(self) -> int:
        """Return the largest n of the rotations 2π/n that leave values of V on circles unchanged; 0 for all rotations."""
        if self._is_invariant(_ARBITRARY_ANGLE):
            return 0
        return next((n for n in range(_HIGHEST_ORDER, 1, -1) if self._is_invariant(2.0 * math.pi / n)), 1)

    def _is_invariant(self, angle: float) -> bool:
        """Return whether a rotation by an angle in radians leaves V unchanged on the circles where V is defined."""
        value, rotated = (self.value(_RADII * np.cos(a), _RADII * np.sin(a)) for a in (_ANGLES, _ANGLES + angle))
        is_defined = np.isfinite(value).all(axis=1) & np.isfinite(rotated).all(axis=1)
        error = np.abs(value[is_defined] - rotated[is_defined]).max(axis=1)
        return bool(is_defined.any() and np.all(error <= _ROTATION_ERROR * np.abs(value[is_defined]).max(axis=1)))

    def is_even_in(self, axis: int) -> bool:
        """Return whether a change of sign of x (axis 0) or y (axis 1) leaves V unchanged, also if it exchanges terms of V."""
        return is_even(self.expression, axis)

    def limits_refusal(self) -> str | None:
        """Return a sentence if V or its derivatives are too large; otherwise None.

        V is checked first, because derivatives can be a hundred times as large as V.
        """
        graphs = (
            ("V has", lambda: (self.expression,)),
            ("The first derivatives of V have", lambda: slopes(self.expression)),
            ("The first and second derivatives of V have", lambda: (*slopes(self.expression), *curvatures(self.expression))),
        )
        for subject, expressions in graphs:
            graph, _ = make_graph(expressions())
            if graph.convolutions > MOST_CONVOLUTIONS:
                return f"{subject} {graph.convolutions} products and functions; at most {MOST_CONVOLUTIONS} are allowed."
        return None


def _expansions_about_zeros(expression: Expression) -> dict[Expression, Expression]:
    """Return expansions about their zero of the singular bases that are polynomials with one isolated zero off the origin."""
    expansions = {}
    for base in singular_bases(expression):
        terms, zeros = as_terms(base), _isolated_zeros(base)
        if terms is not None and len(zeros) == 1 and zeros.any():
            expansions[base] = _expand_about(terms, *zeros[0].tolist())
    return expansions


Form = PolynomialForm | ExpressionForm
"""A function V(x, y) with its derivatives, immutable and hashable. Equal forms have results that are equal to the bit."""


def as_form(given: Any) -> Form:
    """Return the form of an expression, or of the terms of a polynomial; ValueError if they are invalid."""
    if isinstance(given, PolynomialForm | ExpressionForm):
        return given
    return ExpressionForm(given) if isinstance(given, Expression) else checked_form(given)


def _expand_about(terms: Terms, a: float, b: float) -> Expression:
    """Return a polynomial as Σ c (x − a)^k (y − b)^m, without coefficients that are rounding errors of zero."""
    moved: dict[tuple[int, int], float] = {}
    for (i, j), c in terms.items():
        for k, m in np.ndindex(i + 1, j + 1):
            moved[k, m] = moved.get((k, m), 0.0) + c * math.comb(i, k) * math.comb(j, m) * a ** (i - k) * b ** (j - m)
    # Magnitudes of the terms at the distance of the zero from the origin.
    magnitudes = {(k, m): abs(c) * math.hypot(a, b) ** (k + m) for (k, m), c in moved.items()}
    largest = max(magnitudes.values())
    kept = {powers: c for powers, c in moved.items() if magnitudes[powers] > _ZERO_TOLERANCE * largest}
    x, y = (linear_combination([(1.0, axis), (-place, number(1.0))]) for axis, place in ((X, a), (Y, b)))
    return linear_combination((c, multiply(power(x, k), power(y, m))) for (k, m), c in kept.items())


@lru_cache(maxsize=_CACHED_SEARCHES)
def _isolated_zeros(expression: Expression) -> np.ndarray:
    """Return the critical points (n, 2) at which an expression is 0 up to rounding; none if they form a curve or are unknown."""
    terms = as_terms(expression)
    form = ExpressionForm(expression) if terms is None else PolynomialForm(tuple((i, j, c) for (i, j), c in terms.items()))
    try:
        if isinstance(form, ExpressionForm):
            points = find_stationary_points(Derivatives.of(form.expression), _EFFORT)[:, :2]
        else:
            points = form.find_critical_points()[:, :2]
    except (NotIsolatedError, UndecidedError):
        return NO_POINTS
    curvature = np.abs(np.broadcast_arrays(*form.hessian(*points.T))).max(axis=0)
    scale = curvature * (1.0 + (points**2).sum(axis=1))
    return points[np.abs(form.value(*points.T)) <= _ZERO_TOLERANCE * scale]
