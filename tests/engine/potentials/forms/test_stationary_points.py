"""Critical points of expressions: known ones, those of polynomials, scales, and refusals."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, parse_formula, review_potential
from engine.potentials.forms.common_roots import UndecidedError
from engine.potentials.forms.critical_points import NotIsolatedError
from engine.potentials.forms.stationary_points import MOST_POINTS, find_stationary_points, winding_number
from engine.potentials.potential import Potential


def points_of(potential: Potential) -> np.ndarray:
    points = find_stationary_points(potential.value, potential.gradient, potential.hessian)[:, :2]
    return points[np.lexsort(points.round(9).T)]


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("scale", [2.0**-10, 1.0, 2.0**10])
def test_those_of_a_polynomial_are_found_in_any_unit(name: str, scale: float) -> None:
    scaled = Potential("", CASES[name].form.scaled(1.0 / scale, 1.0))
    expected = scaled.critical_points
    np.testing.assert_allclose(points_of(scaled), expected[np.lexsort(expected.round(9).T)], rtol=1e-10, atol=1e-14 * scale)


def test_saddles_of_the_exponential_well_solve_its_equations() -> None:
    """Where a y exp(−y²) = ½, x² = y exp(y²)/(a (1 − 2y²))."""
    a = 2.0
    saddles = parse_formula("½r² − a x²y exp(−y²)", parameters={"a": a}).saddles
    x, y = saddles[0]
    assert a * y * np.exp(-(y**2)) == pytest.approx(0.5, rel=1e-12)
    assert x**2 == pytest.approx(y * np.exp(y**2) / (a * (1.0 - 2.0 * y**2)), rel=1e-12)
    np.testing.assert_array_equal(saddles[1], [-x, y])


def test_a_circle_of_critical_points_is_refused() -> None:
    potential = parse_formula("r² exp(−r²)")
    with pytest.raises(NotIsolatedError):
        points_of(potential)


def test_a_lattice_is_cut_to_a_region_with_few_points() -> None:
    points = points_of(parse_formula("1 − cos(x) cos(y)"))
    assert 9 <= len(points) <= MOST_POINTS


def test_a_region_in_which_v_is_not_defined_is_refused() -> None:
    with pytest.raises(UndecidedError, match="not defined everywhere within"):
        points_of(parse_formula("½r² − 0.5x³ + 0.001 log(0.64 − x²)"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("r", "not defined at the origin"),
        ("½r² + 1/x", "not defined at the origin"),
        ("log(x² + y²)", "not defined at the origin"),
        ("½r² + x exp(y)", "There is no well at the origin"),
        # A dipole, singular on its axis.
        ("½(1/(x + 1) − (x + 1)/((x + 1)² + y²)^1.5)² + 0.02r²", "not defined everywhere on a circle"),
        ("cos(x) cos(y)", "V has a maximum there"),
        ("exp(x) + exp(−x) + y²", "No saddle leads out"),
        ("−1/√(r² + 1)", "open without a saddle"),
        ("½log(0.04 + r²)", "rises too slowly to be called closed"),
        ("½log(0.04 + r²) + 0.1(x⁴ + y⁴)", "No saddle leads out"),
        ("½(x² + y²) + 1e-8(x⁴ + y⁴)", "No saddle leads out"),
        ("1e4(x² + y²) + 1e4(x⁴ + y⁴)", "No saddle leads out"),
    ],
)
def test_reasons_for_refusal(text: str, reason: str) -> None:
    assert reason in str(review_potential(parse_formula(text)).refusal)


def test_a_formula_with_its_minimum_elsewhere_is_moved() -> None:
    found = review_potential(parse_formula("½(x − 1)² + ½y² − 2(x − 1)²y exp(−y²)"))
    assert found.moved_formula is not None
    assert review_potential(parse_formula(found.moved_formula)).channels == 2


def test_points_on_an_axis_are_on_it_exactly() -> None:
    points = points_of(parse_formula("−1/√(r² + 0.36) − 0.1 x²y exp(−y²) − 0.05 y³"))
    assert np.count_nonzero(points[:, 0] == 0.0) == 2
    assert len(points) == 6


def test_turns_too_many_to_be_counted_are_refused() -> None:
    counts = []

    def noise(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        counts.append(x.size)
        return np.sin(1e15 * x), np.cos(1e15 * y)

    with pytest.raises(UndecidedError, match="turns too often"):
        winding_number(noise, 1.0)
    assert max(counts) <= 20_000
