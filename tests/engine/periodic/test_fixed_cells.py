"""The index of a map finds its fixed points, and no other cells."""

from __future__ import annotations

import numpy as np
import pytest

from engine.periodic.fixed_cells import cells_with_index, zero_in_cell

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


def test_cells_with_missing_displacements_have_no_index() -> None:
    values = displacements(ROTATION)
    values[np.hypot(X - FIXED[0], Y - FIXED[1]) < 0.2] = np.nan
    assert cells_with_index(values).size == 0


def test_the_zero_of_a_linear_map_is_exact() -> None:
    values = displacements(SADDLE)
    ((row, column),) = cells_with_index(values).tolist()
    place = [AXIS[column], AXIS[row]] + zero_in_cell(values, row, column) * (AXIS[1] - AXIS[0])
    np.testing.assert_allclose(place, FIXED, atol=1e-12)
