"""Find the cells of a grid around which a return map has an index that is not 0, as around its fixed points."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

# Widening of the range of displacements in a cell, as a share of it, beyond those at its corners.
_WIDENING = 0.5
# Share of the largest displacement at the corners of a cell below which another one is a rounding error.
_ROUNDING = 1e-9
# Corrections of the zero of the bilinear interpolation in a cell.
_CORRECTIONS = 4


def cells_near_zero(displacements: np.ndarray) -> np.ndarray:
    """Return the cells in which the displacement can vanish, of shape (n, 2): row and column of the first corner.

    For displacements of shape (…, rows, columns, 2), of several grids, the indices of the grid precede the row.

    A cell is among them if 0 is within the range of the displacements at its corners, widened on both sides, for each coordinate.
    Cells without the displacements of some of their corners are among them as well.
    """
    corners = np.stack(_corners(displacements))
    low, high = corners.min(axis=0), corners.max(axis=0)
    margin = _WIDENING * (high - low)
    # Comparisons with NaN are false.
    is_near = np.all((low - margin <= 0.0) & (high + margin >= 0.0), axis=-1)
    counts = np.isfinite(corners[..., 0]).sum(axis=0)
    is_incomplete = (counts > 0) & (counts < 4)
    return np.argwhere(is_near | is_incomplete)


def cells_with_index(displacements: np.ndarray) -> np.ndarray:
    """Return the cells whose corners have displacements that turn around, as `cells_near_zero` does.

    The index is the number of turns of the displacement on the way around a cell. It is +1 around a fixed point that is stable or
    unstable with reflection, and −1 around another unstable point (Greene 1979, J. Math. Phys. 20, 1183). A cell with two fixed
    points of both kinds has the index 0. Along lines on which the map jumps, cells can have an index without a fixed point.

    Around a fixed point at a corner, as on a line of symmetry, the displacement turns by chance: its cells are always among them.

    Parameters
    ----------
    displacements
        (…, rows, columns, 2) the point after some returns minus the start; NaN for starts without these returns.
    """
    corners = _corners(np.arctan2(displacements[..., 1:], displacements[..., :1]))
    steps = (later[..., 0] - earlier[..., 0] for earlier, later in pairwise([*corners, corners[0]]))
    turns = sum((step + np.pi) % (2.0 * np.pi) - np.pi for step in steps)
    sizes = np.abs(np.stack(_corners(displacements))).max(axis=-1)
    # Comparisons with NaN are false.
    return np.argwhere((np.abs(turns) > np.pi) | (sizes.min(axis=0) < _ROUNDING * sizes.max(axis=0)))


def _corners(values: np.ndarray) -> list[np.ndarray]:
    """Return the values (…, rows, columns, n) at the four corners of each cell, around the cell."""
    return [values[..., :-1, :-1, :], values[..., :-1, 1:, :], values[..., 1:, 1:, :], values[..., 1:, :-1, :]]


def zero_in_cell(displacements: np.ndarray, row: int, column: int) -> np.ndarray:
    """Return where the bilinear interpolation of the displacements in a cell vanishes, (2,) shares of its sides, 0 to 1.

    The order is that of the displacements: the share along the row first. Without a zero in the cell, the place is on its edge.
    """
    corner, right = displacements[row, column], displacements[row, column + 1] - displacements[row, column]
    up = displacements[row + 1, column] - corner
    twist = displacements[row + 1, column + 1] - corner - right - up
    place = np.array([0.5, 0.5])
    for _ in range(_CORRECTIONS):
        s, t = place
        value = corner + right * s + up * t + twist * s * t
        slopes = np.column_stack([right + twist * t, up + twist * s])
        place = np.clip(place - np.linalg.lstsq(slopes, value, rcond=None)[0], 0.0, 1.0)
    return place
