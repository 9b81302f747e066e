"""Whether two polynomials in x and y have a common factor, so that their common roots form a curve, which may be complex.

On an arbitrary complex line, two polynomials with a common factor are polynomials of one variable with a common root, and their
Sylvester matrix is singular. Without a common factor an arbitrary line meets none of their isolated common roots.
"""

from __future__ import annotations

import numpy as np

from engine.polynomials import Terms, degree, largest_coefficients

# Base points and directions of two arbitrary complex lines.
_LINES = (
    ((0.31 + 0.52j, -0.47 + 0.23j), (0.61 - 0.35j, 0.44 + 0.57j)),
    ((-0.38 + 0.19j, 0.27 + 0.55j), (0.53 + 0.41j, -0.36 + 0.62j)),
)
# A Sylvester matrix with rows of length 1 is singular if its smallest singular value is below this: that of a typed potential
# with a common factor is about 1e-14 from the rounding of its coefficients, that of other wells up to degree 12 above 1e-9.
_SINGULAR = 1e-12


def have_common_factor(first: Terms, second: Terms) -> bool:
    """Whether two nonzero polynomials have a common factor, up to rounding errors of their coefficients.

    Parameters
    ----------
    first, second
        {(i, j): c}: the polynomials Σ c x^i y^j.

    Notes
    -----
    Terms that are small in one unit of length are large in another. A common factor is one in each unit, so that the matrix must
    be singular in all units in which the largest coefficients of two degrees are about equal.
    """
    return all(
        _smallest_singular_value(first, second, unit, *line) < _SINGULAR for unit in _units(first, second) for line in _LINES
    )


def _units(first: Terms, second: Terms) -> list[float]:
    """The units of length in which the largest coefficients of two degrees are about equal, powers of 2."""
    logarithms = {n: float(np.log2(c)) for n, c in largest_coefficients(first, second).items()}
    pairs = [(low, high) for low in logarithms for high in logarithms if low < high]
    exponents = {round((logarithms[low] - logarithms[high]) / (high - low)) for low, high in pairs}
    return [2.0**exponent for exponent in sorted(exponents or {0})]


def _smallest_singular_value(
    first: Terms, second: Terms, unit: float, base: tuple[complex, complex], direction: tuple[complex, complex]
) -> float:
    p, q = (_on_line(terms, unit, base, direction) for terms in (first, second))
    m, n = len(p) - 1, len(q) - 1
    if m + n == 0:
        return 1.0
    sylvester = np.zeros((m + n, m + n), complex)
    for row in range(n):
        sylvester[row, row : row + m + 1] = p
    for row in range(m):
        sylvester[n + row, row : row + n + 1] = q
    return float(np.linalg.svd(sylvester, compute_uv=False)[-1])


def _on_line(terms: Terms, unit: float, base: tuple[complex, complex], direction: tuple[complex, complex]) -> np.ndarray:
    """The coefficients, of norm 1, of the polynomial in t at (x, y) = unit (base + direction t)."""
    count = degree(terms) + 1
    t = np.exp(2j * np.pi * np.arange(count) / count)
    x, y = (start + along * t for start, along in zip(base, direction, strict=True))
    largest = max(abs(c) * unit ** (i + j) for (i, j), c in terms.items())
    values = sum((c * unit ** (i + j) / largest * x**i * y**j for (i, j), c in terms.items()), np.zeros(count, complex))
    coefficients: np.ndarray = np.fft.fft(values)
    coefficients /= np.linalg.norm(coefficients)
    return coefficients
