"""Crossings of y = 0 and of exits are found within a step whose series are known polynomials."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from engine import CASES, find_lyapunov_orbits, read_section
from engine.integrator.kernels.events import append_crossings, count_crossings, crossed_exit, find_exit_time
from engine.integrator.kernels.exit_geometry import CURVE_COLUMNS, HALF_WIDTH, ORIGIN_X, OUTWARD_X, REACH, exit_distance
from engine.integrator.kernels.sections import UPWARD
from engine.integrator.source.series import ORDER

X = Polynomial([0.3, -0.7, 0.2])
# The section y = 0 by direction: upward, downward, and both.
SECTIONS = {
    1: UPWARD,
    -1: np.array(read_section("y = 0 down").numbers.rows),
    0: np.array(read_section("y = 0 both").numbers.rows),
}


def jet_of(polynomial: Polynomial) -> np.ndarray:
    jet = np.zeros((ORDER + 1, 1))
    jet[: polynomial.coef.size, 0] = polynomial.coef
    return jet


def crossings(polynomial: Polynomial, duration: float = 1.0) -> int:
    jet = jet_of(polynomial)
    return int(count_crossings(jet_of(X), jet, 0, duration, UPWARD, jet))


def points_of(y: Polynomial, direction: int) -> np.ndarray:
    """Return x, px and time of the crossings of a step, of shape (n, 3). The step begins at t = 5, and its x is `X`."""
    points, found = np.full((2, 8, 3), np.nan), np.zeros(2, np.int64)
    append_crossings(jet_of(X), jet_of(y), 0, 5.0, 1.0, SECTIONS[direction], jet_of(X), points, found, 1)
    assert found[0] == 0
    return points[1, : found[1]]


def with_roots(*roots: float) -> Polynomial:
    return Polynomial.fromroots(roots)


def random_series(seed: int, direction: int) -> tuple[Polynomial, np.ndarray]:
    """Return a polynomial, and its roots in (0, 1) whose slope has the sign of `direction`."""
    polynomial = Polynomial(np.random.default_rng(seed).normal(size=7) * [0.3, 1, 2, 2, 1, 1, 1])
    roots = polynomial.roots()
    real = np.sort(roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)])
    return polynomial, real[direction * polynomial.deriv()(real) > 0]


@pytest.mark.parametrize(
    ("roots", "sign", "expected"),
    [
        ((0.37,), +1, 1),
        ((0.37,), -1, 0),
        ((0.2, 0.8), +1, 1),  # above, below, above
        ((0.2, 0.8), -1, 1),  # below, above, below
        ((0.2, 0.5, 0.8), +1, 2),
        ((-0.3, 1.2), +1, 0),
        # Starts on 0, upward and downward.
        ((0.0,), +1, 0),
        ((0.0, 0.4, 0.7), +1, 1),
        ((0.0, 1e-4), +1, 1),
        # Ends on 0, from below and from above.
        ((1.0,), +1, 1),
        ((1.0,), -1, 0),
        # Touches 0, exactly in floating point. From below, y becomes ≥ 0, which is a crossing. From above, y is never negative.
        ((0.25, 0.25), +1, 0),
        ((0.25, 0.25), -1, 1),
    ],
)
def test_crossings_are_the_roots_with_positive_slope(roots: tuple[float, ...], sign: int, expected: int) -> None:
    assert crossings(sign * with_roots(*roots)) == expected


@pytest.mark.parametrize("apart", [1e-2, 1e-6])
@pytest.mark.parametrize("where", [0.13, 0.6180339])
@pytest.mark.parametrize("sign", [-1, 1])
def test_two_roots_in_one_part_of_a_step_are_one_crossing_in_each_direction(apart: float, where: float, sign: int) -> None:
    roots = where, where + apart
    y = sign * with_roots(*roots)
    assert crossings(y) == 1
    upward, downward = (points_of(y, direction)[:, 2] - 5.0 for direction in (+1, -1))
    # The error of a root is the error of y, of order 1e-16, divided by the slope at the root.
    np.testing.assert_allclose([downward, upward][::sign], np.reshape(roots, (2, 1)), atol=1e-15 / apart)


@pytest.mark.parametrize("gap", [1e-3, 1e-12])
@pytest.mark.parametrize("where", [0.3])
@pytest.mark.parametrize("sign", [-1, 1])
def test_an_extremum_just_before_zero_is_no_crossing(gap: float, where: float, sign: int) -> None:
    assert crossings(sign * (with_roots(where, where) + gap)) == 0


def test_start_on_zero_after_a_step_that_ended_there_is_not_counted_twice() -> None:
    whole = with_roots(0.5)
    assert crossings(whole, 0.5) + crossings(whole(Polynomial([0.5, 1.0]))) == 1


def test_only_crossings_within_the_duration_are_counted() -> None:
    assert [crossings(with_roots(0.2, 0.5, 0.8), duration) for duration in (0.1, 0.4, 0.7, 0.9)] == [0, 1, 1, 2]


@pytest.mark.parametrize("direction", [+1, -1])
@pytest.mark.parametrize("seed", range(10))
def test_crossings_of_random_series_are_their_roots_with_the_slope_of_the_direction(seed: int, direction: int) -> None:
    y, roots = random_series(seed, direction)
    assert crossings(direction * y) == roots.size
    np.testing.assert_allclose(points_of(y, direction), np.column_stack([X(roots), X.deriv()(roots), 5.0 + roots]), atol=1e-12)


# Exits.


def orbit_through(x: float, y: float, px: float, py: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the series of an orbit with constant velocity."""
    return jet_of(Polynomial([x, px])), jet_of(Polynomial([y, py]))


def test_curves_continue_straight_beyond_both_ends_of_a_lyapunov_orbit() -> None:
    for orbit in find_lyapunov_orbits(CASES["II"], 0.5):
        path = np.array([orbit.x, orbit.y])[:, : orbit.x.size // 2 + 1]
        for end, before in ((0, 1), (-1, -2)):
            # The path is densest at its ends, so its last piece has almost the direction of its tangent.
            tangent = path[:, end] - path[:, before]
            tangent /= np.hypot(*tangent)
            near, far = (exit_distance(*(path[:, end] + length * tangent), orbit.curve) for length in (1e-3, 1e-1))
            assert abs(far) < 1e-3
            assert far == pytest.approx(100.0 * near, abs=1e-6)


def test_exit_time_of_a_straight_line_is_that_of_its_intersection_with_the_lyapunov_orbit() -> None:
    for orbit in find_lyapunov_orbits(CASES["II"], 0.4):
        end = np.array([orbit.x[30], orbit.y[30]])
        tau = find_exit_time(*orbit_through(0.0, 0.0, *end), 0, 1.2, orbit.curve)
        assert tau == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(("across", "channel"), [((0.0, 3.0), 1), ((3.0, 0.0), 0), ((0.0, 0.5), 1), ((1.2, 3.0), 0)])
def test_the_place_where_a_step_crosses_an_exit_decides(across: tuple[float, float], channel: int) -> None:
    # A straight exit x = 1, |y| ≤ 1, with a reach of 1.
    curve = np.zeros((1, CURVE_COLUMNS))
    curve[0, [ORIGIN_X, OUTWARD_X, HALF_WIDTH, REACH]] = 1.0
    gates = np.array([[1.0, 0.0, 0.5]])
    # A tenth of the step lies inside.
    assert crossed_exit(0.9, across[0], 1.9, across[1], curve, gates) == channel
