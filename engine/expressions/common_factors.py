"""Sums rewritten with fewer products: x u + x v as x (u + v)."""

from __future__ import annotations

import math
from collections import Counter

from engine.expressions.nodes import Expression, Product, Sum, linear_combination, multiply, power

Terms = tuple[tuple[Expression, float], ...]

# Mantissa of all powers of two in `math.frexp`.
_MANTISSA_OF_POWERS = 0.5


def factor_out(terms: Terms) -> Terms:
    """Rewrite Σ c m with the most common factors of its products factored out; the constants of new sums are 0.

    Sums among the factors are scaled to a first coefficient of 1 where that is exact, so that u (2x + 1) + v (x + ½) has a common
    factor.
    """
    terms = _terms_of(linear_combination(_with_unit_sums(part, c) for part, c in terms))
    while (factor := _most_common_factor(terms)) is not None:
        inverse = power(factor, -1.0)
        rests = [(c, multiply(part, inverse)) if _contains(part, factor) else None for part, c in terms]
        inner = linear_combination(rest for rest in rests if rest is not None)
        others = ((c, part) for (part, c), rest in zip(terms, rests, strict=True) if rest is None)
        terms = _terms_of(linear_combination([_with_unit_sums(multiply(factor, inner), 1.0), *others]))
    return terms


def _terms_of(total: Expression) -> Terms:
    return total.terms if isinstance(total, Sum) else ((total, 1.0),)


def _with_unit_sums(part: Expression, c: float) -> tuple[float, Expression]:
    """Return (d, e) with d e = c m. Sums among the factors of m whose first coefficient is ±2^k have the coefficient 1 in e."""
    factors = []
    for base, n in part.factors if isinstance(part, Product) else ():
        scale = base.terms[0][1] if isinstance(base, Sum) and n == int(n) else 1.0
        if abs(math.frexp(scale)[0]) != _MANTISSA_OF_POWERS:
            scale = 1.0
        c *= scale**n
        factors.append(power(linear_combination([(1.0 / scale, base)]), n))
    return c, multiply(*factors) if factors else part


def _most_common_factor(terms: Terms) -> Expression | None:
    """Find the most common factor, and return the product of all factors that the products with this factor share.

    None if no factor is common. Of several most common factors, the first is used, so that graphs do not depend on hashes.
    """
    counts = Counter(factor for part, _ in terms for factor in _factors(part))
    factor, count = max(counts.items(), key=lambda item: item[1], default=(None, 0))
    if factor is None or count == 1:
        return None
    having = [_factors(part) for part, _ in terms if factor in _factors(part)]
    return multiply(*(each for each in having[0] if all(each in others for others in having)))


def _contains(part: Expression, factor: Expression) -> bool:
    """Return whether a product has all factors of another product."""
    return all(each in _factors(part) for each in _factors(factor) or (factor,))


def _factors(part: Expression) -> tuple[Expression, ...]:
    """Return the factors of a product in order, empty if the product is its only factor.

    A positive integer power of b has the factor b.
    """
    if not isinstance(part, Product):
        return ()
    found = tuple(base if n > 0.0 and n == int(n) else power(base, n) for base, n in part.factors)
    return () if part in found else found
