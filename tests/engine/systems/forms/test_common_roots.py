"""Common roots of two polynomials are found with their exact number and multiplicity."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
import sympy
from flint import fmpq, fmpq_mpoly
from hypothesis import assume, example, given
from hypothesis import strategies as st

from engine.expressions.exact_polynomials import RING
from engine.systems.forms.common_roots import find_common_roots

X, Y = sympy.symbols("x y")
lines = st.tuples(*[st.integers(-5, 5)] * 3).filter(lambda line: line[0] or line[1])


def polynomial(expression: sympy.Expr) -> fmpq_mpoly:
    return RING.from_dict(
        {powers: fmpq(int(c.p), int(c.q)) for powers, c in sympy.Poly(expression, X, Y, domain="QQ").terms() if c}
    )


def roots_of(first: sympy.Expr, second: sympy.Expr) -> np.ndarray:
    found = find_common_roots(polynomial(first), polynomial(second))
    return np.array(sorted((float(root.x), float(root.y), root.multiplicity) for root in found)).reshape(-1, 3)


def intersections(first: list[tuple[int, int, int]], second: list[tuple[int, int, int]]) -> np.ndarray | None:
    """Return the intersections of lines of two families. None if two lines are parallel or two intersections coincide."""
    points = []
    for (a, b, c), (d, e, f) in product(first, second):
        if a * e == b * d:
            return None
        points.append(np.linalg.solve([[a, b], [d, e]], [c, f]))
    equal = any(np.hypot(*(p - q)) < 1e-9 for p, q in combinations(points, 2))
    return None if equal else np.array(sorted(point.tolist() for point in points))


@given(st.lists(lines, min_size=1, max_size=3), st.lists(lines, min_size=1, max_size=3))
@example([(-3, 3, -4), (-5, -1, 2)], [(4, -1, 2), (-4, 1, 3), (-5, -5, -4)])  # parallels
def test_products_of_lines_vanish_at_the_intersections(first: list, second: list) -> None:
    expected = intersections(first, second)
    assume(expected is not None)
    p, q = (sympy.prod(a * X + b * Y - c for a, b, c in family) for family in (first, second))
    found = roots_of(p, q)
    assert (found[:, 2] == 1).all()
    np.testing.assert_allclose(
        found[np.lexsort(np.round(found[:, 1::-1].T, 9)), :2], expected[np.lexsort(np.round(expected[:, ::-1].T, 9))], atol=1e-13
    )


@pytest.mark.parametrize("seed", range(4))
def test_the_number_of_roots_agrees_with_sturms_theorem(seed: int) -> None:
    rng = np.random.default_rng(seed)
    degree = 3 + seed % 2
    value = sum(int(rng.integers(-9, 10)) * X**i * Y**j for i, j in product(range(degree + 1), repeat=2) if 0 < i + j <= degree)
    p, q = sympy.diff(value, X), sympy.diff(value, Y)
    eliminated = sympy.Poly(sympy.resultant(p, q, Y), X)
    # All roots in x are simple, so each real x belongs to one real point, and Sturm's theorem counts them exactly.
    assert sympy.gcd(eliminated, eliminated.diff()).degree() == 0
    assert len(roots_of(p, q)) == eliminated.count_roots()


def test_complex_roots_are_left_out() -> None:
    assert roots_of(X**2 + 1, Y).shape == (0, 3)
    assert roots_of(X**2 + Y**2, X * Y - 1).shape == (0, 3)


@pytest.mark.parametrize(
    ("p", "q", "expected"),
    [
        (X, Y, [(0, 0, 1)]),
        (Y - X**2, Y, [(0, 0, 2)]),
        (X**3 - Y**2, Y, [(0, 0, 3)]),
        (X**2 - Y**2, X * Y, [(0, 0, 4)]),
        (X**11, Y**11, [(0, 0, 121)]),
        ((X - 1) ** 2 * (X - 3), Y - X, [(1, 1, 2), (3, 3, 1)]),
    ],
)
def test_common_roots_have_their_multiplicities(p: sympy.Expr, q: sympy.Expr, expected: list[tuple[int, int, int]]) -> None:
    np.testing.assert_array_equal(roots_of(p, q), expected)


def test_roots_closer_than_doubles_are_told_apart() -> None:
    near = sympy.Rational(1, 10**40)
    assert len(roots_of(X * (X - near), Y - 3 * X)) == 2
