"""Arbitrary and hostile text: it is read as SymPy would expand it, or refused with a ValueError; nothing else ever happens."""

from __future__ import annotations

import random
import time

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.potentials.formula_parser import FormulaError, parse_formula
from engine.potentials.potential import Potential

X, Y = sympy.symbols("x y")
PIECES = (
    *("x", "y", "r", "x²", "y^3", "r²", "2", "0.5", "½", "1e3", "1e-3", "⁷", "^2", "**2", "^12", "^13", "^99999999", "(", ")"),
    *("+", "-", "−", "*", "/", "·", "×", "//", "%", "e", "E", "1e999", "9^9^9", "..", ".", ",", " ", "\t", "\n", "V=", "=", "∞"),
    *(
        "__import__('os').system('true')",
        "lambda:0",
        "exec",
        "{",
        "}",
        "[0]",
        ";",
        "#",
        "\\",
        "'",
        '"',
        "\u0000",
        "𝑥",
        "٣",
        "х",
        "()",
    ),
)
LONGEST_SECONDS = 1.0


def trees(depth: int, rng: random.Random) -> tuple[str, sympy.Expr]:
    """A formula as text, and what SymPy takes it for."""
    if depth == 0 or rng.random() < 0.2:
        number = rng.randint(1, 9)
        return rng.choice([("x", X), ("y", Y), (str(number), sympy.Integer(number)), ("0.25", sympy.Rational(1, 4))])
    left, a = trees(depth - 1, rng)
    right, b = trees(depth - 1, rng)
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


def read(text: str) -> Potential | None:
    begin = time.process_time()
    try:
        return parse_formula(text)
    except FormulaError:
        return None
    finally:
        assert time.process_time() - begin < LONGEST_SECONDS


@pytest.mark.parametrize("seed", range(10))
def test_a_hundred_sums_of_hostile_pieces_are_read_or_refused(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(100):
        read("".join(rng.choice(PIECES) for _ in range(rng.randint(1, 60))))


@pytest.mark.parametrize("seed", range(4))
def test_well_formed_formulas_are_what_sympy_expands_them_to(seed: int) -> None:
    rng = random.Random(seed)
    compared = 0
    for _ in range(50):
        text, expression = trees(4, rng)
        potential = read(text)
        if potential is None:
            continue
        exact = sympy.Poly(expression, X, Y, domain="QQ")
        assert {(i, j): c for i, j, c in potential.terms} == {powers: float(c) for powers, c in exact.terms() if c}
        compared += 1
    assert compared > 15


@settings(max_examples=400)
@given(st.text(max_size=600))
def test_any_text_is_read_or_refused(text: str) -> None:
    read(text)


@settings(max_examples=400)
@given(st.text("xyr0123456789.^*/+-()²³½ −e", max_size=80))
def test_any_text_of_legal_characters_is_read_or_refused(text: str) -> None:
    read(text)
