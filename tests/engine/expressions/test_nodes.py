"""Expressions have a canonical form."""

from __future__ import annotations

import pytest

from engine.expressions.nodes import (
    Expression,
    X,
    Y,
    apply_function,
    as_terms,
    from_terms,
    linear_combination,
    multiply,
    number,
    power,
)


def plus(*parts: Expression) -> Expression:
    return linear_combination((1.0, part) for part in parts)


SQUARE = plus(power(X, 2.0), power(Y, 2.0))
MINUS_X = linear_combination([(-1.0, X)])
WAVE = apply_function("sin", multiply(X, Y))
GROWING, FALLING = apply_function("exp", X), apply_function("exp", MINUS_X)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (plus(X, Y), plus(Y, X)),
        (plus(X, X), linear_combination([(2.0, X)])),
        (multiply(X, WAVE, Y), multiply(WAVE, Y, X)),
        (multiply(power(X, 0.5), power(X, 1.5)), power(X, 2.0)),
        (multiply(power(MINUS_X, 0.5), power(MINUS_X, 0.5)), MINUS_X),
        (multiply(power(MINUS_X, -0.5), power(MINUS_X, -1.5), Y), multiply(power(X, -2.0), Y)),
        (power(power(SQUARE, 0.5), 3.0), power(SQUARE, 1.5)),
        (power(linear_combination([(4.0, SQUARE)]), 0.5), power(linear_combination([(4.0, SQUARE)]), 0.5)),
        (power(multiply(number(4.0), WAVE), 0.5), linear_combination([(2.0, power(WAVE, 0.5))])),
        (apply_function("exp", number(0.0)), number(1.0)),
        (multiply(number(0.0), WAVE), number(0.0)),
        (power(WAVE, 0.0), number(1.0)),
        (multiply(GROWING, apply_function("exp", plus(Y, MINUS_X))), apply_function("exp", Y)),
        (multiply(GROWING, power(GROWING, -1.0), WAVE), WAVE),
        (multiply(plus(GROWING, Y), FALLING), plus(number(1.0), multiply(Y, FALLING))),
        (multiply(power(plus(GROWING, Y), 2.0), power(FALLING, 2.0)), power(plus(number(1.0), multiply(Y, FALLING)), 2.0)),
        (multiply(power(plus(GROWING, Y), -1.0), GROWING), power(plus(number(1.0), multiply(Y, FALLING)), -1.0)),
    ],
)
def test_equal_formulas_are_equal_and_have_equal_hashes(one: Expression, other: Expression) -> None:
    assert one == other
    assert hash(one) == hash(other)


def test_polynomials_survive_conversion_to_terms_and_back() -> None:
    terms = {(2, 0): 0.5, (1, 2): -1.0, (0, 0): 3.0}
    assert as_terms(from_terms(terms)) == terms
    assert as_terms(multiply(X, WAVE)) is None


@pytest.mark.parametrize(("name", "value"), [("log", -1.0), ("log", 0.0), ("exp", 1e4)])
def test_functions_outside_their_domain_are_refused(name: str, value: float) -> None:
    with pytest.raises((ArithmeticError, ValueError)):
        apply_function(name, number(value))
