"""All real points where two polynomials in x and y vanish together, by elimination of y, and the check that none is missing.

The Sylvester matrix S(x) of the two polynomials, seen as polynomials in y, is singular at exactly those x that belong
to a common root. det S(x) = 0 is a polynomial eigenvalue problem, so its companion pencil gives every x at once. Newton's method
polishes what it gives, and a mesh of further starts guards against eigenvalues too ill-conditioned to be of use.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy import linalg

from engine.taylor.source.cauchy_products import derivative

Terms = Mapping[tuple[int, int], float]

# Fixed, arbitrary rotations: they keep leading coefficients from vanishing and roots from sharing an x.
_TURNS = (0.7390851332151607, 2.1)
# All below in units of the length in which coefficients of low and of high degree are alike.
_REAL = 1e-3
_SAME = 1e-8
# Newton's method stops this near a root at which the polynomials touch, and such a root is one point, not many.
_SAME_DEGENERATE = 1e-3
_DEGENERATE = 1e-6
_SETTLED = 1e-12
_NEWTON_STEPS = 60
_MESH = np.linspace(-3.0, 3.0, 31)
# Beyond this distance a root of the pencil is one at infinity that rounding has moved.
_FURTHEST = 1e5

_MOST_REFINEMENTS = 60
# A vector that turns by less than this from one point of the circle to the next has not gone round unnoticed.
_LARGEST_TURN = 0.5


class NotIsolatedError(ValueError):
    """The common zeros of two polynomials form a curve, so that they cannot be listed."""


def find_critical_points(first: Terms, second: Terms) -> np.ndarray:
    """The common real roots of two polynomials in two variables.

    Parameters
    ----------
    first, second
        {(i, j): c}: the polynomials Σ c x^i y^j, for a critical point V_x and V_y; tested to degree 11.

    Returns
    -------
    (n, 2) array of the points, each once, in no particular order.

    Raises
    ------
    NotIsolatedError
        When one of them vanishes everywhere, or they vanish together on a curve.
    """
    first, second = ({powers: c for powers, c in terms.items() if c} for terms in (first, second))
    if not first or not second:
        raise NotIsolatedError("one of the two polynomials is zero everywhere: their common zeros are not isolated points")
    length = balanced_length(first, second)
    p, q = (_in_units(terms, length) for terms in (first, second))
    starts = [_eliminated(p, q, turn) for turn in _TURNS]
    x, y = np.meshgrid(_MESH, _MESH)
    starts.append(np.column_stack([x.ravel(), y.ravel()]))
    points = _distinct(p, q, _polished(p, q, np.concatenate(starts)))
    if len(points) > _degree(p) * _degree(q):
        raise NotIsolatedError("the two polynomials vanish together on a curve: their common zeros are not isolated points")
    return points * length


def balanced_length(*polynomials: Terms) -> float:
    """The length in which the largest coefficients of lowest and of highest degree are alike; a power of 2, so exact."""
    largest: dict[int, float] = {}
    for terms in polynomials:
        for (i, j), c in terms.items():
            if i + j and c:
                largest[i + j] = max(largest.get(i + j, 0.0), abs(c))
    if len(largest) < 2:
        return 1.0
    low, high = min(largest), max(largest)
    return float(2.0 ** np.round((np.log2(largest[low]) - np.log2(largest[high])) / (high - low)))


def count_turns(first: Terms, second: Terms, radius: float) -> int:
    """How often the vector (first, second) turns around along a circle about the origin, counterclockwise.

    By the theorem of Poincaré and Hopf that is the sum of the indices of its zeros inside: +1 for each minimum and maximum of a
    potential with that gradient, −1 for each saddle. So a list of critical points whose indices do not come to this is not
    complete, or holds a degenerate one.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 721)
    for _ in range(_MOST_REFINEMENTS):
        x, y = radius * np.cos(angle), radius * np.sin(angle)
        turn = np.diff(np.arctan2(_value(second, x, y), _value(first, x, y)))
        turn = (turn + np.pi) % (2.0 * np.pi) - np.pi
        wide = np.flatnonzero(np.abs(turn) > _LARGEST_TURN)
        if not wide.size:
            break
        angle = np.insert(angle, wide + 1, 0.5 * (angle[wide] + angle[wide + 1]))
    return round(float(turn.sum()) / (2.0 * np.pi))


def _in_units(terms: Terms, length: float) -> dict[tuple[int, int], float]:
    """The polynomial of lengths in units of `length`, its largest coefficient 1."""
    scaled = {(i, j): c * length ** (i + j) for (i, j), c in terms.items()}
    largest = max(map(abs, scaled.values()))
    return {powers: c / largest for powers, c in scaled.items()}


def _degree(terms: Terms) -> int:
    return max(i + j for i, j in terms)


def _eliminated(p: Terms, q: Terms, turn: float) -> np.ndarray:
    """(n, 2) starts near every common root: real eigenvalues x with all y at which the first polynomial is near 0."""
    turned = _turned(p, turn), _turned(q, turn)
    x = _eigenvalues(*turned)
    x = x[(np.abs(x.imag) <= _REAL * (1 + np.abs(x))) & (np.abs(x) < _FURTHEST)].real
    cos, sin = np.cos(turn), np.sin(turn)
    turned_back: np.ndarray = _lifted(turned[0], x) @ np.array([[cos, sin], [-sin, cos]])
    return turned_back


def _turned(terms: Terms, turn: float) -> np.ndarray:
    """Dense coefficients (i, j) of the polynomial in axes turned by a fixed angle."""
    degree = _degree(terms)
    x = np.zeros((2, 2))
    y = np.zeros((2, 2))
    x[1, 0], x[0, 1] = np.cos(turn), -np.sin(turn)
    y[1, 0], y[0, 1] = np.sin(turn), np.cos(turn)
    total = np.zeros((degree + 1, degree + 1))
    for (i, j), c in terms.items():
        term = np.ones((1, 1))
        for factor in [x] * i + [y] * j:
            term = _product(term, factor)
        total[: term.shape[0], : term.shape[1]] += c * term
    return total


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    out = np.zeros((a.shape[0] + b.shape[0] - 1, a.shape[1] + b.shape[1] - 1))
    for i, j in np.argwhere(b):
        out[i : i + a.shape[0], j : j + a.shape[1]] += b[i, j] * a
    return out


def _eigenvalues(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The x at which the Sylvester matrix in y is singular, infinite ones left out."""
    m, n = p.shape[1] - 1, q.shape[1] - 1
    degree = max(p.shape[0], q.shape[0]) - 1
    size = m + n
    sylvester = np.zeros((degree + 1, size, size))
    for row in range(n):
        sylvester[: p.shape[0], row, row : row + m + 1] = p
    for row in range(m):
        sylvester[: q.shape[0], n + row, row : row + n + 1] = q
    if degree == 0 or size == 0:
        return np.empty(0, complex)
    a = np.eye(degree * size, k=size)
    a[-size:] = np.hstack(list(-sylvester[:-1]))
    b = np.eye(degree * size)
    b[-size:, -size:] = sylvester[-1]
    above, below = linalg.eigvals(a, b, homogeneous_eigvals=True)
    finite = np.abs(below) * _FURTHEST > np.abs(above)
    values: np.ndarray = above[finite] / below[finite]
    return values


def _lifted(p: np.ndarray, x: np.ndarray) -> np.ndarray:
    """For each x, the points (x, y) with the first polynomial near 0."""
    points = [(value, root.real) for value in x for root in np.roots((value ** np.arange(p.shape[0]) @ p)[::-1])]
    return np.array(points).reshape(-1, 2)


def _polished(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """Newton's method from each of the starts; those that settle on a common root."""
    highest = max(_degree(p), _degree(q))
    polynomials = [_dense(f, highest) for f in (p, q, *(derivative(f, axis) for f in (p, q) for axis in (0, 1)))]
    kept: list[np.ndarray] = []
    with np.errstate(all="ignore"):
        for _ in range(_NEWTON_STEPS):
            x_powers, y_powers = (axis[:, None] ** np.arange(highest + 1) for axis in points.T)
            f, g, px, py, qx, qy = (((x_powers @ c) * y_powers).sum(axis=1) for c in polynomials)
            scale = 1.0 + np.hypot(*points.T)
            step = np.column_stack([f * qy - g * py, g * px - f * qx]) / (px * qy - py * qx)[:, None]
            length = np.hypot(*step.T)
            settled = np.hypot(f, g) < _SETTLED * scale**highest
            # On a curve of common roots the last digits of a step mean nothing.
            stays = settled & ~(np.isfinite(length) & (length > _SAME * scale))
            kept.append(points[stays] - np.where(np.isfinite(step[stays]), step[stays], 0.0))
            going = np.isfinite(length) & ~stays & (scale < _FURTHEST)
            points = points[going] - step[going]
    return np.concatenate([*kept, points[settled[going]]])


def _dense(terms: Terms, highest: int) -> np.ndarray:
    """The coefficients as an array over both exponents up to `highest`."""
    coefficients = np.zeros((highest + 1, highest + 1))
    for powers, c in terms.items():
        coefficients[powers] = c
    return coefficients


def _distinct(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """Each of the points once."""
    apart = np.where(_is_degenerate(p, q, points), _SAME_DEGENERATE, _SAME) * (1.0 + np.hypot(*points.T))
    found: list[int] = []
    # The sharpest first, so that the vague ones around a sharp one count as that one.
    for k in np.argsort(apart, kind="stable"):
        others = points[found]
        if not np.any(np.hypot(*(others - points[k]).T) <= apart[k]):
            found.append(int(k))
    return points[found]


def _is_degenerate(p: Terms, q: Terms, points: np.ndarray) -> np.ndarray:
    """Whether the two polynomials touch, instead of crossing, at each of their common roots."""
    rows = [[_value(derivative(f, axis), *points.T) for axis in (0, 1)] for f in (p, q)]
    singular = np.linalg.svd(np.moveaxis(np.array(rows), -1, 0), compute_uv=False)
    flags: np.ndarray = singular[:, 1] <= _DEGENERATE * np.maximum(singular[:, 0], 1.0)
    return flags


def _value(terms: Terms, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    total = np.zeros_like(x)
    for (i, j), c in terms.items():
        total = total + c * x**i * y**j
    return total
