"""Expressions in x and y: immutable trees in canonical form, so that equal formulas are equal objects.

An expression is a coordinate, a sum constant + Σ c m of expressions m, a product Π b^a of expressions b with real exponents, or a
function exp, log, sin or cos of an expression. Numbers are coefficients of sums, and a single number is a sum without terms.
Parameters already have their values.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any

from engine.expressions.polynomials import Powers, Terms


class Expression:
    """A node of a tree with everything below the node.

    Attributes
    ----------
    key
        A tuple that differs between unequal expressions, used for comparisons and for the order of the parts of sums and
        products.
    """

    @cached_property
    def key(self) -> tuple[Any, ...]:
        """The key, which each kind of node defines."""
        raise NotImplementedError

    @cached_property
    def _hash(self) -> int:
        return hash(self.key)

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Expression) and self._hash == other._hash and self.key == other.key)

    def __hash__(self) -> int:
        return self._hash

    def __getstate__(self) -> dict[str, Any]:
        """Return the state without the cached key and hash, because hashes differ between processes."""
        return {name: value for name, value in self.__dict__.items() if name not in ("key", "_hash")}


@dataclass(frozen=True, eq=False)
class Coordinate(Expression):
    """x (axis 0) or y (axis 1)."""

    axis: int

    @cached_property
    def key(self) -> tuple[Any, ...]:
        """See `Expression`."""
        return 0, self.axis


@dataclass(frozen=True, eq=False)
class Function(Expression):
    """exp, log, sin or cos of an expression."""

    name: str
    argument: Expression

    @cached_property
    def key(self) -> tuple[Any, ...]:
        """See `Expression`."""
        return 1, self.name, self.argument.key


@dataclass(frozen=True, eq=False)
class Product(Expression):
    """Π b^a, with finite exponents a ≠ 0."""

    factors: tuple[tuple[Expression, float], ...]

    @cached_property
    def key(self) -> tuple[Any, ...]:
        """See `Expression`."""
        return 2, tuple((base.key, exponent) for base, exponent in self.factors)


@dataclass(frozen=True, eq=False)
class Sum(Expression):
    """constant + Σ c m, where no m is a sum and no c is 0."""

    constant: float
    terms: tuple[tuple[Expression, float], ...]

    @cached_property
    def key(self) -> tuple[Any, ...]:
        """See `Expression`."""
        return 3, tuple((part.key, c) for part, c in self.terms), self.constant


X, Y = Coordinate(0), Coordinate(1)

FUNCTIONS: Mapping[str, Callable[[float], float]] = MappingProxyType(
    {"cos": math.cos, "exp": math.exp, "log": math.log, "sin": math.sin}
)
"""The functions of expressions, applied to numbers."""


def number(value: float) -> Sum:
    """Return a number as an expression."""
    return Sum(float(value), ())


def as_number(expression: Expression) -> float | None:
    """Return the value of a constant; None for other expressions."""
    return expression.constant if isinstance(expression, Sum) and not expression.terms else None


def as_sum(expression: Expression) -> Sum:
    """Return a sum itself, or any other expression as a sum with one term."""
    return expression if isinstance(expression, Sum) else Sum(0.0, ((expression, 1.0),))


def factors_of(expression: Expression) -> tuple[tuple[Expression, float], ...]:
    """Return the factors (b, a) of a product Π b^a; for any other expression, the expression with the exponent 1."""
    return expression.factors if isinstance(expression, Product) else ((expression, 1.0),)


def linear_combination(parts: Iterable[tuple[float, Expression]]) -> Expression:
    """Return Σ c e over the pairs (c, e)."""
    constant = 0.0
    coefficients: dict[Expression, float] = {}
    for c, part in parts:
        inner = as_sum(part)
        constant += c * inner.constant
        for each, d in inner.terms:
            coefficients[each] = coefficients.get(each, 0.0) + c * d
    terms = tuple(sorted(((part, c) for part, c in coefficients.items() if c), key=lambda term: _order(term[0])))
    if not constant and len(terms) == 1 and terms[0][1] == 1.0:
        return terms[0][0]
    return Sum(constant, terms)


def multiply(*factors: Expression) -> Expression:
    """Return the product of expressions. Powers of the same base and exponentials of different arguments are joined.

    Sums are not expanded, except if this removes an exponential: (exp(x) + y) exp(−x) is 1 + y exp(−x), which does not overflow.
    """
    coefficient = 1.0
    exponents: dict[Expression, float] = {}
    for factor in factors:
        scale, rest = _split_coefficient(factor)
        coefficient *= scale
        for base, exponent in factors_of(rest):
            if as_number(base) is None:
                exponents[base] = exponents.get(base, 0.0) + exponent
    if not coefficient:
        return number(0.0)
    exponents = {base: n for base, n in exponents.items() if n}
    if rewritten := _with_fewer_exponentials(exponents):
        return multiply(number(coefficient), *rewritten)
    # The sum of exponents can be an integer, so that the coefficient of the base leaves the power: √(−x) √(−x) is −x.
    scaled_bases = [base for base, n in exponents.items() if n == int(n) and _split_coefficient(base)[1] is not base]
    if scaled_bases:
        powers = [power(base, exponents.pop(base)) for base in scaled_bases]
        return multiply(number(coefficient), *_powers(exponents.items()), *powers)
    remaining = tuple(sorted(exponents.items(), key=lambda factor: factor[0].key))
    if not remaining:
        return number(coefficient)
    product = remaining[0][0] if len(remaining) == 1 and remaining[0][1] == 1.0 else Product(remaining)
    return linear_combination([(coefficient, product)])


def _with_fewer_exponentials(factors: Mapping[Expression, float]) -> list[Expression]:
    """Return factors equal to Π b^a with exponentials joined, or one multiplied into a sum with its inverse; empty if none."""
    arguments = [argument for factor in factors.items() if (argument := _argument(factor)) is not None]
    others = [factor for factor in factors.items() if _argument(factor) is None]
    if len(arguments) > 1:
        return [apply_function("exp", linear_combination((1.0, each) for each in arguments)), *_powers(others)]
    for argument in arguments:
        for k, (base, exponent) in enumerate(others):
            if isinstance(base, Sum) and _contains_exponential(base, linear_combination([(-1.0 / exponent, argument)])):
                scale = apply_function("exp", linear_combination([(1.0 / exponent, argument)]))
                return [power(expand(scale, base), exponent), *_powers(others[:k] + others[k + 1 :])]
    return []


def _argument(factor: tuple[Expression, float]) -> Expression | None:
    """Return the expression a f of a factor exp(f)^a; None for other factors."""
    base, exponent = factor
    return linear_combination([(exponent, base.argument)]) if isinstance(base, Function) and base.name == "exp" else None


def _contains_exponential(total: Sum, argument: Expression) -> bool:
    """Return whether exp(argument) is a factor of a term of a sum."""
    return any(_argument(factor) == argument for part, _ in total.terms for factor in factors_of(part))


def _powers(factors: Iterable[tuple[Expression, float]]) -> list[Expression]:
    return [Product((factor,)) for factor in factors]


def expand(factor: Expression, total: Expression) -> Expression:
    """Return the product of a factor and a sum, multiplied term by term."""
    if not isinstance(total, Sum):
        return multiply(factor, total)
    terms = ((c, multiply(factor, part)) for part, c in total.terms)
    return linear_combination([(total.constant, factor), *terms])


def power(base: Expression, exponent: float) -> Expression:
    """Return a power with a real exponent; ArithmeticError or ValueError if a power of a number is not a finite real number."""
    coefficient, rest = _split_coefficient(base)
    is_integer = exponent == int(exponent)
    if exponent == 0.0:
        return number(1.0)
    # A negative coefficient cannot leave a root: the power of the whole base may be real.
    if coefficient < 0.0 and not is_integer:
        coefficient, rest = 1.0, base
    if as_number(rest) is not None:
        return number(_checked_finite(math.pow(coefficient * rest.constant, exponent)))  # type: ignore[attr-defined]
    if isinstance(rest, Product) and (is_integer or (len(rest.factors) == 1 and _keeps_domain(rest.factors[0][1]))):
        power_of_rest: Expression = multiply(*(Product(((b, n * exponent),)) for b, n in rest.factors))
    else:
        power_of_rest = rest if exponent == 1.0 else Product(((rest, float(exponent)),))
    return linear_combination([(_checked_finite(math.pow(coefficient, exponent)), power_of_rest)])


def _keeps_domain(inner: float) -> bool:
    """Return whether (b^inner)^a is rewritten as b^(inner a). For other integers, value or domain could change: √(b²) is |b|."""
    return inner != int(inner) or abs(inner) == 1.0


def apply_function(name: str, argument: Expression) -> Expression:
    """Return a function of an expression; ArithmeticError or ValueError for a number outside its domain."""
    value = as_number(argument)
    return Function(name, argument) if value is None else number(_checked_finite(FUNCTIONS[name](value)))


def from_terms(terms: Terms) -> Expression:
    """Return the polynomial Σ c x^i y^j, given as {(i, j): c}, as an expression."""
    return linear_combination((c, multiply(power(X, i), power(Y, j))) for (i, j), c in terms.items())


def as_terms(expression: Expression) -> dict[Powers, float] | None:
    """Return {(i, j): c} of an expanded polynomial; None for other expressions."""
    total = as_sum(expression)
    terms = {(0, 0): total.constant} if total.constant else {}
    for part, c in total.terms:
        powers = powers_of(part)
        if powers is None:
            return None
        terms[powers] = c
    return terms


def powers_of(expression: Expression) -> Powers | None:
    """Return (i, j) of x^i y^j; None for other expressions."""
    powers = [0, 0]
    for base, exponent in factors_of(expression):
        if not isinstance(base, Coordinate) or exponent < 0.0 or exponent != int(exponent):
            return None
        powers[base.axis] += int(exponent)
    return powers[0], powers[1]


def _split_coefficient(expression: Expression) -> tuple[float, Expression]:
    """Return (c, e) with expression = c e, where e has no coefficient of its own."""
    value = as_number(expression)
    if value is not None:
        return value, number(1.0)
    if isinstance(expression, Sum) and not expression.constant and len(expression.terms) == 1:
        part, c = expression.terms[0]
        return c, part
    return 1.0, expression


def _order(part: Expression) -> tuple[Any, ...]:
    """Return the sort key of a term of a sum: x^i y^j by degree and by the power of y, then other terms."""
    powers = powers_of(part)
    return (1, part.key) if powers is None else (0, sum(powers), powers[1])


def _checked_finite(value: float) -> float:
    if not math.isfinite(value):
        raise OverflowError
    return value
