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
# Numbers of bits of the intervals, tried in turn.
_PRECISIONS = (128, 256, 512, 1024)
# Relative distance of x from s − k y up to which the intervals of both are compared.
_NEAR = 1e-9


@dataclass(frozen=True)
class CommonRoot:
    """A common root (x, y), with an interval for each coordinate. The multiplicity is 1 where the two curves cross."""

    x: arb
    y: arb
    multiplicity: int


def find_common_roots(p: fmpq_mpoly, q: fmpq_mpoly) -> list[CommonRoot]:
    """Find all real common roots of two polynomials without a common factor, each once.

    During the search, the precision of `flint.ctx` is changed for all threads.

    Raises
    ------
    UndecidedError
        If the intervals are not short enough to tell the roots apart at the highest precision.
    """
    if p.is_constant() or q.is_constant():
        return []
    along_x, along_y = (_univariate(p.resultant(q, name), axis) for axis, name in enumerate(("y", "x")))
    for shear in _SHEARS:
        sheared = [_shear(each, shear) for each in (p, q)]
        if any(each.degrees()[1] < each.total_degree() for each in sheared):
            # The leading coefficient in y vanishes, so the resultant would also have roots at infinity.
            continue
        along_s = _univariate(sheared[0].resultant(sheared[1], "y"), 0)
        for precision in _PRECISIONS:
            with ctx.workprec(precision):
                roots = _pair_coordinates(_real_roots(along_x), _real_roots(along_y), _real_roots(along_s), shear)
            if roots is not None:
                return roots
    raise UndecidedError(
        "It cannot be decided whether all points where the force vanishes are known: some are too close together."
    )


def _univariate(polynomial: fmpq_mpoly, axis: int) -> fmpq_poly:
    """Convert a polynomial that contains only one coordinate."""
    coefficients = {powers[axis]: c for powers, c in polynomial.to_dict().items()}
    return fmpq_poly([coefficients.get(n, 0) for n in range(max(coefficients, default=0) + 1)])


def _shear(polynomial: fmpq_mpoly, shear: fmpq) -> fmpq_mpoly:
    """Replace x in a polynomial by s − k y. The result has s in place of x."""
    x, y = RING.gens()
    return polynomial.compose(x - shear * y, y)


def _real_roots(polynomial: fmpq_poly) -> list[tuple[arb, int]]:
    """Return the real roots with their multiplicities, in increasing order."""
    # FLINT's stubs do not declare the multiplicities.
    roots: list[Any] = polynomial.numer().complex_roots() if polynomial.degree() > 0 else []
    return sorted(((root.real, multiplicity) for root, multiplicity in roots if root.imag == 0), key=lambda each: each[0].mid())


def _pair_coordinates(
    along_x: list[tuple[arb, int]], along_y: list[tuple[arb, int]], along_s: list[tuple[arb, int]], shear: fmpq
) -> list[CommonRoot] | None:
    """Return the only pair (x, y) with x + k y = s for each s; None if an s has no pair or several."""
    x_values = [float(x) for x, _ in along_x]
    k = arb(shear)
    roots = []
    for s, multiplicity in along_s:
        pairs = []
        for y, _ in along_y:
            expected_x = s - k * y
            distance = _NEAR * (abs(float(s)) + abs(float(k * y)))
            first = bisect_left(x_values, float(expected_x) - distance)
            last = bisect_right(x_values, float(expected_x) + distance)
            pairs += [(x, y) for x, _ in along_x[first:last] if x.overlaps(expected_x)]
        if len(pairs) != 1:
            return None
        roots.append(CommonRoot(*pairs[0], multiplicity))
    return roots
