"""Sums rewritten with fewer products: x u + x v as x (u + v)."""

from __future__ import annotations

from collections import Counter

from engine.expressions.nodes import Expression, Product, Sum, linear_combination, multiply, power

Terms = tuple[tuple[Expression, float], ...]


def factor_out(terms: Terms) -> Terms:
    """Rewrite Σ c m with the most common factors of its products factored out; the constants of new sums are 0."""
    while (factor := _most_common_factor(terms)) is not None:
        inverse = power(factor, -1.0)
        rests = [(c, multiply(part, inverse)) if factor in _factors(part) else None for part, c in terms]
        inner = linear_combination(rest for rest in rests if rest is not None)
        others = ((c, part) for (part, c), rest in zip(terms, rests, strict=True) if rest is None)
        total = linear_combination([(1.0, multiply(factor, inner)), *others])
        terms = total.terms if isinstance(total, Sum) else ((total, 1.0),)
    return terms


def _most_common_factor(terms: Terms) -> Expression | None:
    """Return the factor that most products share, at least two of them; of several the first, so that programs do not vary."""
    counts = Counter(factor for part, _ in terms for factor in _factors(part))
    factor, count = max(counts.items(), key=lambda item: item[1], default=(None, 0))
    return factor if count > 1 else None


def _factors(part: Expression) -> tuple[Expression, ...]:
    """Return the factors of a product of at least two, in order; a positive integer power of b has the factor b."""
    if not isinstance(part, Product):
        return ()
    found = tuple(base if n > 0.0 and n == int(n) else power(base, n) for base, n in part.factors)
    return () if part in found else found
