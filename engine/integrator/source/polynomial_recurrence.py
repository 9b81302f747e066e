"""Recurrence of the orbits in a polynomial V.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. Coefficient k + 2 of x
and y follows from coefficients 0 … k of the monomials in V_x and V_y (Jorba & Zou 2005, Experimental Mathematics 14, 99).
"""

from __future__ import annotations

import functools
import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from engine.expressions.polynomials import derivative
from engine.integrator.source.cauchy_products import (
    Monomial,
    Polynomial,
    Product,
    X,
    Y,
    find_difference,
    find_scales,
    plan_products,
)
from engine.integrator.source.series import (
    LONGEST_STEP,
    NO_REMAINDERS,
    ORDER,
    Hessian,
    PointFunctions,
    Series,
    Setting,
    add_coriolis,
    cauchy,
    half_square,
    total,
)
from engine.integrator.source.straight_line import StraightLine, Value

# Number of cached plans, two for each structure.
_CACHED_PLANS = 64

# Radius of a circle that contains all steps of orbits inside the exits, in units of the well.
_REACH = 3.0

Terms = tuple[tuple[int, int, float], ...]
"""((i, j, c), …): the terms c x^i y^j of V."""

Entry = tuple[Monomial, float, int]
"""(term, multiple, divisor): an entry of the table with the value −multiple · (the coefficient of a term of V) / divisor."""

# A derivative of V: for each of its monomials, the term of V from which it arises, and the factor due to the differentiation.
_Derivative = Mapping[Monomial, tuple[Monomial, float]]

# Axes, x (0) and y (1), of the derivatives of V in the equations of motion.
_GRADIENT = (0,), (1,)
# Axes of the derivatives of V in the variational equations.
_HESSIAN = (0, 0), (0, 1), (1, 1)
_GRADIENT_AND_HESSIAN = (*_GRADIENT, *_HESSIAN)

# Two squares that enter only as their difference, see `find_difference`.
_Difference = tuple[Product, Product] | None


@dataclass(frozen=True)
class PolynomialStructure:
    """The facts about a polynomial V on which generated code depends.

    `can_hide_crossings` tells whether the signs of y at the ends of a step can miss two crossings of y = 0 in the step.
    `difference` is the result of `_find_difference` for the gradient, and `tangent_difference` that for gradient and Hessian.
    """

    monomials: tuple[Monomial, ...]
    setting: Setting
    can_hide_crossings: bool
    difference: _Difference
    tangent_difference: _Difference

    has_many_scales: ClassVar[bool] = False
    """Whether frequencies can differ strongly from place to place: no, the well sets the only scale."""
    largest_norm: ClassVar[float] = 1e90
    """Norm of the last coefficients above which an orbit fails. It belongs to a step of 3e-7."""
    carries_remainders: ClassVar[bool] = False
    """Whether steps carry the rounding errors of x and y along: no, a polynomial is smooth everywhere."""

    def orbit(self, program: StraightLine, _remainders: Mapping[str, Value] = NO_REMAINDERS) -> tuple[Series, Series]:
        """Append the recurrence of the equations of motion to a program, and return the series of x and y."""
        products = _plan(self.monomials, _GRADIENT)
        series = _recurrence(program, self.monomials, products, self.difference, self.setting.rotates)
        return series[X], series[Y]

    def hessian(self, program: StraightLine) -> Hessian:
        """Append the recurrence of the variational equations to a program, and return the second derivatives of −V."""
        products = _plan(self.monomials, _GRADIENT_AND_HESSIAN)
        scales = find_scales(products)
        series = _recurrence(program, self.monomials, products, self.tangent_difference, self.setting.rotates)

        def coefficients(axes: tuple[int, int]) -> Callable[[int], Value]:
            derived = _formed_derivative(self.monomials, axes, self.tangent_difference)
            return lambda k: _linear_combination(program, derived, series, scales, k, 1)

        return {axes: (coefficients(axes), bool(_derivative(self.monomials, axes))) for axes in _HESSIAN}

    def point_functions(self) -> PointFunctions:
        """Return the function V alone."""
        return {"potential_value": lambda program: {"value": self._value(program)}}

    def _value(self, program: StraightLine) -> Value:
        x, y = program.input("x"), program.input("y")
        # The divisor −1 makes the entry the coefficient of V itself.
        terms = (functools.reduce(operator.mul, [x] * i + [y] * j, program.entry(((i, j), 1.0, -1))) for i, j in self.monomials)
        return total(program, terms)

    def tabulate(self, terms: Any, entries: Sequence[Entry]) -> list[float]:
        """Return the values of entries for a polynomial, see `Entry`."""
        polynomial = _sort_terms(terms)
        return [-1.0 / divisor * (polynomial[term] * multiple) for term, multiple, divisor in entries]


def _derivative(monomials: Iterable[Monomial], axes: Sequence[int]) -> _Derivative:
    """Return the derivative of V with respect to each of `axes` in turn."""
    factors: Polynomial = dict.fromkeys(monomials, 1)
    for axis in axes:
        factors = derivative(factors, axis)
    return {(i, j): ((i + axes.count(0), j + axes.count(1)), factor) for (i, j), factor in factors.items()}


@functools.lru_cache(maxsize=_CACHED_PLANS)
def _plan(monomials: tuple[Monomial, ...], derivatives: tuple[tuple[int, ...], ...]) -> tuple[Product, ...]:
    """Return the products from which the series of some derivatives of V are formed."""
    return tuple(plan_products(frozenset(monomial for axes in derivatives for monomial in _derivative(monomials, axes))))


def _find_difference(polynomial: Polynomial, derivatives: tuple[tuple[int, ...], ...]) -> _Difference:
    """Return two squares that enter some derivatives of V only as their difference."""
    derived = [_derivative(polynomial, axes) for axes in derivatives]
    polynomials = [
        {monomial: factor * polynomial[term] for monomial, (term, factor) in derived_terms.items()} for derived_terms in derived
    ]
    return find_difference(_plan(tuple(polynomial), derivatives), polynomials)


def _formed_derivative(monomials: Iterable[Monomial], axes: Sequence[int], difference: _Difference) -> _Derivative:
    """Return the monomials of a derivative of V whose series are computed.

    The series of the difference of two squares is computed in place of that of the first square; the second square is left out.
    """
    omitted = difference[1].monomial if difference is not None else None
    return {monomial: origin for monomial, origin in _derivative(monomials, axes).items() if monomial != omitted}


def _linear_combination(
    program: StraightLine,
    derived: _Derivative,
    series: Mapping[Monomial, Series],
    scales: Mapping[Monomial, float],
    k: int,
    divisor: int,
) -> Value:
    """Return −(coefficient k of the series of a derivative of V) / divisor.

    Low degrees come last: a sum of two products contracts into the first product, and the linear term is known earliest.
    """

    def summand(monomial: Monomial) -> Value:
        term, multiple = derived[monomial]
        entry = program.entry((term, multiple / scales[monomial], divisor))
        return entry * series[monomial][k] if sum(monomial) > 0 else entry

    # A constant has coefficient 0 only.
    return total(program, (summand(monomial) for monomial in reversed(list(derived)) if sum(monomial) > 0 or k == 0))


def _recurrence(
    program: StraightLine,
    monomials: tuple[Monomial, ...],
    products: Sequence[Product],
    difference: _Difference,
    rotates: bool,
) -> dict[Monomial, list[Value]]:
    """Return the series of x, y and `products`. A difference of two squares is stored in place of the first square."""
    series: dict[Monomial, list[Value]] = {
        X: [program.input("x0"), program.input("x1")],
        Y: [program.input("y0"), program.input("y1")],
        **{product.monomial: [] for product in products},
    }
    forces = {axis: _formed_derivative(monomials, axes, difference) for axis, axes in zip((X, Y), _GRADIENT, strict=True)}
    scales = find_scales(products)
    if difference is not None:
        minuend, subtrahend = difference
        products = [product for product in products if product not in difference]
    for k in range(ORDER - 1):
        for product in products:
            series[product.monomial].append(cauchy(series[product.left], series[product.right], k))
        if difference is not None:
            subtracted_products = (left * right for left, right in half_square(series[subtrahend.left], k))
            square = cauchy(series[minuend.left], series[minuend.left], k)
            series[minuend.monomial].append(functools.reduce(operator.sub, subtracted_products, square))
        for axis, force in forces.items():
            series[axis].append(_linear_combination(program, force, series, scales, k, (k + 1) * (k + 2)))
        if rotates:
            add_coriolis(program, series[X], series[Y])
    return series


def structure_of_polynomial(terms: Terms, setting: Setting) -> PolynomialStructure:
    """Return the structure of a potential that is a polynomial."""
    polynomial = _sort_terms(terms)
    differences = (_find_difference(polynomial, derivatives) for derivatives in (_GRADIENT, _GRADIENT_AND_HESSIAN))
    can_hide_crossings = setting.rotates or _crossings_can_hide(polynomial)
    return PolynomialStructure(tuple(polynomial), setting, can_hide_crossings, *differences)


def _crossings_can_hide(terms: Polynomial) -> bool:
    """Return whether, without rotation, the signs of y at the ends of a step can miss two crossings of y = 0 in the step.

    If V is even in y, ÿ = −g(x, y) y. With g below (π/h)², two zeros of y are farther than h apart, by Sturm's comparison with
    the oscillator of the frequency π/h. Terms of g that are nowhere positive cannot raise g.
    """
    force = derivative(terms, 1)
    if any(j % 2 == 0 for _, j in force):
        return True
    bound = sum(abs(c) * _REACH ** (i + j - 1) for (i, j), c in force.items() if c > 0 or i % 2 == 1)
    return bound >= (math.pi / LONGEST_STEP) ** 2


def _sort_terms(terms: Terms) -> dict[Monomial, float]:
    """Sort the terms by degree, so that their given order does not matter."""
    return {(i, j): c for i, j, c in sorted(terms, key=lambda term: (term[0] + term[1], -term[0]))}
