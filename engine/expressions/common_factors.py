"""Sums rewritten with fewer products: x u + x v as x (u + v)."""

from __future__ import annotations

import math
from collections import Counter

from engine.expressions.nodes import Expression, Product, Sum, as_sum, linear_combination, multiply, power

SumTerms = tuple[tuple[Expression, float], ...]
"""The terms (m, c) of a sum Σ c m."""


# Mantissa that `math.frexp` returns for powers of two.
_MANTISSA_OF_POWERS_OF_TWO = 0.5


def factor_out(terms: SumTerms) -> SumTerms:
    """Factor out the most common factors of the products of Σ c m. New sums have no constants.

    Sums among the factors are scaled to a first coefficient of 1 where the scaling is exact. Then u (2x + 1) + v (x + ½) has a
    common factor.
    """
    terms = as_sum(linear_combination(_with_unit_sums(part, c) for part, c in terms)).terms
    while (factor := _most_common_factor(terms)) is not None:
        inverse = power(factor, -1.0)
        multiples = [(part, c) for part, c in terms if _contains(part, factor)]
        other_terms = [(c, part) for part, c in terms if not _contains(part, factor)]
        inner_sum = linear_combination((c, multiply(part, inverse)) for part, c in multiples)
        terms = as_sum(linear_combination([_with_unit_sums(multiply(factor, inner_sum), 1.0), *other_terms])).terms
    return terms


def _with_unit_sums(part: Expression, c: float) -> tuple[float, Expression]:
    """Return (d, e) with d e = c m for the `part` m. Factors of m that are sums beginning with ±2^k begin with 1 in e."""
    factors = []
    for base, n in part.factors if isinstance(part, Product) else ():
        scale = base.terms[0][1] if isinstance(base, Sum) and n == int(n) else 1.0
        if abs(math.frexp(scale)[0]) != _MANTISSA_OF_POWERS_OF_TWO:
            scale = 1.0
        c *= scale**n
        factors.append(power(linear_combination([(1.0 / scale, base)]), n))
    return c, multiply(*factors) if factors else part


def _most_common_factor(terms: SumTerms) -> Expression | None:
    """Find the most common factor, and return the product of all factors that the products with this factor share.

    None if no factor is common. Among several most common factors, the first is used, so that graphs do not depend on hashes.
    """
    counts = Counter(factor for part, _ in terms for factor in _factors(part))
    factor, count = max(counts.items(), key=lambda item: item[1], default=(None, 0))
    if factor is None or count == 1:
        return None
    factor_lists = [_factors(part) for part, _ in terms if factor in _factors(part)]
    return multiply(*(each for each in factor_lists[0] if all(each in factors for factors in factor_lists)))


def _contains(part: Expression, factor: Expression) -> bool:
    """Return whether a product has all factors of another product."""
    return all(each in _factors(part) for each in _factors(factor) or (factor,))


def _factors(part: Expression) -> tuple[Expression, ...]:
    """Return the factors of a product in order; empty for a single factor, such as b^−1.

    A positive integer power of b has the factor b.
    """
    if not isinstance(part, Product):
        return ()
    factors = tuple(base if n > 0.0 and n == int(n) else power(base, n) for base, n in part.factors)
    return () if part in factors else factors
