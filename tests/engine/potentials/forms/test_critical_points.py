from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
import sympy
from hypothesis import assume, example, given
from hypothesis import strategies as st

from engine.polynomials import derivative
from engine.potentials.catalogue import channel_family
from engine.potentials.forms import critical_points
from engine.potentials.forms.critical_points import NotIsolatedError, UndecidedError, find_critical_points, winding_number
from engine.potentials.potential import Potential
from tests.fuzz.test_random_wells import random_well

X, Y = sympy.symbols("x y")
lines = st.tuples(*[st.integers(-5, 5)] * 3).filter(lambda line: line[0] or line[1])


def terms_of(expression: sympy.Expr) -> dict[tuple[int, int], float]:
    return {powers: float(c) for powers, c in sympy.Poly(expression, X, Y).terms() if c}


def sorted_rows(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.round(points.T, 6))]


def intersections(first: list[tuple[int, int, int]], second: list[tuple[int, int, int]]) -> np.ndarray | None:
    """Intersections of lines of two families; None if two lines are nearly parallel or two points are close."""
    points = []
    for (a, b, c), (d, e, f) in product(first, second):
        if abs(a * e - b * d) < 0.3 * np.hypot(a, b) * np.hypot(d, e):
            return None
        points.append(np.linalg.solve([[a, b], [d, e]], [c, f]))
    crowded = any(np.hypot(*(p - q)) < 0.05 for p, q in combinations(points, 2))
    return None if crowded else np.array(points)


@given(st.lists(lines, min_size=1, max_size=3), st.lists(lines, min_size=1, max_size=3))
@example([(-3, 3, -4), (-5, -1, 2)], [(4, -1, 2), (-4, 1, 3), (-5, -5, -4)])  # Newton's method goes to infinity between parallels
def test_products_of_lines_vanish_at_the_intersections(first: list, second: list) -> None:
    expected = intersections(first, second)
    assume(expected is not None)
    p, q = (terms_of(sympy.expand(sympy.prod(a * X + b * Y - c for a, b, c in family))) for family in (first, second))
    np.testing.assert_allclose(sorted_rows(find_critical_points(p, q)), sorted_rows(expected), atol=1e-7)


@pytest.mark.parametrize("seed", range(12))
def test_number_of_critical_points_matches_sympy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    degree = 3 + seed % 2
    value = sum(int(rng.integers(-9, 10)) * X**i * Y**j for i, j in product(range(degree + 1), repeat=2) if 0 < i + j <= degree)
    p, q = sympy.diff(value, X), sympy.diff(value, Y)
    eliminated = sympy.Poly(sympy.resultant(p, q, Y), X)
    # All roots in x are simple, so each real x belongs to one real point, and Sturm's theorem counts them exactly.
    assert sympy.gcd(eliminated, eliminated.diff()).degree() == 0
    assert len(find_critical_points(terms_of(p), terms_of(q))) == eliminated.count_roots()


def test_points_with_equal_x_are_all_found() -> None:
    p, q = terms_of(X * (X - 1)), terms_of(sympy.expand(Y * (Y - 2) * (Y + 2)))
    assert len(find_critical_points(p, q)) == 6


def test_no_real_roots() -> None:
    assert find_critical_points(terms_of(X**2 + 1), terms_of(Y)).shape == (0, 2)


def random_terms(seed: int, degree: int) -> dict[tuple[int, int], float]:
    rng = np.random.default_rng(seed)
    return {(i, j): rng.normal() for i in range(degree + 1) for j in range(degree + 1 - i) if i + j > 0}


def index_sum(terms: dict[tuple[int, int], float], points: np.ndarray) -> int:
    potential = Potential("random", tuple((i, j, c) for (i, j), c in terms.items()))
    vxx, vxy, vyy = potential.hessian(*points.T)
    return int(np.sign(vxx * vyy - vxy**2).sum())


@pytest.mark.parametrize("degree", [3, 5, 8, 12])
@pytest.mark.parametrize("seed", range(3))
def test_sum_of_indices_is_the_winding_number(seed: int, degree: int) -> None:
    # Poincaré–Hopf theorem: it fails if a saddle, minimum or maximum is missing.
    terms = random_terms(seed, degree)
    potential = Potential("random", tuple((i, j, c) for (i, j), c in terms.items()))
    points = find_critical_points(derivative(terms, 0), derivative(terms, 1))
    for radius in (3.0, 300.0):
        assert index_sum(terms, points[np.hypot(*points.T) < radius]) == winding_number(potential.gradient, radius)


@pytest.mark.parametrize("n", [3, 5, 8, 9, 10, 12])
def test_winding_number_of_the_family(n: int) -> None:
    potential = channel_family(n)
    assert winding_number(potential.gradient, 5.0) == 1 - n == 1 - potential.channels


def test_a_turn_within_a_narrow_angle_is_counted() -> None:
    # Far out on the x axis the gradient turns once within 0.001 radians.
    assert winding_number(random_well(34, 10).gradient, 533.0) == -3


def test_turns_too_many_to_be_counted_are_refused() -> None:
    counts = []

    def noise(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        counts.append(x.size)
        return np.sin(1e15 * x), np.cos(1e15 * y)

    with pytest.raises(UndecidedError, match="turns too often"):
        winding_number(noise, 1.0)
    assert max(counts) <= 20_000


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_points_scale_with_the_polynomials(size: float) -> None:
    terms = random_terms(1, 5)
    usual = find_critical_points(derivative(terms, 0), derivative(terms, 1))
    scaled = {(i, j): c * size ** -(i + j) for (i, j), c in terms.items()}
    np.testing.assert_allclose(
        sorted_rows(find_critical_points(derivative(scaled, 0), derivative(scaled, 1)) / size), sorted_rows(usual), rtol=1e-9
    )


@pytest.mark.parametrize("value", [X**2, X**2 * Y**2, (X**2 + Y**2 - 1) ** 2, (X - Y) ** 2 * (X + 1), (X * Y - 1) ** 2])
def test_roots_along_a_curve_are_refused(value: sympy.Expr) -> None:
    expanded = sympy.expand(value)
    with pytest.raises(NotIsolatedError):
        find_critical_points(terms_of(sympy.diff(expanded, X)), terms_of(sympy.diff(expanded, Y)))


def test_degenerate_root_is_found_once() -> None:
    # A monkey saddle: the gradient vanishes to second order.
    points = find_critical_points(terms_of(3 * X**2 - 3 * Y**2), terms_of(-6 * X * Y))
    np.testing.assert_allclose(points, [[0.0, 0.0]], atol=1e-5)


@pytest.mark.parametrize(("seed", "distance"), [(702, 858.47), (495, 1931.91), (681, 7506.90)])
@pytest.mark.parametrize("unit", [1.0, 0.7, 0.018])
def test_a_root_far_from_the_others_is_found_in_any_units(seed: int, distance: float, unit: float) -> None:
    terms = tuple((i, j, c / unit ** (i + j)) for i, j, c in random_well(seed, 10).terms)
    points = Potential("", terms).critical_points
    assert np.hypot(*points.T).max() == pytest.approx(unit * distance, rel=1e-5)


def test_far_places_where_the_terms_do_not_cancel_are_no_roots() -> None:
    # Newton's method stops at such places on its way, where the force is small compared with powers of the distance only.
    points = random_well(156, 10).critical_points
    np.testing.assert_allclose(sorted_rows(points), [[0.0, 0.0], [-0.5784283, 0.8770026]], atol=1e-7)


def test_common_factor_without_real_roots() -> None:
    # V = (r² + 1)²: the gradient vanishes on the complex circle r² = −1 and at the origin.
    factor = X**2 + Y**2 + 1
    points = find_critical_points(terms_of(sympy.expand(4 * X * factor)), terms_of(sympy.expand(4 * Y * factor)))
    np.testing.assert_allclose(points, [[0.0, 0.0]], atol=1e-12)


def test_inaccurate_roots_that_refine_to_one_root_are_returned_once() -> None:
    # V = r²/2 + 1.95 x⁴ y⁶ has no critical point but the origin; Newton's method also ends at points near it.
    value = (X**2 + Y**2) / 2 + 1.95 * X**4 * Y**6
    points = find_critical_points(terms_of(sympy.diff(value, X)), terms_of(sympy.diff(value, Y)))
    np.testing.assert_array_equal(points, [[0.0, 0.0]])


@pytest.mark.parametrize("last", [1.01, 1.0173, 1.3, 2.7])
def test_circles_of_roots_are_refused_before_any_root_is_refined(last: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(critical_points, "_MOST_EXACT_STEPS", 0)
    squared = X**2 + Y**2
    value = sympy.expand(squared / 2 - squared**2 + squared**3 - squared**4 + squared**5 - last * squared**6)
    with pytest.raises(NotIsolatedError):
        find_critical_points(terms_of(sympy.diff(value, X)), terms_of(sympy.diff(value, Y)))


def test_isolated_roots_beside_a_complex_common_curve_are_found() -> None:
    # V = h + 2h³ of the Hénon–Heiles potential h: ∇V = (1 + 6h²) ∇h vanishes at the critical points of h alone.
    h = (X**2 + Y**2) / 2 + X**2 * Y - Y**3 / 3
    value = sympy.expand(h + 2 * h**3)
    points = find_critical_points(terms_of(sympy.diff(value, X)), terms_of(sympy.diff(value, Y)))
    root = 3**0.5 / 2
    expected = np.array([[0.0, 0.0], [0.0, 1.0], [root, -0.5], [-root, -0.5]])
    np.testing.assert_allclose(sorted_rows(points), sorted_rows(expected), atol=1e-9)


def test_the_steps_in_exact_arithmetic_are_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(critical_points, "_MOST_EXACT_STEPS", 100)
    with pytest.raises(UndecidedError, match="cannot be decided"):
        find_critical_points(terms_of(X**11), terms_of(Y**11))
