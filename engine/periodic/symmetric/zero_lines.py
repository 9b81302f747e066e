"""Lines on a grid on which functions change their signs, as chains of the edges between neighbouring points of the grid."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

# Distance from a zero along an edge of the grid, in edges.
_TOLERANCE = 1e-12


class Edges(NamedTuple):
    """Edges of a grid at whose ends a function has different signs, in the order of the lines that cross them.

    Attributes
    ----------
    line
        (n,) number of the line that crosses the edge, from 0. The last edge of a closed line is its first one.
    begins, ends
        (n, 2) column and row of both ends.
    """

    line: np.ndarray
    begins: np.ndarray
    ends: np.ndarray


def trace_sign_changes(values: np.ndarray) -> Edges:
    """Return the edges between points at which values, (rows, columns), have different signs; 0 counts as positive.

    There are no lines where values are NaN. Where two lines cross within a cell of the grid, they are joined in one of two ways.
    """
    import contourpy

    signs = np.ma.masked_array(np.where(values < 0.0, -1.0, 1.0), np.isnan(values))
    # Between signs, all vertices are in the middles of edges. No corner of a cell is cut off.
    lines = [np.asarray(line) for line in contourpy.contour_generator(z=signs, corner_mask=False).lines(0.0)]
    middles = np.concatenate([np.empty((0, 2)), *lines])
    numbers = np.repeat(np.arange(len(lines)), np.array(list(map(len, lines)), int))
    return Edges(numbers, np.floor(middles).astype(int), np.ceil(middles).astype(int))


def pieces_of_lines(line: np.ndarray, is_valid: np.ndarray) -> list[np.ndarray]:
    """Return the indices of neighbouring valid points of a line, for points in the order of their lines, (n,) numbers."""
    valid = np.flatnonzero(is_valid)
    # The pieces of a line have different numbers of invalid points before them.
    piece = np.cumsum(~is_valid)[valid]
    stops = np.flatnonzero(np.diff(line[valid]) | np.diff(piece)) + 1
    return np.split(valid, stops)


def find_zeros(function: Callable[[np.ndarray], np.ndarray], begins: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return places (n, 2) on straight edges at which a function changes its sign: at a zero, or at a jump.

    Parameters
    ----------
    function
        Returns the values at places (m, 2), of shape (m,). If one on an edge is NaN, the place found there can be any, or NaN.
    begins, ends
        (n, 2) ends of the edges, at which the function has different signs.
    """
    # The import is slow and seldom needed.
    from scipy.optimize import elementwise

    def place(share: np.ndarray, *edge: np.ndarray) -> np.ndarray:
        x, y, width, height = edge
        return np.column_stack([x + share * width, y + share * height])

    edges = *begins.T, *(ends - begins).T
    shares = np.zeros(len(begins)), np.ones(len(begins))
    found = elementwise.find_root(
        lambda share, *edge: function(place(share, *edge)), shares, args=edges, tolerances={"xatol": _TOLERANCE}
    )
    return place(found.x, *edges)


def primitive_parts(values: np.ndarray) -> np.ndarray:
    """Divide functions f₁, f₂, … by those of the divisors of their numbers, so that each has its own zeros only.

    Parameters
    ----------
    values
        (numbers, …) values of the functions. fₙ vanishes wherever f_d does, for each divisor d of n.

    Returns
    -------
    The values of g₁, g₂, …, of the same shape, where fₙ is the product of g_d over all divisors d of n, as for xⁿ − 1 and the
    cyclotomic polynomials; NaN at a common zero.
    """
    parts = values.copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        for n in range(2, len(values) + 1):
            for divisor in (d for d in range(1, n) if n % d == 0):
                parts[n - 1] /= parts[divisor - 1]
    return parts
