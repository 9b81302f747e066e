from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from engine import CASES, Potential
from engine.potentials.well_units import WellUnits

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
def test_value_agrees_with_sympy(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    potential = potential_of(table)
    assert potential.value(x, y) == pytest.approx(at(expression_of(potential), x, y), rel=1e-12, abs=1e-12)


@given(polynomials, places, places)
def test_gradient_agrees_with_sympy(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    potential = potential_of(table)
    expected = [at(sympy.diff(expression_of(potential), v), x, y) for v in (X, Y)]
    assert potential.gradient(x, y) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@given(polynomials, places, places)
def test_hessian_agrees_with_sympy(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    potential = potential_of(table)
    expected = [at(sympy.diff(expression_of(potential), *v), x, y) for v in ((X, X), (X, Y), (Y, Y))]
    assert potential.hessian(x, y) == pytest.approx(expected, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("name", CASES)
def test_arrays_agree_with_single_points(name: str) -> None:
    x, y = np.random.default_rng(0).uniform(-1, 1, (2, 3, 4))
    singly = [CASES[name].value(a, b) for a, b in zip(x.ravel(), y.ravel(), strict=True)]
    np.testing.assert_array_equal(CASES[name].value(x, y).ravel(), singly)


@pytest.mark.parametrize("name", CASES)
def test_saddles_are_ordered_counterclockwise_from_the_x_axis(name: str) -> None:
    np.testing.assert_allclose(CASES[name].saddles, SADDLES[name], atol=1e-13)


@pytest.mark.parametrize("name", CASES)
def test_escape_energy_matches_the_paper(name: str) -> None:
    assert CASES[name].escape_energy == pytest.approx(ESCAPE_ENERGY[name], rel=1e-14)


@pytest.mark.parametrize("name", CASES)
def test_all_channels_are_open_above_the_escape_energy(name: str) -> None:
    potential = CASES[name]
    assert potential.well.open_channels(ESCAPE_ENERGY[name] + 1e-9) == tuple(range(1, potential.channels + 1))


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("below", [0.0, 1e-9, 0.05])
def test_no_channel_is_open_at_or_below_the_escape_energy(name: str, below: float) -> None:
    assert CASES[name].well.open_channels(ESCAPE_ENERGY[name] - below) == ()


def test_saddles_of_different_energies_open_separately() -> None:
    # V_x = x − x²/2 − x³/2 vanishes at x = 1 and x = −2, each a maximum along x and a minimum along y.
    lopsided = Potential("lopsided", ((2, 0, 0.5), (0, 2, 0.5), (3, 0, -1 / 6), (4, 0, -1 / 8)))
    energies = lopsided.well.saddle_energies
    assert len(set(np.round(energies, 6))) == 2
    assert lopsided.well.open_channels(0.5 * energies.sum()) == (int(np.argmin(energies)) + 1,)


def test_escape_energy_without_saddles_is_infinite() -> None:
    assert Potential("harmonic", ((2, 0, 0.5), (0, 2, 0.5))).escape_energy == np.inf


def test_energy_is_kinetic_plus_potential() -> None:
    state = np.array([0.3, -0.2, 0.4, 0.5])
    assert CASES["II"].energy(state) == pytest.approx(0.5 * (0.16 + 0.25) + CASES["II"].value(0.3, -0.2), rel=1e-15)


def test_equality_ignores_the_name() -> None:
    assert Potential("another name", CASES["I"].terms) == CASES["I"]


@pytest.mark.parametrize("terms", [((2, 0, 1.0), (2, 0, 2.0)), ((-1, 0, 1.0),), ((1, 0, np.nan),), ((1, 0, np.inf),)])
def test_malformed_terms_are_refused(terms: tuple[tuple[int, int, float], ...]) -> None:
    with pytest.raises(ValueError, match="terms"):
        Potential("malformed", terms)


def test_saddle_not_connected_to_the_well_is_no_channel() -> None:
    # On the x axis the well ends at the saddle x = 0.434; the saddle at x = 1.441 lies beyond it and does not lead into the well.
    beyond = Potential("beyond", ((2, 0, 0.5), (0, 2, 0.5), (3, 0, -1.0), (4, 0, 0.4), (2, 2, -1.0)))
    assert len(beyond.critical_points) == 5
    assert beyond.channels == 3


def test_no_channels_without_a_well_at_the_origin() -> None:
    assert Potential("saddle", ((2, 0, 0.5), (0, 2, -0.5))).channels == 0


@pytest.mark.parametrize("name", CASES)
def test_default_parameters_change_nothing(name: str) -> None:
    same = CASES[name].with_parameters()
    assert (same, same.name) == (CASES[name], name)


def test_parameters_match_the_paper() -> None:
    changed = CASES["II"].with_parameters(omega_1=1.2, omega_2=0.9, epsilon=0.8)
    expression = (sympy.Float(1.44, 30) * X**2 + sympy.Float(0.81, 30) * Y**2) / 2 + sympy.Rational(4, 5) * PAPER["II"]
    assert changed.value(0.3, -0.4) == pytest.approx(at(expression, 0.3, -0.4), rel=1e-14)


def test_name_includes_parameters_other_than_one() -> None:
    assert CASES["I"].with_parameters(omega_1=1.2, epsilon=0.8).name == "I (ω1=1.2, ε=0.8)"


@given(st.floats(0.1, 10.0), st.floats(0.1, 10.0), st.floats(0.01, 100.0))
def test_case_1_saddles_for_other_parameters(a: float, b: float, epsilon: float) -> None:
    # V_y = (b² − 2 ε x) y and V_x = a² x − ε y² vanish at x = b²/2ε, y = ± a b/(√2 ε); V there is a² b⁴/8ε².
    potential = CASES["I"].with_parameters(a, b, epsilon)
    x, y = b**2 / (2 * epsilon), a * b / (np.sqrt(2) * epsilon)
    np.testing.assert_allclose(potential.saddles, [(x, y), (x, -y)], rtol=1e-9)
    assert potential.escape_energy == pytest.approx(a**2 * b**4 / (8 * epsilon**2), rel=1e-9)


@pytest.mark.parametrize(
    ("parameter", "value"),
    [("omega_1", 0.0), ("omega_1", -1.0), ("omega_2", 11.0), ("epsilon", 0.0), ("epsilon", np.nan), ("epsilon", np.inf)],
)
def test_parameters_out_of_range_are_refused(parameter: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"{parameter}={value}"):
        CASES["I"].with_parameters(**{parameter: value})


def test_a_parameter_that_is_no_number_is_named() -> None:
    strengths: Any = np.array([0.1, 0.2])
    with pytest.raises(ValueError, match="epsilon"):
        CASES["I"].with_parameters(epsilon=strengths)


@pytest.mark.parametrize("name", CASES)
def test_the_cases_are_given_in_units_of_the_well(name: str) -> None:
    assert CASES[name].units == WellUnits()
    assert CASES[name].in_well_units is CASES[name]


@pytest.mark.parametrize(("epsilon", "length"), [(1 / 64, 64.0), (1.0, 1.0), (64.0, 1 / 64)])
def test_length_of_a_cubic_well_depends_on_its_strength(epsilon: float, length: float) -> None:
    assert CASES["II"].with_parameters(epsilon=epsilon).units == WellUnits(length, 1.0)


def test_unit_of_time_is_that_of_the_fastest_small_oscillation() -> None:
    assert CASES["III"].with_parameters(omega_1=4.0, omega_2=1.0).units.time == 0.25


@pytest.mark.parametrize(("length", "energy"), [(64.0, 4096.0), (0.25, 16.0), (1.0, 0.0625)])
def test_in_well_units_a_scaled_case_is_unchanged(length: float, energy: float) -> None:
    scaled = Potential("", tuple((i, j, c * energy / length ** (i + j)) for i, j, c in CASES["II"].terms))
    assert scaled.in_well_units == CASES["II"]
    assert scaled.units == WellUnits(length, length / energy**0.5)


@given(polynomials, places, places)
def test_mirror_images_have_exactly_the_same_potential(table: dict[tuple[int, int], float], x: float, y: float) -> None:
    even = potential_of({(2 * i, 2 * j): c for (i, j), c in table.items()})
    points = np.array([x, -x, x, -x]), np.array([y, y, -y, -y])
    assert np.unique(even.value(*points)).size == 1
