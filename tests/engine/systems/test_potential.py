"""Potentials have the derivatives, saddles and symmetries of their formulas."""

from __future__ import annotations

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from engine import CASES, Potential
from engine.systems.well_units import WellUnits

X, Y = sympy.symbols("x y")
R = np.sqrt(0.5)
SADDLES = {
    "I": [(0.5, R), (0.5, -R)],
    "II": [(1.0, 0.0), (-0.5, np.sqrt(0.75)), (-0.5, -np.sqrt(0.75))],
    "III": [(R, R), (-R, R), (-R, -R), (R, -R)],
}
ESCAPE_ENERGY = {"I": 1 / 8, "II": 1 / 6, "III": 1 / 4}
PAPER = {"I": -X * Y**2, "II": -X * (X**2 / 3 - Y**2), "III": -(X**2) * Y**2}

coefficients = st.floats(-3.0, 3.0).filter(lambda c: abs(c) > 1e-3)
exponents = st.tuples(st.integers(0, 4), st.integers(0, 4))
polynomials = st.dictionaries(exponents, coefficients, min_size=1, max_size=6)
places = st.floats(-1.5, 1.5)


def potential_of(table: dict[tuple[int, int], float]) -> Potential:
    return Potential("random", tuple((i, j, c) for (i, j), c in table.items()))


def expression_of(potential: Potential) -> sympy.Expr:
    return sympy.Add(*(sympy.Float(c, 30) * X**i * Y**j for i, j, c in potential.terms))


def at(expression: sympy.Expr, x: float, y: float) -> float:
    return float(expression.subs({X: sympy.Float(x, 30), Y: sympy.Float(y, 30)}))


@pytest.mark.parametrize("name", CASES)
def test_cases_match_the_paper(name: str) -> None:
    difference = sympy.nsimplify(expression_of(CASES[name]), rational=True) - (X**2 + Y**2) / 2 - PAPER[name]
    assert sympy.expand(difference) == 0


@given(polynomials, places, places)
def test_value_and_derivatives_agree_with_sympy(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    potential = potential_of(table)
    found = (potential.value(x, y), *potential.gradient(x, y), *potential.hessian(x, y))
    expression = expression_of(potential)
    derivatives = [sympy.diff(expression, *each) for each in ((X,), (Y,), (X, X), (X, Y), (Y, Y))]
    expected = [at(each, x, y) for each in (expression, *derivatives)]
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("name", CASES)
def test_saddles_are_ordered_counterclockwise_and_open_above_the_escape_energy(name: str) -> None:
    potential, escape_energy = CASES[name], ESCAPE_ENERGY[name]
    np.testing.assert_allclose(potential.saddles, SADDLES[name], atol=1e-13)
    assert potential.escape_energy == pytest.approx(escape_energy, rel=1e-14)
    assert potential.well.open_channels(escape_energy + 1e-9) == tuple(range(1, potential.channels + 1))
    assert potential.well.open_channels(escape_energy) == ()


def test_saddles_of_different_energies_open_separately() -> None:
    # V_x = x − x²/2 − x³/2 vanishes at x = 1 and x = −2. Both points are maxima along x and minima along y.
    lopsided = Potential("lopsided", ((2, 0, 0.5), (0, 2, 0.5), (3, 0, -1 / 6), (4, 0, -1 / 8)))
    energies = lopsided.well.saddle_energies
    assert len(set(np.round(energies, 6))) == 2
    assert lopsided.well.open_channels(0.5 * energies.sum()) == (int(np.argmin(energies)) + 1,)


def test_energy_is_kinetic_plus_potential() -> None:
    state = np.array([0.3, -0.2, 0.4, 0.5])
    assert CASES["II"].energy(state) == pytest.approx(0.5 * (0.16 + 0.25) + CASES["II"].value(0.3, -0.2), rel=1e-15)


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.01, 100.0))
def test_case_1_saddles_for_other_parameters(a: float, b: float, epsilon: float) -> None:
    # V_y = (b² − 2 ε x) y and V_x = a² x − ε y² vanish at x = b²/2ε, y = ± a b/(√2 ε); V there is a² b⁴/8ε².
    potential = CASES["I"].with_parameters(a, b, epsilon)
    x, y = b**2 / (2 * epsilon), a * b / (np.sqrt(2) * epsilon)
    np.testing.assert_allclose(potential.saddles, [(x, y), (x, -y)], rtol=1e-9)
    assert potential.escape_energy == pytest.approx(a**2 * b**4 / (8 * epsilon**2), rel=1e-9)


@pytest.mark.parametrize(("length", "energy"), [(0.25, 16.0)])
def test_in_well_units_a_scaled_case_is_unchanged(length: float, energy: float) -> None:
    scaled = Potential("", tuple((i, j, c * energy / length ** (i + j)) for i, j, c in CASES["II"].terms))
    assert scaled.in_well_units == CASES["II"]
    assert scaled.units == WellUnits(length, length / energy**0.5)


@given(polynomials, places, places)
def test_mirror_images_have_exactly_the_same_potential(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    even = potential_of({(2 * i, 2 * j): c for (i, j), c in table.items()})
    points = np.array([x, -x, x, -x]), np.array([y, y, -y, -y])
    assert np.unique(even.value(*points)).size == 1
