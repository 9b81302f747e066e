"""Common factors taken out of sums: fewer products, the same graph in every process."""

import os
import subprocess
import sys

from engine.expressions.common_factors import factor_out
from engine.expressions.nodes import Product, X, Y, apply_function, multiply

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


def test_the_graph_does_not_depend_on_hashes() -> None:
    one, *others = (_graph_of_a_process(seed) for seed in range(3))
    assert all(other == one for other in others)


def _graph_of_a_process(seed: int) -> str:
    environment = {**os.environ, "PYTHONHASHSEED": str(seed)}
    command = [sys.executable, "-c", PROGRAM]
    return subprocess.run(command, env=environment, capture_output=True, check=True, text=True).stdout
