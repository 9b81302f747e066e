"""The index of a map finds its fixed points, and no other cells."""

from __future__ import annotations

import numpy as np
import pytest

from engine.periodic.fixed_cells import cells_near_zero, cells_with_index, zero_in_cell

AXIS = np.linspace(-1.0, 1.0, 12)
X, Y = np.meshgrid(AXIS, AXIS)
FIXED = np.array([0.23, -0.41])


def displacements(matrix: list[list[float]]) -> np.ndarray:
    """The displacements of a linear map with one fixed point, (12, 12, 2)."""
    return (np.stack([X, Y], axis=-1) - FIXED) @ (np.array(matrix) - np.eye(2)).T


ROTATION, SADDLE, REFLECTION = [[0.6, -0.8], [0.8, 0.6]], [[2.0, 0.3], [0.3, 0.545]], [[-2.0, 0.0], [0.0, -0.5]]


@pytest.mark.parametrize("matrix", [ROTATION, SADDLE, REFLECTION], ids=["stable", "unstable", "with reflection"])
def test_the_cell_of_the_fixed_point_has_an_index(matrix: list[list[float]]) -> None:
    found = cells_with_index(displacements(matrix))
    ((row, column),) = found.tolist()
    assert AXIS[column] < FIXED[0] < AXIS[column + 1]
    assert AXIS[row] < FIXED[1] < AXIS[row + 1]


@pytest.mark.parametrize("matrix", [ROTATION, SADDLE, REFLECTION], ids=["stable", "unstable", "with reflection"])
@pytest.mark.parametrize("error", [(0.0, 0.0), (1e-17, 0.0), (-1e-17, 2e-17), (0.0, -1e-17)])
def test_all_cells_around_a_fixed_point_at_a_corner_are_found(matrix: list[list[float]], error: tuple[float, float]) -> None:
    values = displacements(matrix)
    values += (FIXED - [AXIS[4], AXIS[7]]) @ (np.array(matrix) - np.eye(2)).T
    values[7, 4] = error
    assert cells_with_index(values).tolist() == [[6, 3], [6, 4], [7, 3], [7, 4]]


def test_cells_with_missing_displacements_can_contain_a_fixed_point() -> None:
    values = displacements(ROTATION) + 10.0
    assert cells_near_zero(values).size == 0
    values[3:6, 5] = np.nan
    assert cells_near_zero(values).tolist() == [[row, column] for row in (2, 3, 4, 5) for column in (4, 5)]
    values[:] = np.nan
    assert cells_near_zero(values).size == 0


def test_cells_with_missing_displacements_have_no_index() -> None:
    values = displacements(ROTATION)
    values[np.hypot(X - FIXED[0], Y - FIXED[1]) < 0.2] = np.nan
    assert cells_with_index(values).size == 0


def test_the_zero_of_a_linear_map_is_exact() -> None:
    values = displacements(SADDLE)
    ((row, column),) = cells_with_index(values).tolist()
    place = [AXIS[column], AXIS[row]] + zero_in_cell(values, row, column) * (AXIS[1] - AXIS[0])
    np.testing.assert_allclose(place, FIXED, atol=1e-12)
