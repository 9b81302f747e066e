"""All real common roots of two polynomials in x and y with rational coefficients, with proof.

The resultant of two polynomials p and q with respect to y is a polynomial in x that vanishes at the x of each common root. The
resultant with respect to x gives the values of y. In sheared axes, s = x + k y, the resultant gives the values of s. FLINT
encloses the real roots of these polynomials by intervals, with proof (Johansson 2017, IEEE Trans. Comput. 66, 1281). If different
common roots have different s, each real s belongs to exactly one real root (x, y), the only root with x + k y = s. The roots are
known when the intervals are so short that only one pair (x, y) is left for each s. The multiplicity of s is the multiplicity of
the common root.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import Any

from flint import arb, ctx, fmpq, fmpq_mpoly, fmpq_poly

from engine.expressions.exact_polynomials import RING
from engine.systems.forms.form import UndecidedError

# Arbitrary factors k, tried in turn. Two common roots have the same s only if the line through them has the slope −1/k.
_SHEARS = (fmpq(37, 101), fmpq(-67, 89), fmpq(113, 71))
# Working precisions of FLINT, in bits, tried in turn.
_PRECISIONS = (128, 256, 512, 1024)
# Relative tolerance within which x is searched near s − k y, by bisection of doubles, before the intervals are compared.
_SEARCH_TOLERANCE = 1e-9


@dataclass(frozen=True)
class CommonRoot:
    """A common root (x, y), with an interval for each coordinate. The multiplicity is 1 where the two curves cross."""

    x: arb
    y: arb
    multiplicity: int


def find_common_roots(p: fmpq_mpoly, q: fmpq_mpoly) -> list[CommonRoot]:
    """Find all real common roots of two polynomials without a common factor, each once.

    During the search, the precision of `flint.ctx` is changed for all threads.

    Parameters
    ----------
    p, q
        Polynomials in x and y, of `RING`.

    Raises
    ------
    UndecidedError
        If the roots cannot be told apart: the intervals are too long at the highest precision, or no k is suitable.
    """
    if p.is_constant() or q.is_constant():
        return []
    x_resultant = _univariate(p.resultant(q, "y"), 0)
    y_resultant = _univariate(p.resultant(q, "x"), 1)
    for shear in _SHEARS:
        sheared = [_shear(each, shear) for each in (p, q)]
        if any(each.degrees()[1] < each.total_degree() for each in sheared):
            # The coefficient of the highest power of y can depend on s. Where it vanishes in both polynomials, the resultant
            # vanishes without a common root.
            continue
        s_resultant = _univariate(sheared[0].resultant(sheared[1], "y"), 0)
        for precision in _PRECISIONS:
            with ctx.workprec(precision):
                x_roots, y_roots, s_roots = map(_real_roots, (x_resultant, y_resultant, s_resultant))
                roots = _pair_coordinates(x_roots, y_roots, s_roots, shear)
            if roots is not None:
                return roots
    raise UndecidedError(
        "It cannot be decided whether all points where the force vanishes are known: some are too close together."
    )


def _univariate(polynomial: fmpq_mpoly, axis: int) -> fmpq_poly:
    """Convert a polynomial that contains only x (axis 0) or only y (axis 1)."""
    coefficients = {powers[axis]: c for powers, c in polynomial.to_dict().items()}
    return fmpq_poly([coefficients.get(n, 0) for n in range(max(coefficients, default=0) + 1)])


def _shear(polynomial: fmpq_mpoly, shear: fmpq) -> fmpq_mpoly:
    """Replace x in a polynomial by s − k y. The result has s in place of x."""
    x, y = RING.gens()
    return polynomial.compose(x - shear * y, y)


def _real_roots(polynomial: fmpq_poly) -> list[tuple[arb, int]]:
    """Return the real roots with their multiplicities, in increasing order."""
    # The numerator has integer coefficients, and the same roots. FLINT returns real roots with an imaginary part of exactly 0.
    # FLINT's stubs do not declare the multiplicities.
    roots: list[Any] = polynomial.numer().complex_roots() if polynomial.degree() > 0 else []
    return sorted(((root.real, multiplicity) for root, multiplicity in roots if root.imag == 0), key=lambda each: each[0].mid())


def _pair_coordinates(
    x_roots: list[tuple[arb, int]], y_roots: list[tuple[arb, int]], s_roots: list[tuple[arb, int]], shear: fmpq
) -> list[CommonRoot] | None:
    """Return the only pair (x, y) with x + k y = s for each s; None if an s has no pair or several."""
    x_values = [float(x) for x, _ in x_roots]
    k = arb(shear)
    roots = []
    for s, multiplicity in s_roots:
        pairs = []
        for y, _ in y_roots:
            expected_x = s - k * y
            distance = _SEARCH_TOLERANCE * (abs(float(s)) + abs(float(k * y)))
            first = bisect_left(x_values, float(expected_x) - distance)
            stop = bisect_right(x_values, float(expected_x) + distance)
            pairs += [(x, y) for x, _ in x_roots[first:stop] if x.overlaps(expected_x)]
        if len(pairs) != 1:
            return None
        roots.append(CommonRoot(*pairs[0], multiplicity))
    return roots
