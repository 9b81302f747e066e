"""Lines of changing signs lead around a zero set, end at gaps, and their zeros are exact."""

from __future__ import annotations

import numpy as np

from engine.periodic.symmetric.zero_lines import find_zeros, pieces_of_lines, primitive_parts, trace_sign_changes

GRID = np.linspace(-1.0, 1.0, 40)


def circle(places: np.ndarray) -> np.ndarray:
    values: np.ndarray = places[..., 0] ** 2 + places[..., 1] ** 2 - 0.5
    return values


def values_on_grid() -> np.ndarray:
    return circle(np.stack(np.meshgrid(GRID, GRID), axis=-1))


def test_a_circle_is_one_closed_line_of_exact_zeros() -> None:
    edges = trace_sign_changes(values_on_grid())
    assert not edges.line.any()
    assert edges.begins[0].tolist() == edges.begins[-1].tolist()
    places = find_zeros(circle, GRID[edges.begins], GRID[edges.ends])
    np.testing.assert_allclose(circle(places), 0.0, atol=1e-13)
    # Neighbours are in one cell, and the line goes around once.
    assert np.abs(np.diff(places, axis=0)).max() <= (GRID[1] - GRID[0]) * (1.0 + 1e-9)
    turns = np.diff(np.unwrap(np.arctan2(*places.T[::-1])))
    assert abs(turns.sum()) > 2.0 * np.pi - 1e-9


def test_unknown_values_interrupt_a_line() -> None:
    values = values_on_grid()
    values[:, 19] = np.nan
    edges = trace_sign_changes(values)
    assert np.unique(edges.line).tolist() == [0, 1]
    assert not np.isin(19, [edges.begins[:, 0], edges.ends[:, 0]]).any()


def test_at_a_jump_there_is_a_place_but_no_zero() -> None:
    places = find_zeros(lambda places: np.where(places[:, 0] < 0.3, -1.0, 2.0), np.array([[0.0, 0.5]]), np.array([[1.0, 0.5]]))
    np.testing.assert_allclose(places, [[0.3, 0.5]], atol=1e-11)


def test_without_changes_of_sign_there_is_no_line() -> None:
    edges = trace_sign_changes(np.ones((5, 5)))
    assert edges.begins.shape == (0, 2)
    assert find_zeros(circle, edges.begins.astype(float), edges.ends.astype(float)).shape == (0, 2)


def test_pieces_end_with_a_line_and_at_invalid_points() -> None:
    line = np.array([0, 0, 0, 0, 1, 1, 2, 2, 2])
    is_valid = np.array([True, True, False, True, True, True, False, True, True])
    assert [piece.tolist() for piece in pieces_of_lines(line, is_valid)] == [[0, 1], [3], [4, 5], [7, 8]]


def test_primitive_parts_of_powers_are_cyclotomic_polynomials() -> None:
    x = np.array([-2.0, 0.3, 1.7])
    parts = primitive_parts(np.array([x**n - 1.0 for n in range(1, 7)]))
    wanted = [x - 1.0, x + 1.0, x**2 + x + 1.0, x**2 + 1.0, x**4 + x**3 + x**2 + x + 1.0, x**2 - x + 1.0]
    np.testing.assert_allclose(parts, wanted, rtol=1e-13)
