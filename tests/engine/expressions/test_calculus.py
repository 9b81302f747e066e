"""Derivatives and parities of random formulas agree with SymPy."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

from engine import parse_formula
from engine.expressions.calculus import derivative, substitute
from engine.expressions.evaluation import evaluate
from engine.expressions.graph import make_graph
from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum, X, Y, linear_combination, multiply, number
from engine.expressions.parity import EVEN, NEITHER, ODD, parity
from tests.peers.random_systems import random_formula

AXES = sympy.symbols("x y")
PLACES = np.random.default_rng(3).uniform(-0.8, 0.8, (5, 2))

seeds = pytest.mark.parametrize("seed", range(6))


def random_expression(seed: int) -> Expression:
    text, values = random_formula(seed)
    definition = parse_formula(text, parameters=values).form.definition
    assert isinstance(definition, Expression)
    return definition


def in_sympy(expression: Expression) -> sympy.Expr:
    match expression:
        case Coordinate(axis):
            return AXES[axis]
        case Sum(constant, terms):
            return sympy.Float(constant, 30) + sympy.Add(*(sympy.Float(c, 30) * in_sympy(part) for part, c in terms))
        case Product(factors):
            return sympy.Mul(*(in_sympy(base) ** (int(n) if n == int(n) else sympy.Float(n, 30)) for base, n in factors))
        case Function(name, argument):
            return getattr(sympy, name)(in_sympy(argument))
    raise TypeError(expression)


def values_of(expression: Expression) -> np.ndarray:
    graph, numbers = make_graph((expression,))
    return evaluate(graph, numbers, *PLACES.T)[0]


@seeds
@pytest.mark.parametrize("orders", [(1, 0), (0, 1), (2, 0), (1, 1), (0, 2)])
def test_derivatives_agree_with_sympy(seed: int, orders: tuple[int, int]) -> None:
    expression = random_expression(seed)
    derived = expression
    for axis, order in enumerate(orders):
        for _ in range(order):
            derived = derivative(derived, axis)
    exact = sympy.diff(in_sympy(expression), *zip(AXES, orders, strict=True))
    expected = [float(exact.evalf(25, subs=dict(zip(AXES, place, strict=True)))) for place in PLACES.tolist()]
    np.testing.assert_allclose(values_of(derived), expected, rtol=1e-11, atol=1e-12)


@seeds
def test_substitution_commutes_with_evaluation(seed: int) -> None:
    expression = random_expression(seed)
    x, y = linear_combination([(0.5, X), (0.1, number(1.0))]), linear_combination([(1.0, Y), (-0.25, X)])
    graph, numbers = make_graph((expression,))
    px, py = PLACES.T
    expected = evaluate(graph, numbers, 0.5 * px + 0.1, py - 0.25 * px)[0]
    np.testing.assert_allclose(values_of(substitute(expression, x, y)), expected, rtol=1e-12)


@seeds
@pytest.mark.parametrize("axis", [0, 1])
def test_values_have_the_parity_exactly(seed: int, axis: int) -> None:
    expression = multiply(X, X, random_expression(seed))
    sign = parity(expression, axis)
    graph, numbers = make_graph((expression,))
    mirrored = PLACES * np.where(np.arange(2) == axis, -1.0, 1.0)
    same = evaluate(graph, numbers, *mirrored.T)[0] == sign * evaluate(graph, numbers, *PLACES.T)[0]
    assert same.all() == (sign != NEITHER)


@pytest.mark.parametrize(
    ("text", "in_x", "in_y"),
    [
        ("x² exp(−y²)", EVEN, EVEN),
        ("x y cos(x)", ODD, ODD),
        ("sin(x y)", ODD, ODD),
        ("exp(x) + y²", NEITHER, EVEN),
        ("(x² + y² + 1)^(−1/2)", EVEN, EVEN),
        ("√(1 + (x − 1)²) + √(1 + (x + 1)²)", NEITHER, EVEN),
    ],
)
def test_known_expressions_have_their_parities(text: str, in_x: int, in_y: int) -> None:
    definition = parse_formula(text).form.definition
    assert isinstance(definition, Expression)
    assert (parity(definition, 0), parity(definition, 1)) == (in_x, in_y)
