"""Critical points of polynomials are exact, complete, independent of units, and refused along curves."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

from engine import Potential, parse_formula, review_potential
from engine.expressions.polynomials import Terms
from engine.systems.forms.critical_points import find_critical_points
from engine.systems.forms.form import NotIsolatedError
from tests.channel_family import channel_family
from tests.peers.random_systems import random_well

X, Y = sympy.symbols("x y")


def terms_of(expression: sympy.Expr) -> dict[tuple[int, int], float]:
    return {powers: float(c) for powers, c in sympy.Poly(sympy.expand(expression), X, Y).terms() if c}


def sorted_rows(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.round(points.T, 6))]


def random_terms(seed: int, degree: int) -> dict[tuple[int, int], float]:
    rng = np.random.default_rng(seed)
    return {(i, j): rng.normal() for i in range(degree + 1) for j in range(degree + 1 - i) if i + j > 0}


def count_turns(potential: Potential, radius: float) -> int:
    """Count the turns of the gradient along a circle about the origin."""
    angle = np.linspace(0.0, 2.0 * np.pi, 200_001)
    along_x, along_y = potential.gradient(radius * np.cos(angle), radius * np.sin(angle))
    direction = np.unwrap(np.arctan2(along_y, along_x))
    return round((direction[-1] - direction[0]) / (2.0 * np.pi))


def as_potential(terms: Terms) -> Potential:
    return Potential("", tuple((i, j, c) for (i, j), c in terms.items()))


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (
            (X**2 + Y**2) / 2 - X**2 * Y**2,
            [(0, 0, 1), *((x, y, -1) for x in (-(0.5**0.5), 0.5**0.5) for y in (-(0.5**0.5), 0.5**0.5))],
        ),
        (X**3 / 3 - X - Y**2 / 2, [(1, 0, -1), (-1, 0, 1)]),
        # A monkey saddle, and flat minima.
        (X**3 - 3 * X * Y**2, [(0, 0, 0)]),
        ((X**2 + Y**2) ** 2, [(0, 0, 0)]),
        ((X**2 + Y**2) / 2 + 1.95 * X**4 * Y**6, [(0, 0, 1)]),
    ],
)
def test_known_points_are_exact_to_the_last_bit(value: sympy.Expr, expected: list[tuple[float, float, int]]) -> None:
    found = find_critical_points(terms_of(value))
    np.testing.assert_array_equal(sorted(found.tolist()), sorted(map(list, expected)))


@pytest.mark.parametrize("degree", [5, 9])
@pytest.mark.parametrize("seed", range(2))
def test_sum_of_indices_is_the_winding_number(seed: int, degree: int) -> None:
    # Poincaré–Hopf theorem: it fails if a saddle, minimum or maximum is missing.
    terms = random_terms(seed, degree)
    points = find_critical_points(terms)
    for radius in (3.0, 300.0):
        inside = points[np.hypot(*points[:, :2].T) < radius]
        assert inside[:, 2].sum() == count_turns(as_potential(terms), radius)


@pytest.mark.parametrize("n", [5, 12])
def test_a_family_with_n_exits_has_a_saddle_for_each(n: int) -> None:
    indices = channel_family(n).well.critical_indices
    assert (np.count_nonzero(indices == -1), indices.sum()) == (n, 1 - n)


@pytest.mark.parametrize("value", [X**2, (X**2 + Y**2 - 1) ** 2, (X * Y - 1) ** 2])
def test_curves_of_points_are_refused(value: sympy.Expr) -> None:
    with pytest.raises(NotIsolatedError):
        find_critical_points(terms_of(value))


def test_a_circle_with_rounding_errors_is_refused() -> None:
    rounded = parse_formula("r²/2 − a r⁴ + b r⁶", parameters={"a": 1.0183, "b": 0.3}).with_parameters(epsilon=0.83)
    assert "degenerate" in str(review_potential(rounded).refusal)


@pytest.mark.parametrize(("seed", "distance", "count", "exits"), [(702, 858.47, 5, 3), (681, 7506.9, 6, 3)])
def test_a_point_far_from_other_points_is_found_in_any_units(seed: int, distance: float, count: int, exits: int) -> None:
    unit = 0.018
    potential = Potential("", tuple((i, j, c / unit ** (i + j)) for i, j, c in random_well(seed, 10).terms))
    assert len(potential.critical_points) == count
    assert np.hypot(*potential.critical_points.T).max() == pytest.approx(unit * distance, rel=1e-5)
    assert (review_potential(potential).refusal, potential.channels) == (None, exits)


def test_points_beside_a_complex_common_curve_are_found() -> None:
    # V = h + 2h³ of the Hénon–Heiles potential h: ∇V = (1 + 6h²) ∇h vanishes at the critical points of h alone.
    h = (X**2 + Y**2) / 2 + X**2 * Y - Y**3 / 3
    points = find_critical_points(terms_of(h + 2 * h**3))
    root = 3**0.5 / 2
    np.testing.assert_allclose(
        sorted_rows(points), sorted_rows(np.array([[0, 0, 1], [0, 1, -1], [root, -0.5, -1], [-root, -0.5, -1]]))
    )
    # V = (r² + 1)²: the gradient vanishes on the complex circle r² = −1 and at the origin.
    np.testing.assert_array_equal(find_critical_points(terms_of((X**2 + Y**2 + 1) ** 2)), [[0, 0, 1]])


def test_a_coefficient_stands_for_the_fraction_that_was_typed() -> None:
    # Only with exact thirds and sevenths this is (x² + y² − 1)² / 21, whose points form a circle.
    with pytest.raises(NotIsolatedError):
        find_critical_points(terms_of((X**2 + Y**2 - 1) ** 2 / 21))


@pytest.mark.parametrize("place", [(1, 0), (-1, 0), (0, 1)])
def test_points_keep_their_kinds_when_the_axes_are_moved_to_another_well(place: tuple[int, int]) -> None:
    # V_xy is the difference of equal terms at the other wells.
    formula = "−½(x² + y²) + ¼(x² + y²)² + 0.3x²y²"
    moved = parse_formula(f"{formula}; well ({place[0]}, {place[1]})")
    assert sorted(moved.well.critical_indices) == sorted(parse_formula(formula).well.critical_indices) == [-1] * 4 + [1] * 5
