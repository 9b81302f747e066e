"""Common factors are taken out of sums, which saves products, and the graph is the same in every process."""

import os
import subprocess
import sys

from engine.expressions.common_factors import factor_out
from engine.expressions.nodes import Product, X, Y, apply_function, linear_combination, multiply, number

PROGRAM = """
from engine import parse_formula
from engine.expressions.calculus import derivative
from engine.expressions.graph import make_graph
form = parse_formula("½r² + exp(sin(exp(cos(x y)))) exp(sin(x)) cos(exp(x + 2y)) exp(sin(y)) cos(exp(y − x)) sin(y)").form
slopes = [derivative(form.expression, axis) for axis in (0, 1)]
print(make_graph((*slopes, *(derivative(slope, axis) for slope in slopes for axis in (0, 1)))))
"""


def test_a_factor_of_two_products_is_taken_out() -> None:
    sine, cosine = apply_function("sin", Y), apply_function("cos", Y)
    ((product, _),) = factor_out(((multiply(X, sine), 2.0), (multiply(X, cosine), 3.0)))
    assert isinstance(product, Product)
    assert X in dict(product.factors)


def test_all_common_factors_are_taken_out_at_once() -> None:
    sine, cosine = apply_function("sin", Y), apply_function("cos", Y)
    ((product, _),) = factor_out(((multiply(X, sine, Y), 2.0), (multiply(X, cosine, Y), 3.0)))
    assert isinstance(product, Product)
    assert {X, Y} < dict(product.factors).keys()


def test_sums_that_differ_by_a_power_of_two_are_a_common_factor() -> None:
    one, double = (linear_combination([(c, X), (0.3 * c, number(1.0))]) for c in (1.0, 2.0))
    ((product, _),) = factor_out(
        ((multiply(one, apply_function("sin", Y)), 2.0), (multiply(double, apply_function("cos", Y)), 3.0))
    )
    assert isinstance(product, Product)
    assert one in dict(product.factors)


def test_the_graph_does_not_depend_on_hashes() -> None:
    assert _graph_of_a_process(seed=1) == _graph_of_a_process(seed=2)


def _graph_of_a_process(seed: int) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": str(seed)}
    command = [sys.executable, "-c", PROGRAM]
    return subprocess.run(command, env=environment, capture_output=True, check=True, text=True).stdout
