"""Graphs of expressions have few of the nodes whose series need a sum over all lower orders."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.expressions.calculus import derivative
from engine.expressions.evaluation import evaluate, evaluate_at
from engine.expressions.graph import Graph, Node, make_graph
from engine.expressions.nodes import Expression


def definition_of(text: str) -> Expression:
    definition = parse_formula(text).form.definition
    assert isinstance(definition, Expression)
    return definition


def curvature_graph(text: str) -> Graph:
    slope = derivative(definition_of(text), 0)
    return make_graph((slope, derivative(slope, 0)))[0]


def nodes_of(graph: Graph, kind: str) -> list[Node]:
    return [node for node in graph.nodes if node.kind == kind]


@pytest.mark.parametrize(
    ("text", "exponents"),
    [
        ("√(1 + x² + 2y²)", {0.5: None, -0.5: 0.5, -1.5: -0.5}),
        ("−1/√(1 + x² + 2y²)", {-1.5: None, -2.5: -1.5}),
        ("1/(1 + x² + 2y²)²", {-1.0: None}),
    ],
)
def test_powers_of_a_base_follow_from_each_other(text: str, exponents: dict[float, float | None]) -> None:
    graph = curvature_graph(text)
    higher = {node.exponent: [graph.nodes[k].exponent for k in node.operands[1:]] for node in nodes_of(graph, "power")}
    assert higher == {exponent: [] if other is None else [other] for exponent, other in exponents.items()}


def test_the_slope_of_an_inverse_hyperbolic_sine_keeps_its_digits_where_its_argument_is_small() -> None:
    graph, numbers = make_graph((derivative(definition_of("log(x + √(x² + y² + 1))"), 0),))
    assert evaluate(graph, numbers, -1e6, 0.3)[0] == pytest.approx(1.0 / np.sqrt(1e12 + 1.09), rel=1e-15)


def test_other_slopes_of_logarithms_of_roots_are_quotients() -> None:
    graph, numbers = make_graph((derivative(definition_of("log(x + √(2x² + y² + 1))"), 0),))
    root = np.sqrt(2.0 * 0.49 + 1.09)
    assert evaluate(graph, numbers, 0.7, 0.3)[0] == pytest.approx((1.0 + 1.4 / root) / (0.7 + root), rel=1e-14)


@pytest.mark.parametrize(
    "text", ["x² − 3x y + 2", "exp(x y) + sin(3x) cos(y) − log(2 + x)", "(x − y)^−3 + √(x + 5)", "√(x − 9)", "1/(x − 0.3)"]
)
def test_values_at_one_point_equal_values_of_arrays(text: str) -> None:
    potential = parse_formula(f"{text} + exp(x)")
    graph, numbers = make_graph((potential.form.definition, derivative(potential.form.definition, 0)))
    np.testing.assert_allclose(evaluate_at(graph, numbers, 0.3, -0.7), evaluate(graph, numbers, 0.3, -0.7), rtol=1e-14)
