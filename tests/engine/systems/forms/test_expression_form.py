"""Potentials as expressions have the same results as polynomials, and units and parameters."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Fate, Plane, Potential, classify_orbits, compute_map, parse_formula, review_potential, start_states
from engine.expressions.nodes import from_terms
from engine.maps.spec import MapSpec
from engine.systems.forms.expression_form import ExpressionForm

TEXT = "½r² − a x²y exp(−y²)"


def as_expression(potential: Potential) -> Potential:
    return Potential(potential.name, from_terms(potential.form.coefficients))


def test_a_polynomial_as_an_expression_has_the_same_exits() -> None:
    one, other = CASES["II"], as_expression(CASES["II"])
    assert isinstance(other.form, ExpressionForm)
    np.testing.assert_allclose(other.saddles, one.saddles, atol=1e-13)
    found, expected = review_potential(other), review_potential(one)
    assert found.escape_energy == pytest.approx(expected.escape_energy, rel=1e-13)
    assert (found.mirror_in_x, found.mirror_in_y, found.rotations) == (
        expected.mirror_in_x,
        expected.mirror_in_y,
        expected.rotations,
    )


def test_a_polynomial_as_an_expression_has_the_same_orbits() -> None:
    one, other = CASES["III"], as_expression(CASES["III"])
    chance = np.random.default_rng(4)
    states = start_states(one, Plane.X_PX, 0.4, chance.uniform(-0.5, 0.5, 60), chance.uniform(-0.5, 0.5, 60))
    found, expected = (classify_orbits(each, 0.4, states, 20.0) for each in (other, one))
    early = (expected.fate >= 1) & (expected.escape_time < 15.0)
    assert early.sum() > 15
    np.testing.assert_array_equal(found.fate[early], expected.fate[early])
    np.testing.assert_allclose(found.escape_time[early], expected.escape_time[early], rtol=1e-6)


def test_a_map_has_its_outcomes_and_its_mirror_image() -> None:
    potential = parse_formula(TEXT, parameters={"a": 2.0})
    found = compute_map(MapSpec(potential, Plane.X_PX, potential.well.energy_at(1.3), (24, 24), t_max=60.0))
    assert {1, 2, int(Fate.FORBIDDEN)} <= set(np.unique(found.fate).tolist())
    mirrored = potential.well.mirror_fates[np.maximum(found.fate[::-1, ::-1], 0)]
    np.testing.assert_array_equal(np.where(found.fate > 0, found.fate, 0), np.where(found.fate[::-1, ::-1] > 0, mirrored, 0))


def test_other_units_give_the_same_map() -> None:
    length = 2.0**-8
    potential = parse_formula(TEXT, parameters={"a": 2.0})
    scaled = Potential("", potential.form.scaled(1.0 / length, 1.0 / length**2))
    maps = [
        compute_map(MapSpec(each, Plane.X_PX, each.well.energy_at(1.3), (12, 12), t_max=40.0)).fate
        for each in (potential, scaled)
    ]
    np.testing.assert_array_equal(*maps)


def test_parameters_change_the_quadratic_terms_and_the_rest() -> None:
    form = parse_formula(TEXT, parameters={"a": 2.0})
    changed = form.with_parameters(omega_1=1.5, omega_2=0.5, epsilon=0.3)
    x, y = 0.3, 0.4
    expected = 0.5 * (2.25 * x**2 + 0.25 * y**2) - 0.6 * x**2 * y * np.exp(-(y**2))
    assert changed.value(x, y) == pytest.approx(expected, rel=1e-14)
    assert form.with_parameters().form is form.form


@pytest.mark.parametrize(
    ("text", "n"), [("½r² − 0.2(x⁴ + y⁴)exp(−r²)", 4), ("log(1 + r²)", 0), (TEXT, 1), ("cos(x) + cos(2y)", 2)]
)
def test_formulas_have_their_number_of_rotations(text: str, n: int) -> None:
    assert parse_formula(text).form.count_rotations() == n


def test_a_constant_shifts_the_range_of_energies() -> None:
    plain, shifted = (review_potential(parse_formula(f"½r² − 2x²y exp(−y²){constant}")).energies for constant in ("", " − 1"))
    for name in ("low", "first", "high"):
        assert getattr(shifted, name) + 1.0 == pytest.approx(getattr(plain, name), abs=1e-12)
    assert shifted.decimals == plain.decimals


def test_nested_roots_are_searched_once_each() -> None:
    # With a separate search for each path to an inner root, this would take half a minute instead of a second.
    text = "1+y²"
    for k in range(1, 7):
        text = f"({text}+x^{k})^.5"
    assert review_potential(parse_formula(f"x²+y²+{text}")).refusal is not None


def test_the_flow_of_descents_is_undefined_without_a_warning_where_exponentials_overflow() -> None:
    form = parse_formula("½r² + x²(1 − exp(−x))").form
    assert np.isnan(form.descent_flow(1.0, 1.0)(0.0, np.array([-800.0, 0.1]))[0])
