"""Critical points of expressions agree with known points and with polynomials, in any unit, or are refused."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, parse_formula, review_potential
from engine.expressions.nodes import from_terms
from engine.systems.forms.expression_form import ExpressionForm
from engine.systems.forms.form import NotIsolatedError, UndecidedError
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.forms.stationary_points import MOST_POINTS
from engine.systems.potential import Potential


def points_of(potential: Potential) -> np.ndarray:
    """Return the critical points that are found for a potential as an expression. Polynomials are converted."""
    form = potential.form
    expression = ExpressionForm(from_terms(form.coefficients)) if isinstance(form, PolynomialForm) else form
    points = expression.find_critical_points()[:, :2]
    return points[np.lexsort(points.round(9).T)]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("scale", [2.0**-10])
def test_critical_points_of_a_polynomial_are_found_in_any_unit(name: str, scale: float) -> None:
    scaled = Potential("", CASES[name].form.scaled(1.0 / scale, 1.0))
    expected = scaled.critical_points
    np.testing.assert_allclose(points_of(scaled), expected[np.lexsort(expected.round(9).T)], rtol=1e-10, atol=1e-14 * scale)


def test_a_circle_of_critical_points_is_refused() -> None:
    potential = parse_formula("r² exp(−r²)")
    with pytest.raises(NotIsolatedError):
        points_of(potential)


def test_a_lattice_is_cut_to_a_region_with_few_points() -> None:
    points = points_of(parse_formula("1 − cos(x) cos(y)"))
    assert 9 <= len(points) <= MOST_POINTS


@pytest.mark.parametrize("factor", [0.1, 1.0, 8.0])
def test_the_only_point_of_a_sum_of_exponentials_is_found_in_units_in_which_they_are_steep(factor: float) -> None:
    # Far from the origin one exponential is the largest by far, and the Hessian is singular to rounding.
    text = "exp(2k x + k √12 y) + exp(2k x − k √12 y) + exp(−4k x)"
    np.testing.assert_array_equal(points_of(parse_formula(text, parameters={"k": factor})), [[0.0, 0.0]])


def test_a_region_in_which_v_is_not_defined_is_refused() -> None:
    with pytest.raises(UndecidedError, match="not defined everywhere within"):
        points_of(parse_formula("½r² − 0.5x³ + 0.001 log(0.64 − x²)"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("r", "not defined at the origin"),
        ("½r² + x exp(y)", "There is no well at the origin"),
        # A dipole, singular on its axis.
        ("½(1/(x + 1) − (x + 1)/((x + 1)² + y²)^1.5)² + 0.02r²", "is not decided within the limit on the work"),
        ("cos(x) cos(y)", "V has a maximum there"),
    ],
)
def test_refusals_have_reasons(text: str, reason: str) -> None:
    assert reason in str(review_potential(parse_formula(text)).refusal)


@pytest.mark.parametrize("seed", range(4))
def test_points_agree_with_newtons_method_from_many_starts(seed: int) -> None:
    chance = np.random.default_rng(seed)
    bumps = [(*chance.uniform(-2.0, 2.0, 2), chance.uniform(0.5, 3.0), chance.uniform(-1.0, 1.0)) for _ in range(3)]
    text = "½(x² + y²)" + "".join(f"{h:+.3f}exp(−{w:.3f}((x − {a:.3f})² + (y − {b:.3f})²))" for a, b, w, h in bumps)
    potential = parse_formula(text.replace("− -", "+ "))
    found = potential.critical_points
    points = chance.uniform(-3.0, 3.0, (4000, 2))
    for _ in range(60):
        (gx, gy), (vxx, vxy, vyy) = potential.gradient(*points.T), potential.hessian(*points.T)
        points = points - np.column_stack([vyy * gx - vxy * gy, vxx * gy - vxy * gx]) / (vxx * vyy - vxy**2)[:, None]
        points = points[np.isfinite(points).all(axis=1) & (np.hypot(*points.T) < 10.0)]
    at_rest = points[np.hypot(*potential.gradient(*points.T)) < 1e-13]
    distances = np.hypot(*np.moveaxis(at_rest[:, None] - found, -1, 0))
    assert distances.min(axis=1).max() < 1e-9
    np.testing.assert_allclose(potential.gradient(*found.T), 0.0, atol=1e-13)


@pytest.mark.parametrize(
    ("text", "points", "minima"),
    [
        # Softened bodies, and bumps. Divisors are small, but nowhere 0.
        ("½(x² + y²) − x²y² + 0.001/((x² − 0.5)² + (y² − 0.5)² + 1e-3)", 13, 1),
        ("½(x² + y²) − 1/√((x − 0.5)² + y² + 0.02²) − 1/√((x + 0.5)² + y² + 0.02²)", 3, 2),
        # A minimum so narrow that no start of Newton's method finds it, and a saddle beside it.
        ("x + 3y − exp(−400((x − 2)² + (y − 1)²))", 2, 1),
    ],
)
def test_points_in_narrow_places_are_found(text: str, points: int, minima: int) -> None:
    kinds = [point.kind.value for point in review_potential(parse_formula(text)).critical_points]
    assert (len(kinds), kinds.count("minimum")) == (points, minima)


@pytest.mark.parametrize(
    "text",
    [
        "½(x² + y²) − x²y² + 0.01√((x² + y² − 1)² + 1e-4)",
        "½(x² + y²) − x²y² + 1e-4exp(−2.5e7(x² + y² − 0.0025)²)",
    ],
)
def test_unproved_critical_points_are_refused(text: str) -> None:
    assert "is not decided within the limit on the work" in str(review_potential(parse_formula(text)).refusal)
