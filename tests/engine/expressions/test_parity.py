"""An expression is even also if the reflection exchanges its parts, and only if its values are equal."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.expressions.nodes import from_terms
from engine.expressions.parity import is_even
from engine.systems.forms.polynomial_form import PolynomialForm


@pytest.mark.parametrize(
    ("formula", "in_x", "in_y"),
    [
        ("−1/√(x² + (y − 0.3)² + 0.5) − 1/√(x² + (y + 0.3)² + 0.5)", True, True),
        ("−1/√(x² + (y − 0.3)² + 0.5) − 1.01/√(x² + (y + 0.3)² + 0.5)", True, False),
        ("exp(x + 2y) + exp(x − 2y) + exp(−2x)", False, True),
        ("1/((y − 1)² + x²)³ + 1/((y + 1)² + x²)³", True, True),
        ("(x + y + exp(−r²))³ + (x − y + exp(−r²))³", False, True),
        ("x² cos(y) + (1 − exp(−y))² + (1 − exp(y))²", True, True),
        ("r² + sin(x + y) + sin(x − y)", False, True),
        ("r² + y sin(y) + x² sin(x)", False, True),
        # The last term is smaller than the rounding errors near the origin.
        ("r² + exp(10(y − 20))", True, False),
        ("x² + y² − 2xy² + 3x⁴", False, True),
    ],
)
def test_an_expression_is_even_if_its_values_are_equal(formula: str, in_x: bool, in_y: bool) -> None:
    form = parse_formula(formula).form
    expression = from_terms(form.coefficients) if isinstance(form, PolynomialForm) else form.expression
    assert [is_even(expression, axis) for axis in (0, 1)] == [in_x, in_y]
    x, y = np.random.default_rng(2).uniform(-1.0, 1.0, (2, 50)) * [[1.0], [25.0]]
    for image, even in (((-x, y), in_x), ((x, -y), in_y)):
        value, other = form.value(x, y), form.value(*image)
        assert bool(np.allclose(other, value, rtol=1e-12, atol=0.0)) is even
