"""All critical points of a polynomial V, found with proof, in rational arithmetic.

A coefficient stands for the decimal that Python prints, or for a fraction with a small denominator that rounds to the same
double. The result is therefore the same on every machine, and exact for typed formulas. V_x and V_y are divided by their greatest
common divisor. The quotients have isolated common roots (`find_common_roots`). Where the divisor vanishes, the force vanishes
along curves or at single points.
"""

from __future__ import annotations

import math
import threading
from fractions import Fraction

import numpy as np
from flint import arb, ctx, fmpq, fmpq_mpoly

from engine.expressions.exact_polynomials import RING, exact_polynomial
from engine.expressions.polynomials import Terms
from engine.systems.forms.common_roots import CommonRoot, find_common_roots
from engine.systems.forms.form import NotIsolatedError

# Largest denominator of the fractions that are recognised, such as 1/3.
_LARGEST_DENOMINATOR = 1000
# An arbitrary point. On each curve of zeros, the point nearest to it is searched.
_ARBITRARY_POINT = fmpq(577, 1009), fmpq(-733, 1013)
# Working precision of FLINT, in bits, with which signs are determined: no less than that of the roots.
_PRECISION = 1024
# Relative error of the coefficients. A point is degenerate if such errors can make its Hessian singular.
_COEFFICIENT_ERROR = 2.0**-44
# Only one thread searches at a time, because the precision is a global variable of FLINT.
_LOCK = threading.Lock()


def find_critical_points(terms: Terms) -> np.ndarray:
    """Return the points at which the gradient of V vanishes, with their indices.

    Parameters
    ----------
    terms
        {(i, j): c}: V = Σ c x^i y^j.

    Returns
    -------
    x, y and index of each point, of shape (n, 3). The index is 1 for a minimum or a maximum, −1 for a saddle, and 0 for a point
    that is degenerate, or can become degenerate by rounding errors of the coefficients.

    Raises
    ------
    NotIsolatedError
        If the gradient vanishes along a curve.
    UndecidedError
        If the points are too close together to be told apart.
    """
    with _LOCK:
        potential = exact_polynomial({powers: _rational(c) for powers, c in terms.items() if c})
        slope_x, slope_y = potential.derivative("x"), potential.derivative("y")
        divisor = slope_x.gcd(slope_y)
        if divisor.is_zero():
            raise NotIsolatedError
        degenerate = _isolated_zeros(divisor)
        roots = [root for root in find_common_roots(slope_x / divisor, slope_y / divisor) if not _is_among(root, degenerate)]
        rows = [(root, 0) for root in degenerate] + [(root, _index(potential, root)) for root in roots]
        return np.array([(float(root.x), float(root.y), index) for root, index in rows], float).reshape(-1, 3)


def _rational(c: float) -> Fraction:
    """Return the number that a coefficient represents."""
    decimal = Fraction(repr(float(c)))
    simple = decimal.limit_denominator(_LARGEST_DENOMINATOR)
    return simple if float(simple) == c else decimal


def _isolated_zeros(polynomial: fmpq_mpoly) -> list[CommonRoot]:
    """Return the real zeros of a polynomial if all are isolated points; NotIsolatedError for curves of zeros.

    Each curve of zeros has a point nearest to the arbitrary point. There the gradient is parallel to the line between the points.
    """
    zeros = []
    x, y = RING.gens()
    for factor, _ in polynomial.factor_squarefree()[1]:
        slope_x, slope_y = factor.derivative("x"), factor.derivative("y")
        # This vanishes where the gradient is parallel to the line from the arbitrary point.
        cross_product = (x - _ARBITRARY_POINT[0]) * slope_y - (y - _ARBITRARY_POINT[1]) * slope_x
        if not factor.gcd(cross_product).is_constant():
            raise NotIsolatedError
        for zero in find_common_roots(factor, cross_product):
            is_singular = _value(slope_x, zero).contains(0) and _value(slope_y, zero).contains(0)
            if not (is_singular and _Hessian(factor, zero).determinant > 0):
                raise NotIsolatedError
            zeros.append(zero)
    return zeros


def _is_among(root: CommonRoot, roots: list[CommonRoot]) -> bool:
    return any(root.x.overlaps(other.x) and root.y.overlaps(other.y) for other in roots)


def _index(potential: fmpq_mpoly, root: CommonRoot) -> int:
    """Return 1, −1 or 0, see `find_critical_points`."""
    hessian = _Hessian(potential, root)
    if root.multiplicity > 1 or hessian.determinant.contains(0) or hessian.is_singular_to_rounding():
        return 0
    return 1 if hessian.determinant > 0 else -1


class _Hessian:
    """The second derivatives of a polynomial at a root, as intervals, and sums of the magnitudes of their terms."""

    def __init__(self, polynomial: fmpq_mpoly, root: CommonRoot) -> None:
        slope_x, slope_y = polynomial.derivative("x"), polynomial.derivative("y")
        entries = slope_x.derivative("x"), slope_x.derivative("y"), slope_y.derivative("y")
        self.xx, self.xy, self.yy = (_value(entry, root) for entry in entries)
        self._magnitudes = [float(_value(entry, root, magnitude=True)) for entry in entries]
        with ctx.workprec(_PRECISION):
            self.determinant = self.xx * self.yy - self.xy * self.xy

    def is_singular_to_rounding(self) -> bool:
        """Return whether rounding errors of the coefficients can change the sign of the eigenvalue λ of smaller magnitude.

        With the unit eigenvector e of λ, a change δ of the matrix changes λ by eᵀ δ e.
        """
        with ctx.workprec(_PRECISION):
            mean, half_difference = (self.xx + self.yy) / 2, (self.xx - self.yy) / 2
            distance = (half_difference * half_difference + self.xy * self.xy).sqrt()
            eigenvalue = self.determinant / (mean + distance if mean > 0 else mean - distance)
            # Both vectors are parallel to the eigenvector. The longer vector has the smaller rounding error. Only magnitudes of
            # its parts enter the bound.
            vectors = ((self.xy, eigenvalue - self.xx), (eigenvalue - self.yy, self.xy))
            vector = max(([abs(float(part)) for part in each] for each in vectors), key=lambda each: math.hypot(*each))
        length = math.hypot(*vector)
        u, v = (part / length for part in vector) if length else (1.0, 1.0)
        xx, xy, yy = self._magnitudes
        return abs(float(eigenvalue)) <= _COEFFICIENT_ERROR * (xx * u * u + 2.0 * xy * u * v + yy * v * v)


def _value(polynomial: fmpq_mpoly, root: CommonRoot, *, magnitude: bool = False) -> arb:
    """Return an interval that contains the value at a root; with `magnitude`, the sum of the magnitudes of the terms."""
    # python-flint 0.9 returns NaN for powers of intervals around 0, such as those of coordinates that are nearly 0.
    with ctx.workprec(_PRECISION):
        terms = (math.prod((root.x,) * i + (root.y,) * j, start=arb(c)) for (i, j), c in polynomial.to_dict().items())
        return sum(map(abs, terms) if magnitude else terms, arb(0))
