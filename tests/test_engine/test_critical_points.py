from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
import sympy
from hypothesis import assume, given
from hypothesis import strategies as st

from engine.critical_points import find_critical_points

X, Y = sympy.symbols("x y")
lines = st.tuples(*[st.integers(-5, 5)] * 3).filter(lambda line: line[0] or line[1])


def terms_of(expression: sympy.Expr) -> dict[tuple[int, int], float]:
    return {powers: float(c) for powers, c in sympy.Poly(expression, X, Y).terms() if c}


def sorted_rows(points: np.ndarray) -> np.ndarray:
    return points[np.lexsort(np.round(points.T, 6))]


def intersections(first: list[tuple[int, int, int]], second: list[tuple[int, int, int]]) -> np.ndarray | None:
    """Points where a line of one family meets one of the other; None when a pair is nearly parallel or points are close."""
    points = []
    for (a, b, c), (d, e, f) in product(first, second):
        if abs(a * e - b * d) < 0.3 * np.hypot(a, b) * np.hypot(d, e):
            return None
        points.append(np.linalg.solve([[a, b], [d, e]], [c, f]))
    crowded = any(np.hypot(*(p - q)) < 0.05 for p, q in combinations(points, 2))
    return None if crowded else np.array(points)


@given(st.lists(lines, min_size=1, max_size=3), st.lists(lines, min_size=1, max_size=3))
def test_products_of_lines_meet_exactly_where_the_lines_do(first: list, second: list) -> None:
    expected = intersections(first, second)
    assume(expected is not None)
    p, q = (terms_of(sympy.expand(sympy.prod(a * X + b * Y - c for a, b, c in family))) for family in (first, second))
    np.testing.assert_allclose(sorted_rows(find_critical_points(p, q)), sorted_rows(expected), atol=1e-7)


@pytest.mark.parametrize("seed", range(12))
def test_as_many_critical_points_as_sympy_counts(seed: int) -> None:
    rng = np.random.default_rng(seed)
    degree = 3 + seed % 2
    value = sum(int(rng.integers(-9, 10)) * X**i * Y**j for i, j in product(range(degree + 1), repeat=2) if 0 < i + j <= degree)
    p, q = sympy.diff(value, X), sympy.diff(value, Y)
    eliminated = sympy.Poly(sympy.resultant(p, q, Y), X)
    # Simple roots in x: then each real x belongs to one real point, and Sturm's theorem counts them exactly.
    assert sympy.gcd(eliminated, eliminated.diff()).degree() == 0
    assert len(find_critical_points(terms_of(p), terms_of(q))) == eliminated.count_roots()


def test_points_that_share_an_x_are_all_found() -> None:
    p, q = terms_of(X * (X - 1)), terms_of(sympy.expand(Y * (Y - 2) * (Y + 2)))
    assert len(find_critical_points(p, q)) == 6


def test_a_system_without_real_roots_has_none() -> None:
    assert find_critical_points(terms_of(X**2 + 1), terms_of(Y)).shape == (0, 2)
