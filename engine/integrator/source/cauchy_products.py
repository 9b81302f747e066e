"""Plans of Cauchy products: cheap sequences that yield every monomial in the forces, and the scales of their series."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass

Monomial = tuple[int, int]
"""The exponents (i, j) of x^i y^j."""

Polynomial = Mapping[Monomial, float]
"""{monomial: coefficient}."""

X, Y = (1, 0), (0, 1)

# Largest relative difference of coefficients that count as equal. A coefficient such as ε/3 has a few rounding errors.
_ROUNDING = 1e-15
# Number of cached results of `_cheapest`, of 1 kB each; a potential of degree 8 needs about 4 000.
_CACHED_RESULTS = 4096


@dataclass(frozen=True)
class Product:
    """One Cauchy product: the series of `monomial` from the series of two known factors.

    If both factors are the same, half the series is computed, which saves a multiplication in every other coefficient. The series
    of a monomial therefore has a scale factor, see `find_scales`.
    """

    monomial: Monomial
    left: Monomial
    right: Monomial


def plan_products(needed: AbstractSet[Monomial]) -> list[Product]:
    """Return a short list of Cauchy products that yields every needed monomial.

    The search is greedy, monomial by monomial. It is repeated with each divisor of a needed monomial formed first, and the
    cheapest plan is returned.
    """
    in_order = sorted(needed, key=_by_degree)
    divisors = {(a, b) for i, j in needed for a in range(i + 1) for b in range(j + 1) if a + b > 1}
    plans = [_greedy_plan(in_order), *(_greedy_plan([divisor, *in_order]) for divisor in sorted(divisors))]
    return min(plans, key=lambda plan: sum(map(_cost, plan)))


def _by_degree(monomial: Monomial) -> tuple[int, Monomial]:
    return sum(monomial), monomial


def _cost(product: Product) -> float:
    """Return the cost in units of a full product: a square has half the terms and some extra work."""
    return 0.55 if product.left == product.right else 1.0


def _greedy_plan(monomials: list[Monomial]) -> list[Product]:
    """Return the products that yield the monomials, each formed in turn in the cheapest way."""
    known = {X, Y, (0, 0)}
    plan: list[Product] = []
    for monomial in monomials:
        for product in _cheapest(monomial, frozenset(known))[1]:
            known.add(product.monomial)
            plan.append(product)
    return plan


@functools.lru_cache(maxsize=_CACHED_RESULTS)
def _cheapest(monomial: Monomial, known: frozenset[Monomial]) -> tuple[float, list[Product]]:
    """Return the cost and the products of the cheapest way to form a monomial, given known monomials."""
    if monomial in known:
        return 0.0, []
    cheapest: tuple[float, list[Product]] = (float("inf"), [])
    for left in ((a, b) for a in range(monomial[0] + 1) for b in range(monomial[1] + 1)):
        right = (monomial[0] - left[0], monomial[1] - left[1])
        if left < right or sum(right) == 0:
            continue
        cost_left, plan_left = _cheapest(left, known)
        cost_right, plan_right = _cheapest(right, known | {p.monomial for p in plan_left})
        product = Product(monomial, left, right)
        cost = cost_left + cost_right + _cost(product)
        if cost < cheapest[0]:
            cheapest = cost, [*plan_left, *plan_right, product]
    return cheapest


def find_scales(plan: Sequence[Product]) -> dict[Monomial, float]:
    """Return {monomial: scale}; a computed series is the series of the monomial times this scale."""
    scales = {X: 1.0, Y: 1.0, (0, 0): 1.0}
    for product in plan:
        scales[product.monomial] = scales[product.left] * scales[product.right] * (0.5 if product.left == product.right else 1.0)
    return scales


def find_difference(products: Sequence[Product], polynomials: Sequence[Polynomial]) -> tuple[Product, Product] | None:
    """Return two squares that enter all `polynomials` only as their difference, to rounding, so that one series replaces both.

    The series of the squares must have the same scale, because the difference is formed from the series.
    """
    scales = find_scales(products)
    factors = {monomial for product in products for monomial in (product.left, product.right)}
    squares = [product for product in products if product.left == product.right and product.monomial not in factors]
    for first, second in itertools.combinations(squares, 2):
        if scales[first.monomial] != scales[second.monomial]:
            continue
        pairs = [(polynomial.get(first.monomial, 0.0), -polynomial.get(second.monomial, 0.0)) for polynomial in polynomials]
        if all(math.isclose(a, b, rel_tol=_ROUNDING) for a, b in pairs):
            return first, second
    return None
