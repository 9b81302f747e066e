from __future__ import annotations

import re
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.potentials.formula_parser import FormulaError, parse_formula, write_formula
from engine.potentials.potential import CASES, Potential

III = CASES["III"].terms

exponents = st.tuples(st.integers(0, 6), st.integers(0, 6)).filter(lambda powers: sum(powers) > 0)
sizes = st.one_of(
    st.floats(1e-6, 1e6),
    st.integers(1, 999).map(float),
    st.tuples(st.integers(1, 99), st.integers(1, 99)).map(lambda q: q[0] / q[1]),
)
coefficients = st.tuples(sizes, st.sampled_from((-1.0, 1.0))).map(lambda pair: pair[0] * pair[1])
tables = st.dictionaries(exponents, coefficients, min_size=1, max_size=8)


def potential_of(table: dict[tuple[int, int], float]) -> Potential:
    return Potential("random", tuple((i, j, c) for (i, j), c in table.items()))


@pytest.mark.parametrize(
    "text",
    [
        "½(x² + y²) − x²y²",
        "0.5*(x^2+y^2) - x^2*y^2",
        "1/2 x^2 + 1/2 y^2 - x^2 y^2",
        ".5r^2 - (xy)^2",
        "r²/2 − x·x·y×y",
        "V = 1/2 (x**2 + y**2) - x**2*y**2",
        "V(x, y) = (x^2+y^2)/(1+1) - ((x))^2 y²",
        "5e-1(x²+y²)+-x²y²",
    ],
)
def test_case_3_in_different_notations(text: str) -> None:
    assert parse_formula(text).terms == III


def test_expansion_is_exact_before_rounding() -> None:
    # In floating point 0.1 + 0.2 − 0.3 leaves a term of 5.6e-17 x.
    assert parse_formula("0.1x + 0.2x - 0.3x + x²").terms == ((2, 0, 1.0),)


@pytest.mark.parametrize(
    ("text", "terms"),
    [
        ("-x^2", ((2, 0, -1.0),)),
        ("2x²/4y", ((2, 1, 0.5),)),
        ("x - -x", ((1, 0, 2.0),)),
        ("--x", ((1, 0, 1.0),)),
        ("(x+y)³", ((3, 0, 1.0), (2, 1, 3.0), (1, 2, 3.0), (0, 3, 1.0))),
        ("r^4", ((4, 0, 1.0), (2, 2, 2.0), (0, 4, 1.0))),
        ("y + 1/4", ((0, 0, 0.25), (0, 1, 1.0))),
        ("x^0 y", ((0, 1, 1.0),)),
        ("2³x", ((1, 0, 8.0),)),
    ],
)
def test_operator_precedence(text: str, terms: tuple[tuple[int, int, float], ...]) -> None:
    assert parse_formula(text).terms == terms


@pytest.mark.parametrize(
    ("text", "position", "reason"),
    [
        ("", 0, "ends"),
        ("x +", 3, "ends"),
        ("x + sin(x)", 4, "not understood"),
        ("x2", 1, "directly after"),
        ("2 3x", 2, "directly after"),
        ("x/y", 1, "number other than 0"),
        ("x/0", 1, "number other than 0"),
        ("x//2", 2, "unexpected /"),
        ("(x + y", 0, "not closed"),
        ("x + y)", 5, "unexpected )"),
        ("x^y", 2, "an integer from 0"),
        ("x^-1", 2, "an integer from 0"),
        ("x^2.5", 2, "an integer from 0"),
        ("x^13", 2, "from 0 to 12"),
        ("(x+y)^999999999", 6, "from 0 to 12"),
        ("9^9^9^9", 3, "power of a power"),
        ("x^7 y^6", 4, "degree 13"),
        ("((x^4)^4)^4", 1, "degree 16"),
        ("((9^12)^12)^12 x", 0, "300 digits"),
        ("1e999x", 0, "decimal exponent"),
        ("1e12x", 0, "between 1e-09 and 1e"),
        ("1e-12x", 0, "between 1e-09 and 1e"),
        ("r + x", 0, "even power"),
        ("r^3", 0, "even power"),
        ("3 + 4", 0, "neither x nor y"),
        ("x - x", 0, "neither x nor y"),
        ("(1 + x + y)^12", 0, "91 terms"),
        ("x" + " " * 500, 500, "at most 500"),
        ("(" * 51 + "x" + ")" * 51, 50, "more than 50"),
        ("__import__('os')", 0, "not understood"),
        ("x\u0000", 1, "not understood"),
        ("١x", 0, "not understood"),
    ],
)
def test_errors_have_position_and_reason(text: str, position: int, reason: str) -> None:
    with pytest.raises(FormulaError, match=re.escape(reason)) as caught:
        parse_formula(text)
    assert caught.value.position == position


def test_fifty_nested_brackets_are_parsed() -> None:
    assert parse_formula("(" * 50 + "x" + ")" * 50).terms == ((1, 0, 1.0),)


def test_large_expansions_are_fast() -> None:
    text = "*".join(["(x+y+1)^2"] * 6) + "*" + "*".join(["(1/7+2/3)"] * 40)
    begin = time.process_time()
    with pytest.raises(FormulaError):
        parse_formula(text[:500])
    assert time.process_time() - begin < 1.0


@given(tables)
def test_written_formula_parses_to_the_same_terms(table: dict[tuple[int, int], float]) -> None:
    potential = potential_of(table)
    assert sorted(parse_formula(write_formula(potential)).terms) == sorted(potential.terms)


@given(tables, st.integers(3, 15))
def test_a_formula_of_few_digits_has_small_relative_errors(table: dict[tuple[int, int], float], digits: int) -> None:
    potential = potential_of(table)
    again = parse_formula(write_formula(potential, digits))
    assert {(i, j) for i, j, _ in again.terms} == {(i, j) for i, j, _ in potential.terms}
    for powers, c in again.coefficients.items():
        assert c == pytest.approx(potential.coefficients[powers], rel=5.001 * 10.0**-digits)


def test_the_rounding_error_of_a_product_is_not_written() -> None:
    potential = CASES["II"].with_parameters(omega_1=1.46, epsilon=0.9)
    assert "1.0657999999999999" in write_formula(potential)
    assert write_formula(potential, 12) == "1.0658x² + y²/2 − 3x³/10 + 9xy²/10"


@pytest.mark.parametrize(("name", "text"), [("I", "x²/2 + y²/2 − xy²"), ("II", "x²/2 + y²/2 − x³/3 + xy²")])
def test_cases_as_text(name: str, text: str) -> None:
    assert write_formula(CASES[name]) == text


def test_default_name_is_the_formula() -> None:
    assert parse_formula("x*x/2").name == "x²/2"


def test_given_name_is_used() -> None:
    assert parse_formula("x²", "mine").name == "mine"
