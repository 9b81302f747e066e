"""Formulas are parsed exactly, written readably, and refused with the position and the reason of the error."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import CASES, parse_formula
from engine.systems.formulas.formula_parser import formula_letters, make_potential
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.formulas.formula_writer import write_formula
from engine.systems.potential import Potential
from tests.peers.random_systems import random_formula

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
        ".5r^2 - (xy)^2",
        "r²/2 − x·x·y×y",
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
        ("--x", ((1, 0, 1.0),)),
        ("(x+y)³", ((3, 0, 1.0), (2, 1, 3.0), (1, 2, 3.0), (0, 3, 1.0))),
        ("y + 1/4", ((0, 0, 0.25), (0, 1, 1.0))),
        ("x^0 y", ((0, 1, 1.0),)),
        # Brackets side by side are not nested.
        ("+".join(["(x)"] * 60), ((1, 0, 60.0),)),
    ],
)
def test_operator_precedence(text: str, terms: tuple[tuple[int, int, float], ...]) -> None:
    assert parse_formula(text).terms == terms


@pytest.mark.parametrize(
    ("text", "position", "reason"),
    [
        ("", 0, "ends"),
        ("x + tan(x)", 4, "not understood; write sin(u)/cos(u) for tan(u)"),
        ("x + sinh(x)", 4, "'sinh' is not understood; write (exp(u) − exp(−u))/2 for sinh(u)"),
        ("2foo(x) + y", 1, "'foo' is not a function; functions are sin, cos, exp, log, ln, sqrt; a product needs * or spaces"),
        ("y + max(x)", 4, "'max' is not a function"),
        ("V(x, y) = y + lg(x)", 14, "'lg' is not a function"),
        ("0,5x + y", 1, "',' is not understood; write decimals with a point, as in 0.5"),
        ("x\\y", 1, "'\\' is not understood; allowed are"),
        ("a x² + y²; a=1.2", 10, "the value of a is no part of the formula: delete it, and set the parameter a"),
        ("1/r + x²; centre (0, 0)", 23, "the radius is missing in 'centre (0, 0)'"),
        ("½r² − x²y cos(3t)", 15, "'t' is not understood"),
        ("x + sin x", 8, "its argument in brackets"),
        ("x + log(1 − 1)", 4, "not a finite real number"),
        ("x2", 1, "directly after"),
        ("x/(y − y)", 1, "must not be 0"),
        ("x//2", 2, "unexpected /"),
        ("(x + y", 0, "not closed"),
        ("x + y)", 5, "unexpected )"),
        ("x^y", 2, "a number from −12 to 12"),
        ("x + a b c d f g h k l", 20, "at most 8"),
        ("x^13", 2, "from −12 to 12"),
        ("9^9^9^9", 3, "power of a power"),
        ("x^7 y^6", 4, "degree 13"),
        ("((9^12)^12)^12 x", 0, "300 digits"),
        ("1e999x", 0, "decimal exponent"),
        ("1e12xy²", 0, "the coefficient of xy² must be between 1e-09 and 1e"),
        ("x - x", 0, "neither x nor y"),
        ("(1 + x + y)^12", 0, "91 terms"),
        ("y" + "".join(f"/(x−{k})" for k in range(1, 41)), 0, "The first derivatives of V have"),
        ("x" + "".join(f"+log((r²−{k})^6)" for k in range(1, 9)), 0, "V has"),
        ("√(x+" * 30 + "y" + ")" * 30, 0, "The first and second derivatives of V have"),
        ("x" + " " * 500, 500, "at most 500"),
        ("(" * 51 + "x" + ")" * 51, 50, "more than 50"),
        ("x\u0000", 1, "not understood"),
    ],
)
def test_errors_have_position_and_reason(text: str, position: int, reason: str) -> None:
    with pytest.raises(FormulaError, match=re.escape(reason)) as caught:
        parse_formula(text)
    assert caught.value.position == position


@given(tables)
def test_written_formula_parses_to_the_same_terms(table: dict[tuple[int, int], float]) -> None:
    potential = potential_of(table)
    assert sorted(parse_formula(write_formula(potential)).terms) == sorted(potential.terms)


@given(tables, st.integers(3, 15))
def test_a_formula_of_few_digits_has_small_relative_errors(table: dict[tuple[int, int], float], digits: int) -> None:
    potential = potential_of(table)
    again = parse_formula(write_formula(potential, digits))
    assert {(i, j) for i, j, _ in again.terms} == {(i, j) for i, j, _ in potential.terms}
    for powers, c in again.form.coefficients.items():
        assert c == pytest.approx(potential.form.coefficients[powers], rel=5.001 * 10.0**-digits)


letter_values = st.dictionaries(
    st.sampled_from(["a", "b", "k1", "α", "Ω"]), st.floats(-1e3, 1e3).filter(lambda value: value == 0.0 or abs(value) > 1e-3)
)


@given(tables, letter_values)
def test_letters_equal_the_numbers_substituted_for_them(table: dict[tuple[int, int], float], values: dict[str, float]) -> None:
    plain = write_formula(potential_of(table))
    text = f"{plain} + x² + y²" + "".join(f" − {name}(x + 2y)² y/3 + {name}² x⁴" for name in values)
    numbers = text
    for name, value in values.items():
        numbers = numbers.replace(name, f"({value!r})")
    try:
        expected = parse_formula(numbers).terms
    except FormulaError:
        with pytest.raises(FormulaError):
            parse_formula(text, parameters=values)
    else:
        assert parse_formula(text, parameters=values).terms == expected


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("x/y", 0.4 / 0.7),
        ("x^-1 y", 0.7 / 0.4),
        ("x^2.5", 0.4**2.5),
        ("x^(a/2 - 1)", 0.4 ** (-0.15)),
        ("r", math.hypot(0.4, 0.7)),
        ("√r", math.hypot(0.4, 0.7) ** 0.5),
        ("2/√(x² + y² + a)", 2.0 / math.sqrt(0.16 + 0.49 + 1.7)),
        ("½x² − a x² y exp(−y²)", 0.08 - 1.7 * 0.16 * 0.7 * math.exp(-0.49)),
        ("ln(1 + x) + log(2y)", math.log(1.4) + math.log(1.4)),
        ("1 − cos(x) cos(a y)", 1.0 - math.cos(0.4) * math.cos(1.19)),
        ("sin(x)²/3 y", math.sin(0.4) ** 2 / 3.0 * 0.7),
    ],
)
def test_formulas_with_functions_have_the_value_of_python(text: str, value: float) -> None:
    parameters = {"a": 1.7} if "a" in text else {}
    assert parse_formula(text, parameters=parameters).value(0.4, 0.7) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "polynomial"),
    [
        ("√2 x²", None),
        ("√(x² + y²)²", "x² + y²"),
        ("x + sin(y) − sin(y)", "x"),
    ],
)
def test_functions_that_cancel_leave_a_polynomial(text: str, polynomial: str | None) -> None:
    terms = parse_formula(text).terms
    assert terms == (((2, 0, math.sqrt(2.0)),) if polynomial is None else parse_formula(polynomial).terms)


@pytest.mark.parametrize("seed", range(6))
def test_written_formulas_with_functions_parse_to_equal_potentials(seed: int) -> None:
    text, values = random_formula(seed)
    potential = parse_formula(text, parameters=values)
    assert parse_formula(write_formula(potential)) == potential


@pytest.mark.parametrize(
    ("text", "written", "function"),
    [
        (
            "½r² + 0.01/(y − x + 0.8)^6",
            "x²/2 + y²/2 + 0.01 (x − y − 4/5)⁻⁶",
            lambda x, y: 0.5 * (x**2 + y**2) + 0.01 / (y - x + 0.8) ** 6,
        ),
        ("½y² + 1/(4x² + 4x + 1)", "y²/2 + 1/4 (x + 1/2)⁻²", lambda x, y: 0.5 * y**2 + 1 / (2 * x + 1) ** 2),
        ("xy + 3/((x + 1)^4 (y − 2)²)", "xy + 3 (x + 1)⁻⁴(y − 2)⁻²", lambda x, y: x * y + 3 / ((x + 1) ** 4 * (y - 2) ** 2)),
        ("xy + 1/(x² + 2)", "xy + (x² + 2)⁻¹", lambda x, y: x * y + 1 / (x**2 + 2)),
    ],
)
def test_a_power_in_the_denominator_is_written_as_a_power(text: str, written: str, function: Callable[..., np.ndarray]) -> None:
    potential, places = parse_formula(text), (np.array([0.3, -0.2]), np.array([0.1, 0.4]))
    assert potential.name == written
    np.testing.assert_allclose(potential.value(*places), function(*places), rtol=1e-13)


@pytest.mark.parametrize(
    ("text", "product"),
    [
        ("x(y + 1)", "x*(y + 1)"),
        ("2(x)", "2*x"),
        ("a(x + y)", "a*(x + y)"),
        ("axy(x + y)", "a*x*y*(x + y)"),
        ("k1k2(x + y)", "k1*k2*(x + y)"),
        ("a b (x + y)", "a*b*(x + y)"),
        ("basin(x)", "b*a*sin(x)"),
    ],
)
def test_letters_before_a_bracket_are_factors(text: str, product: str) -> None:
    letters = {"a": 2.0, "b": 3.0, "k1": 5.0, "k2": 7.0}
    values = {name: letters[name] for name in formula_letters(text)}
    factors, expected = (make_potential(written, parameters=values) for written in (text, product))
    assert factors.value(0.3, 0.7) == expected.value(0.3, 0.7)


@pytest.mark.parametrize("text", ["½(x² + y²) − x²y² + z²", "½r² + pz", "½r² + vz"])
def test_a_third_coordinate_is_no_parameter(text: str) -> None:
    with pytest.raises(FormulaError, match="z' is not understood"):
        parse_formula(text)


def test_all_characters_of_fractions_are_read() -> None:
    fractions = "½⅓⅔¼¾⅕⅖⅗⅘⅙⅚⅐⅛⅜⅝⅞⅑⅒"
    for character in fractions:
        assert parse_formula(f"{character}x² + y²").terms[0] == (2, 0, pytest.approx(unicodedata.numeric(character), rel=1e-15))


@pytest.mark.parametrize(
    ("text", "written"),
    [("x² + 0.0000915y²", "x² + 9.15·10⁻⁵y²"), ("x² + y² + 1e-5 exp(−1e-6x)", "x² + y² + 10⁻⁵ exp(−10⁻⁶x)")],
)
def test_very_small_numbers_are_written_with_a_power_of_ten(text: str, written: str) -> None:
    potential = parse_formula(text)
    assert write_formula(potential) == written
    assert parse_formula(written).form == potential.form
