"""The merging test for Wada basins: whether all basins have one and the same boundary, as far as the pixels can tell."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy import ndimage

from engine.arrays import read_only
from engine.basins.labels import checked_labels

FEWEST_BASINS = 3
"""Wada is said of three or more basins; two always share their boundary."""

# In per cent of the boundary pixels: what `radius_99` holds.
_NEARLY_ALL = 99


@dataclass(frozen=True, eq=False)
class WadaTest:
    """How far apart the boundaries of the basins of a picture lie; distances in pixels, arrays read-only.

    Attributes
    ----------
    basins
        The labels tested, in rising order.
    radius
        The least r for which every slim boundary lies within r pixels of every other: a whole number; infinity when a basin
        touches no other, NaN for fewer than three basins or no boundary at all. One stray pixel decides it.
    radius_99
        The least r that does so for 99 % of the boundary pixels.
    boundary_pixels
        How many pixels lie on any boundary.
    shares
        (k,) share of these that lie within r = 0, 1, … k − 1 = `radius` pixels of every slim boundary; the last one is 1.
        Empty where `radius` is NaN or infinite.
    """

    basins: tuple[int, ...]
    radius: float
    radius_99: float
    boundary_pixels: int
    shares: np.ndarray = field(repr=False)

    @property
    def is_question(self) -> bool:
        """Whether there are three basins or more, and a boundary between them."""
        return not math.isnan(self.radius)

    def describe(self) -> str:
        """The result in a sentence."""
        number = len(self.basins)
        if number < FEWEST_BASINS:
            return f"Wada is no question: of the {FEWEST_BASINS} basins that it takes the picture holds {number}."
        if not self.is_question:
            return f"Wada is no question: no two of the {number} basins touch."
        if math.isinf(self.radius):
            return f"Not Wada: of the {number} basins at least one touches no other."
        nearly_all = f"{_NEARLY_ALL} % of the {self.boundary_pixels} on them within {self.radius_99:g}"
        return f"The boundaries of the {number} basins coincide within {self.radius:g} pixels, {nearly_all}."


def compute_wada_test(labels: Any, valid: Any = None) -> WadaTest:
    """How far the boundaries of all basins of a picture are from being one.

    For each basin all others are merged into one. The slim boundary of that picture of two colours are the pixels, of either
    colour, with one of the other colour above, below, left or right. The basins are Wada, up to the resolution, when slim
    boundaries fattened by few pixels hold one another (Daza, Wagemakers & Sanjuán 2018, Sci. Rep. 8, 9954). Instead of a yes or
    no for a given radius we return the least radius, and count shares of boundary pixels, not of the picture. We fatten by
    chessboard distance: by r it turns a pixel into a square of 2r + 1.

    Parameters
    ----------
    labels
        (rows, columns) of any integers; equal ones are one basin. For a map: `exit_labels`.
    valid
        (rows, columns) bool, the pixels that count; None for all. The others have no boundary with their neighbours, nor has
        the edge of the picture; distances are measured straight across them.

    Returns
    -------
    The `WadaTest`. No radius makes basins Wada by itself: when the picture is made finer, that of Wada basins stays a few
    pixels, that of others grows in proportion.

    Raises
    ------
    ValueError
        When labels or valid have a wrong shape or type.
    """
    labels, valid = checked_labels(labels, valid)
    basins = tuple(np.unique(labels[valid]).tolist())
    anywhere = _slim_boundary(labels, valid)
    count = int(np.count_nonzero(anywhere))
    if len(basins) < FEWEST_BASINS or not count:
        return WadaTest(basins, math.nan, math.nan, count, read_only(np.empty(0)))
    reach = np.sort(_furthest_boundary(labels, valid, basins, anywhere))
    shares = np.cumsum(np.bincount(reach[np.isfinite(reach)].astype(np.intp))) / count
    radius_99 = float(reach[-(-_NEARLY_ALL * count // 100) - 1])
    return WadaTest(basins, float(reach[-1]), radius_99, count, read_only(shares))


def _slim_boundary(colours: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """bool: the pixels that count next to one that counts, too, and has another colour."""
    slim = np.zeros(colours.shape, np.bool_)
    for before, after in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        differs = (colours[before] != colours[after]) & valid[before] & valid[after]
        slim[before] |= differs
        slim[after] |= differs
    return slim


def _furthest_boundary(labels: np.ndarray, valid: np.ndarray, basins: tuple[int, ...], where: np.ndarray) -> np.ndarray:
    """For each pixel of `where` its distance from that slim boundary which is furthest away; infinity where one is missing."""
    reach = np.zeros(np.count_nonzero(where))
    for basin in basins:
        slim = _slim_boundary(labels == basin, valid)
        if not slim.any():
            return np.full_like(reach, np.inf)
        np.maximum(reach, ndimage.distance_transform_cdt(~slim, "chessboard")[where], out=reach)
    return reach
