"""All real points where two polynomials in x and y vanish together, by elimination of y.

The Sylvester matrix S(x) of the two polynomials, seen as polynomials in y, is singular at exactly those x that belong
to a common root. det S(x) = 0 is a polynomial eigenvalue problem, so its companion pencil gives every x at once: nothing
is searched for, and nothing can be missed unless the roots are not isolated.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy import linalg

Terms = Mapping[tuple[int, int], float]

# A fixed, arbitrary rotation: it keeps leading coefficients from vanishing and roots from sharing an x.
_TURN = 0.7390851332151607
_REAL = 1e-5
_SAME = 1e-8
_NEWTON_STEPS = 50


def find_critical_points(first: Terms, second: Terms) -> np.ndarray:
    """The common real roots of two polynomials in two variables.

    Parameters
    ----------
    first, second
        {(i, j): c}: the polynomials Σ c x^i y^j, for a critical point V_x and V_y.

    Returns
    -------
    (n, 2) array of the points, each once, in no particular order.
    """
    p, q = _turned(first), _turned(second)
    x = _eigenvalues(p, q)
    x = x[np.abs(x.imag) <= _REAL * (1 + np.abs(x))].real
    found: list[np.ndarray] = []
    for start in _lifted(p, x):
        point = _polished(p, q, start)
        if point is not None and all(np.hypot(*(point - other)) > _SAME for other in found):
            found.append(point)
    cos, sin = np.cos(_TURN), np.sin(_TURN)
    turned_back: np.ndarray = np.array(found).reshape(-1, 2) @ np.array([[cos, sin], [-sin, cos]])
    return turned_back


def _turned(terms: Terms) -> np.ndarray:
    """Dense coefficients (i, j) of the polynomial in axes turned by a fixed angle."""
    degree = max((i + j for i, j in terms), default=0)
    x = np.zeros((2, 2))
    y = np.zeros((2, 2))
    x[1, 0], x[0, 1] = np.cos(_TURN), -np.sin(_TURN)
    y[1, 0], y[0, 1] = np.sin(_TURN), np.cos(_TURN)
    total = np.zeros((degree + 1, degree + 1))
    for (i, j), c in terms.items():
        term = np.ones((1, 1))
        for factor in [x] * i + [y] * j:
            term = _product(term, factor)
        total[: term.shape[0], : term.shape[1]] += c * term
    return total


def _product(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    out = np.zeros((a.shape[0] + b.shape[0] - 1, a.shape[1] + b.shape[1] - 1))
    for i, j in np.argwhere(a):
        out[i : i + b.shape[0], j : j + b.shape[1]] += a[i, j] * b
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
    values: np.ndarray = linalg.eigvals(a, b)
    finite: np.ndarray = values[np.isfinite(values)]
    return finite


def _lifted(p: np.ndarray, x: np.ndarray) -> list[np.ndarray]:
    """For each x, the points (x, y) with the first polynomial near 0."""
    points = []
    for value in x:
        coefficients = value ** np.arange(p.shape[0]) @ p
        points += [np.array([value, root.real]) for root in np.roots(coefficients[::-1])]
    return points


def _polished(p: np.ndarray, q: np.ndarray, point: np.ndarray) -> np.ndarray | None:
    """Newton's method from `point`; None where it does not stay and settle."""
    start = point
    for _ in range(_NEWTON_STEPS):
        jacobian = np.array([[_derivative(f, point, axis) for axis in (0, 1)] for f in (p, q)])
        residual = np.array([_value(f, point) for f in (p, q)])
        step = np.linalg.lstsq(jacobian, residual, rcond=None)[0]
        point = point - step
        if np.hypot(*(point - start)) > 0.1:
            return None
        if np.hypot(*step) < 1e-15 * (1 + np.hypot(*point)):
            break
    settled = np.hypot(*step) < _SAME and np.hypot(*residual) < _SAME
    return point if settled else None


def _value(f: np.ndarray, point: np.ndarray) -> float:
    return float(np.polynomial.polynomial.polyval2d(point[0], point[1], f))


def _derivative(f: np.ndarray, point: np.ndarray, axis: int) -> float:
    return _value(np.polynomial.polynomial.polyder(f, axis=axis), point)
