"""Fuzz tests of the formula parser: any text is parsed as SymPy expands it, or refused with a ValueError."""

from __future__ import annotations

import random
import time

import pytest
import sympy

from engine.systems.formulas.formula_parser import parse_formula
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.potential import Potential

X, Y = sympy.symbols("x y")
LONGEST_SECONDS = 1.0


def random_formula(depth: int, rng: random.Random) -> tuple[str, sympy.Expr]:
    """Return a random formula as text and as a SymPy expression."""
    if depth == 0 or rng.random() < 0.2:
        number = rng.randint(1, 9)
        return rng.choice([("x", X), ("y", Y), (str(number), sympy.Integer(number)), ("0.25", sympy.Rational(1, 4))])
    left, a = random_formula(depth - 1, rng)
    right, b = random_formula(depth - 1, rng)
    power = rng.randint(0, 3)
    return rng.choice(
        [
            (f"({left}) + {right}", a + b),
            (f"({left}) − ({right})", a - b),
            (f"({left})·({right})", a * b),
            (f"({left})({right})", a * b),
            (f"({left})^{power}", a**power),
            (f"-({left})/{power + 1}", -a / (power + 1)),
            (f"r^2({left})", (X**2 + Y**2) * a),
        ]
    )


def try_parse(text: str) -> Potential | None:
    begin = time.process_time()
    try:
        return parse_formula(text)
    except FormulaError:
        return None
    finally:
        assert time.process_time() - begin < LONGEST_SECONDS


@pytest.mark.parametrize("seed", range(4))
def test_valid_formulas_agree_with_sympy(seed: int) -> None:
    rng = random.Random(seed)
    compared = 0
    for _ in range(50):
        text, expression = random_formula(4, rng)
        potential = try_parse(text)
        if potential is None:
            continue
        exact = sympy.Poly(expression, X, Y, domain="QQ")
        assert {(i, j): c for i, j, c in potential.terms} == {powers: float(c) for powers, c in exact.terms() if c}
        compared += 1
    assert compared > 15
