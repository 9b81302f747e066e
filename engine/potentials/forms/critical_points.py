"""All real common roots of two polynomials in x and y, found by eliminating y, and a check for missing ones.

Let S(x) be the Sylvester matrix of the two polynomials, taken as polynomials in y. S(x) is singular exactly at the x of their
common roots. det S(x) = 0 is a polynomial eigenvalue problem, so the eigenvalues of its companion pencil are these x. Newton's
method refines them, and starts on a grid find roots whose eigenvalues are too ill-conditioned.
"""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal, localcontext
from typing import Any

import numpy as np

from engine.polynomials import Terms, degree, derivative, evaluate, largest_coefficients, substitute
from engine.potentials.forms.common_factor import have_common_factor
from engine.results.arrays import read_only

# Arbitrary angles: rotated by them, the polynomials have nonzero leading coefficients and roots with different x. And lengths, as
# the eigenvalues of roots that are far away in units of one length are ill-conditioned.
_ELIMINATIONS = ((0.7390851332151607, 1.0), (2.1, 1.0), (0.7390851332151607, 2.0**4), (2.1, 2.0**8))
# All lengths below are in units of `characteristic_length`.
_IMAGINARY_TOLERANCE = 1e-3
_SIMPLE_ROOT_TOLERANCE = 1e-8
# Newton's method converges slowly to a degenerate root and stops at this distance from it.
_DEGENERATE_ROOT_TOLERANCE = 1e-3
# Largest ratio of the singular values of a Jacobian that counts as singular.
_SINGULAR_RATIO = 1e-6
_RESIDUAL_TOLERANCE = 1e-12
# At the distance of `_DEGENERATE_ROOT_TOLERANCE`, a Jacobian above this exceeds the residual tolerance.
_ZERO_JACOBIAN = 1e-8
_NEWTON_STEPS = 60
_MANY_DIGITS = 60
# Limit on the steps with many digits, about 0.1 ms each, for all points. Potentials with a well need less than 200.
_MOST_EXACT_STEPS = 16_000
_GRID = np.linspace(-3.0, 3.0, 31)
# Eigenvalues beyond this distance are infinite ones with rounding errors, and Newton's method is on its way to infinity.
_LARGEST_ROOT = 1e5

NO_POINTS = read_only(np.empty((0, 2)))
"""(0, 2) an empty list of points."""

# Sample points of a circle, to start with and at most. A turn of the slope within 1e-9 radians needs some 30 more than the first.
_SAMPLES, _MOST_SAMPLES = 721, 20_000
# Largest rotation of a vector, in radians, and largest change of the logarithm of its length between neighbouring sample points
# of a circle. A vector that turns fast is short there: its length shows a whole turn between two points.
_LARGEST_ROTATION, _LARGEST_GROWTH = 0.5, 1.0


_ON_A_CURVE = "the two polynomials vanish along a common curve: their common roots are not isolated points"
_TOO_DEGENERATE = "Whether all points where the force vanishes are isolated cannot be decided with the steps allowed."


class NotIsolatedError(ValueError):
    """The common roots of two polynomials form a curve, so they cannot be listed."""


class UndecidedError(ValueError):
    """The common roots are not found within the limit on the steps in exact arithmetic."""


def find_critical_points(first: Terms, second: Terms) -> np.ndarray:
    """The common real roots of two polynomials in two variables.

    Parameters
    ----------
    first, second
        {(i, j): c}: the polynomials Σ c x^i y^j, for critical points V_x and V_y; tested up to degree 11.

    Returns
    -------
    (n, 2) array of the points, each once, in no particular order.

    Raises
    ------
    NotIsolatedError
        If a polynomial is zero everywhere, or both vanish along a curve.
    UndecidedError
        If there are too many degenerate points to refine, as around a root of high multiplicity.
    """
    first, second = ({powers: c for powers, c in terms.items() if c} for terms in (first, second))
    if not first or not second:
        raise NotIsolatedError("one of the two polynomials is zero everywhere: their common roots are not isolated points")
    length = characteristic_length(first, second)
    p, q = (_normalized(terms, length) for terms in (first, second))
    starts = []
    for angle, far in _ELIMINATIONS:
        enlarged = [_normalized(terms, far * length) for terms in (first, second)]
        starts.append(far * _elimination_starts(enlarged[0], enlarged[1], angle))
    x, y = np.meshgrid(_GRID, _GRID)
    starts.append(np.column_stack([x.ravel(), y.ravel()]))
    points = _unique_points(p, q, _newton_roots(p, q, np.concatenate(starts)))
    # Bézout's theorem: two polynomials without a common factor have no more common roots than this.
    if len(points) > degree(p) * degree(q):
        raise NotIsolatedError(_ON_A_CURVE)
    return points * length


def characteristic_length(*polynomials: Terms) -> float:
    """The unit of length in which the largest coefficients of lowest and highest degree are about equal.

    It is a power of 2, so that scaling by it is exact.
    """
    largest = {n: c for n, c in largest_coefficients(*polynomials).items() if n and c}
    if len(largest) < 2:
        return 1.0
    low, high = min(largest), max(largest)
    return float(2.0 ** np.round((np.log2(largest[low]) - np.log2(largest[high])) / (high - low)))


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


def _normalized(terms: Terms, length: float) -> Terms:
    """The polynomial with x and y in units of `length`, scaled to a largest coefficient of 1."""
    scaled = {(i, j): c * length ** (i + j) for (i, j), c in terms.items()}
    largest = max(map(abs, scaled.values()))
    return {powers: c / largest for powers, c in scaled.items()}


def _elimination_starts(p: Terms, q: Terms, angle: float) -> np.ndarray:
    """(n, 2) points near every common root: each real eigenvalue x with all y at which p is near 0."""
    p_rotated, q_rotated = (_rotated_coefficients(terms, angle) for terms in (p, q))
    x = _eigenvalues(p_rotated, q_rotated)
    x = x[(np.abs(x.imag) <= _IMAGINARY_TOLERANCE * (1 + np.abs(x))) & (np.abs(x) < _LARGEST_ROOT)].real
    cos, sin = np.cos(angle), np.sin(angle)
    starts: np.ndarray = _points_over(p_rotated, x) @ np.array([[cos, sin], [-sin, cos]])
    return starts


def _rotated_coefficients(terms: Terms, angle: float) -> np.ndarray:
    """Dense coefficients [i, j] of the polynomial in axes rotated by an angle."""
    cos, sin = float(np.cos(angle)), float(np.sin(angle))
    rotated = substitute(terms, {(1, 0): cos, (0, 1): -sin}, {(1, 0): sin, (0, 1): cos})
    return _dense_coefficients(rotated, degree(terms))


def _eigenvalues(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The finite x at which the Sylvester matrix in y is singular."""
    from scipy import linalg

    m, n = p.shape[1] - 1, q.shape[1] - 1
    highest = max(p.shape[0], q.shape[0]) - 1
    size = m + n
    if highest == 0 or size == 0:
        return np.empty(0, complex)
    sylvester = np.zeros((highest + 1, size, size))
    for row in range(n):
        sylvester[: p.shape[0], row, row : row + m + 1] = p
    for row in range(m):
        sylvester[: q.shape[0], n + row, row : row + n + 1] = q
    a = np.eye(highest * size, k=size)
    a[-size:] = np.hstack(list(-sylvester[:-1]))
    b = np.eye(highest * size)
    b[-size:, -size:] = sylvester[-1]
    numerator, denominator = linalg.eigvals(a, b, homogeneous_eigvals=True)
    finite = np.abs(denominator) * _LARGEST_ROOT > np.abs(numerator)
    values: np.ndarray = numerator[finite] / denominator[finite]
    return values


def _points_over(p: np.ndarray, x: np.ndarray) -> np.ndarray:
    """(n, 2) for each x, the points (x, y) at which p is near 0."""
    points = [(value, root.real) for value in x for root in np.roots((value ** np.arange(p.shape[0]) @ p)[::-1])]
    return np.array(points).reshape(-1, 2)


def _newton_roots(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """(n, 2) the common roots to which Newton's method converges from the given points, with repetitions."""
    highest = max(degree(p), degree(q))
    polynomials = [_dense_coefficients(f, highest) for f in (p, q, *(derivative(f, axis) for f in (p, q) for axis in (0, 1)))]
    roots: list[np.ndarray] = []
    with np.errstate(all="ignore"):
        for _ in range(_NEWTON_STEPS):
            residual, step = _newton_step(polynomials, points)
            scale, largest = 1.0 + np.hypot(*points.T), _sum_of_magnitudes(polynomials[:2], points)
            length, near = np.hypot(*step.T), scale < _LARGEST_ROOT
            at_root = residual < _RESIDUAL_TOLERANCE * largest
            # On a curve of common roots the step can be infinite or NaN; such a point has converged.
            converged = near & at_root & ~(np.isfinite(length) & (length > _SIMPLE_ROOT_TOLERANCE * scale))
            roots.append(points[converged] - np.where(np.isfinite(step[converged]), step[converged], 0.0))
            continues = near & np.isfinite(length) & ~converged
            points = points[continues] - step[continues]
    return np.concatenate([*roots, points[at_root[continues]]])


def _newton_step(polynomials: list[np.ndarray], points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """|(p, q)| (n,) and the Newton step (n, 2) to subtract, from dense coefficients of p, q, p_x, p_y, q_x, q_y."""
    x_powers, y_powers = (axis[:, None] ** np.arange(len(polynomials[0])) for axis in points.T)
    f, g, px, py, qx, qy = (((x_powers @ c) * y_powers).sum(axis=1) for c in polynomials)
    step = np.column_stack([f * qy - g * py, g * px - f * qx]) / (px * qy - py * qx)[:, None]
    return np.hypot(f, g), step


def _sum_of_magnitudes(polynomials: list[np.ndarray], points: np.ndarray) -> np.ndarray:
    """(n,) Σ |c| (1 + |x|)^i (1 + |y|)^j of dense polynomials: that much can cancel at each point."""
    x_powers, y_powers = ((1.0 + np.abs(axis[:, None])) ** np.arange(len(polynomials[0])) for axis in points.T)
    total: np.ndarray = sum(((x_powers @ np.abs(c)) * y_powers).sum(axis=1) for c in polynomials)
    return total


def _dense_coefficients(terms: Terms, highest: int) -> np.ndarray:
    """The coefficients as a (highest + 1, highest + 1) array indexed by the exponents."""
    coefficients = np.zeros((highest + 1, highest + 1))
    for powers, c in terms.items():
        coefficients[powers] = c
    return coefficients


def _unique_points(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """Each of the points once; NotIsolatedError if they form a curve."""
    tolerance = np.where(_is_degenerate(p, q, points), _DEGENERATE_ROOT_TOLERANCE, _SIMPLE_ROOT_TOLERANCE)
    unique = points[_distinct(points, tolerance)]
    degenerate = _is_degenerate(p, q, unique)
    # Before any of them is refined, which takes milliseconds each.
    if np.count_nonzero(degenerate & _has_tangent(p, q, unique)) > degree(p) + degree(q) and have_common_factor(p, q):
        raise NotIsolatedError(_ON_A_CURVE)
    newton = _ExactNewton(p, q)
    refined = [newton.refine(point) if flat else point for point, flat in zip(unique, degenerate, strict=True)]
    roots = np.array([root for root in refined if root is not None]).reshape(-1, 2)
    # Several inaccurate points can be refined to one root.
    return roots[_distinct(roots, np.full(len(roots), _SIMPLE_ROOT_TOLERANCE))]


def _distinct(points: np.ndarray, tolerance: np.ndarray) -> list[int]:
    """Indices of points farther apart than a relative tolerance each (n,); of duplicates, the one of the smallest tolerance."""
    tolerance = tolerance * (1.0 + np.hypot(*points.T))
    distinct: list[int] = []
    for k in np.argsort(tolerance, kind="stable"):
        if not np.any(np.hypot(*(points[distinct] - points[k]).T) <= tolerance[k]):
            distinct.append(int(k))
    return distinct


class _ExactNewton:
    """Newton's method with many digits for a common root of two polynomials."""

    def __init__(self, p: Terms, q: Terms) -> None:
        polynomials = (p, q, *(derivative(f, axis) for f in (p, q) for axis in (0, 1)))
        with localcontext(prec=_MANY_DIGITS):
            self._exact = [{powers: Decimal(c) for powers, c in f.items()} for f in polynomials]
        self._powers = range(max(degree(p), degree(q)) + 1)
        self._steps_left = _MOST_EXACT_STEPS

    def refine(self, point: np.ndarray) -> np.ndarray | None:
        """The root to which a point converges; None if the point is a root to rounding errors only."""
        with localcontext(prec=_MANY_DIGITS):
            x, y = (Decimal(float(coordinate)) for coordinate in point)
            step = Decimal(1)
            for _ in range(_NEWTON_STEPS):
                f, g, px, py, qx, qy = self._values(x, y)
                determinant = px * qy - py * qx
                if not determinant:
                    step = abs(f) + abs(g)
                    break
                dx, dy = (f * qy - g * py) / determinant, (g * px - f * qx) / determinant
                x, y, step = x - dx, y - dy, abs(dx) + abs(dy)
            return np.array([float(x), float(y)]) if step < Decimal(_SIMPLE_ROOT_TOLERANCE) else None

    def _values(self, x: Decimal, y: Decimal) -> list[Decimal]:
        if not self._steps_left:
            raise UndecidedError(_TOO_DEGENERATE)
        self._steps_left -= 1
        # Decimals refuse 0 to the power 0.
        x_powers, y_powers = ([axis**k if k else Decimal(1) for k in self._powers] for axis in (x, y))
        return [sum((c * x_powers[i] * y_powers[j] for (i, j), c in terms.items()), Decimal(0)) for terms in self._exact]


def _is_degenerate(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """(n,) whether the Jacobian of (p, q) is singular at each common root: the curves p = 0 and q = 0 touch there."""
    largest, smallest = _singular_values(p, q, points)
    flags: np.ndarray = smallest <= _SINGULAR_RATIO * np.maximum(largest, 1.0)
    return flags


def _has_tangent(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """(n,) whether the Jacobian of (p, q) is far from zero at each common root; on a common curve its kernel is the tangent."""
    largest, _ = _singular_values(p, q, points)
    flags: np.ndarray = largest > _ZERO_JACOBIAN * (1.0 + np.hypot(*points.T)) ** (max(degree(p), degree(q)) - 1)
    return flags


def _singular_values(p: Terms, q: Terms, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n,) the larger and (n,) the smaller singular value of the Jacobian of (p, q) at each point."""
    jacobian = [[evaluate(derivative(f, axis), *points.T) for axis in (0, 1)] for f in (p, q)]
    largest, smallest = np.linalg.svd(np.moveaxis(np.array(jacobian), -1, 0), compute_uv=False).T
    return largest, smallest
