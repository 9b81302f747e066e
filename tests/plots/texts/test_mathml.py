"""MathML formulas are those of the potential when they are parsed back."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np
import pytest
import sympy

from engine import CASES, POTENTIALS, Potential, parse_formula
from plots.texts.mathml import equations, potential_formula

X, Y = sympy.symbols("x y")


def rows(potential: Potential) -> dict[str, list[ElementTree.Element]]:
    """Return the formulas of a potential by label."""
    page = ElementTree.fromstring(equations(potential))
    return {str(name.text): list(row) for name, row in zip(page.iter("dt"), page.iter("dd"), strict=True)}


def read(nodes: list[ElementTree.Element]) -> sympy.Expr:
    """Parse a sum of products."""
    total, factors = sympy.Integer(0), [sympy.Integer(1)]
    for node in nodes:
        if node.tag == "mo":
            total += sympy.Mul(*factors) if len(factors) > 1 else 0
            factors = [sympy.Integer({"+": 1, "−": -1}[str(node.text)])]
        else:
            factors.append(read_factor(node))
    return total + sympy.Mul(*factors)


def read_factor(node: ElementTree.Element) -> sympy.Expr:
    parts = list(node)
    if node.tag == "mfrac":
        return read_factor(parts[0]) / read_factor(parts[1])
    if node.tag == "msup":
        return read_factor(parts[0]) ** read_factor(parts[1])
    if node.tag == "mrow":
        return read(parts)
    factor, _, under_root = str(node.text).partition("√")
    return sympy.sympify(factor or 1, locals={"x": X, "y": Y}, rational=True) * sympy.sqrt(int(under_root or 1))


def after_last_equals(formula: ElementTree.Element) -> sympy.Expr:
    places = [place for place, node in enumerate(formula) if node.text == "="]
    return read(list(formula)[places[-1] + 1 :])


def potential_of(potential: Potential) -> sympy.Expr:
    return sum(sympy.nsimplify(c, rational=True, tolerance=1e-12) * X**i * Y**j for i, j, c in potential.terms)


# A potential with terms that no known potential has: roots, decimals, x y. Its saddles have no exact coordinates.
ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.75), (1, 1, -0.123456), (3, 0, 1.0), (2, 1, -(2.0**0.5)), (0, 4, -0.3)))


@pytest.mark.parametrize("name", ["I", "C5", "HH"])
def test_the_formula_is_that_of_the_potential(name: str) -> None:
    (formula,) = rows(POTENTIALS[name])["Potential"]
    assert sympy.expand(after_last_equals(formula) - potential_of(POTENTIALS[name])) == 0


@pytest.mark.parametrize("case", CASES)
def test_the_escape_energy_and_the_saddles_are_exact(case: str) -> None:
    potential, formulas = CASES[case], rows(CASES[case])
    (escape_energy,) = formulas["Escape energy"]
    V = potential_of(potential)
    assert float(after_last_equals(escape_energy)) == pytest.approx(potential.escape_energy, rel=1e-15)
    saddles = formulas["Saddles (x, y) of the potential"]
    for formula, point in zip(saddles, potential.saddles, strict=True):
        x, y = coordinates(formula)
        np.testing.assert_allclose([float(x), float(y)], point, atol=1e-12)
        assert sympy.simplify(V.subs({X: x, Y: y}) - after_last_equals(escape_energy)) == 0


def coordinates(formula: ElementTree.Element) -> tuple[sympy.Expr, sympy.Expr]:
    nodes = list(formula)
    comma = next(place for place, node in enumerate(nodes) if node.text == ",")
    return read(nodes[2:comma]), read(nodes[comma + 1 : -1])


def test_any_polynomial_has_formulas() -> None:
    formulas = rows(ODD)
    exact = {-(2.0**0.5): -sympy.sqrt(2)}
    V = sum(exact.get(c, sympy.nsimplify(c, rational=True)) * X**i * Y**j for i, j, c in ODD.terms)
    (shown,) = formulas["Potential"]
    assert sympy.expand(after_last_equals(shown) - V) == 0
    for formula, variable in zip(formulas["Equations of motion"], (X, Y), strict=True):
        assert sympy.expand(after_last_equals(formula) + sympy.diff(V, variable)) == 0
    for formula, point in zip(formulas["Saddles (x, y) of the potential"], ODD.saddles, strict=True):
        np.testing.assert_allclose([float(value) for value in coordinates(formula)], point, rtol=1e-3, atol=1e-12)


def test_every_formula_has_text_for_screen_readers() -> None:
    for formula in (formula for row in rows(CASES["I"]).values() for formula in row):
        assert formula.get("display") == "block"
        assert formula.get("aria-label") == formula.get("alttext")
        assert not set("−=∂+<√˙¨") & set(str(formula.get("aria-label")))
    (potential,) = rows(CASES["I"])["Potential"]
    assert str(potential.get("alttext")).endswith("equals 1/2 x squared plus 1/2 y squared minus x y squared")


def test_functions_are_fractions_roots_and_powers() -> None:
    potential = parse_formula("½r² − 2x²y exp(−y²)/√(1 + x²)")
    page = potential_formula(potential)
    words = "x squared y exp ( minus y squared )"
    assert words in page
    assert "square root of ( x squared plus 1 )" in page
    assert "<mfrac>" in page
    assert {"Potential", "Equations of motion"} <= set(rows(potential))


@pytest.mark.parametrize(
    ("coefficient", "written"),
    [
        (1.7e8, "170000000"),
        (123456789.0 / 7.0, "17636684.1429"),
        (7654321.0**0.5, "2766.64435734"),
        (9999.0**0.5, "3√1111"),
    ],
)
def test_large_and_small_numbers_are_decimals(coefficient: float, written: str) -> None:
    formula = potential_formula(Potential("large", ((2, 0, coefficient), (0, 2, 0.5))))
    assert f"<mn>{written}</mn><msup><mi>x</mi>" in formula


@pytest.mark.parametrize(
    ("coefficient", "written"),
    [
        (1e80, "<msup><mn>10</mn><mrow><mn>80</mn></mrow></msup>"),
        (1.5e-300, "<mn>1.5</mn><mo>·</mo><msup><mn>10</mn><mrow><mo>−</mo><mn>300</mn></mrow></msup>"),
    ],
)
def test_very_large_and_very_small_numbers_have_a_power_of_ten(coefficient: float, written: str) -> None:
    formula = potential_formula(Potential("large", ((2, 0, coefficient), (0, 2, 0.5))))
    assert f"{written}<msup><mi>x</mi>" in formula


def test_lines_break_between_terms_which_have_the_space_of_their_signs_only() -> None:
    text = potential_formula(POTENTIALS["C5"])
    parts = text[text.index("<math") : text.rindex("</math>")].split("</math>")
    assert len(parts) == 1 + len(POTENTIALS["C5"].terms)
    assert [part for part in parts[1:] if not part.startswith("<wbr><math ")] == []
