"""Merging test for Wada basins: whether all basins share one boundary, up to the resolution of the image."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from engine.foundations.result import Chart, RecordedResult
from engine.foundations.wording import format_count
from engine.measures.basins.starts import checked_labels, describe_labels

MIN_BASINS = 3
"""Smallest number of basins for the Wada property; two basins always share their boundary."""

COUNTS_BOUNDED = False
"""Whether bounded orbits are a basin: no, because Wada is a property of the exits (Aguirre, Vallejo & Sanjuán 2001).

The edge of an island of bounded orbits is far from other boundaries between exits, so maps with islands would always fail.
"""

# Percentage of the boundary pixels within `radius_99`.
_PERCENTAGE = 99
# Words for numbers of basins that are too small for the test.
_NUMBER_WORDS = ("none", "one", "two")


@dataclass(frozen=True, eq=False, repr=False)
class WadaTest(RecordedResult):
    """Distances between the boundaries of the basins of an image, in pixels; arrays are read-only.

    Attributes
    ----------
    basins
        The labels of the basins in increasing order.
    radius
        Smallest integer r for which every pixel of every slim boundary, see `compute_wada_test`, is within r pixels of each slim
        boundary. Infinite if a basin touches no other basin; NaN for fewer than three basins or without a boundary. A single
        pixel can decide the radius.
    radius_99
        Smallest integer r for which this holds for 99 % of the boundary pixels.
    boundary_pixels
        Number of pixels on any boundary.
    shares
        (k,) share of these pixels within r = 0, 1, … k − 1 = `radius` pixels of every slim boundary; the last share is 1. Empty
        if `radius` is NaN or infinite.
    """

    basins: tuple[int, ...]
    radius: float
    radius_99: float
    boundary_pixels: int
    shares: np.ndarray = field(repr=False)
    held_as: ClassVar = {"shares": "share"}
    chart: ClassVar = Chart("distance", "share", "r (pixels)", "share of the boundary within r")

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return the share of the boundary pixels within each distance."""
        return {"distance": np.arange(self.shares.size), "share": self.shares}

    @property
    def is_applicable(self) -> bool:
        """Whether there are at least three basins and a boundary between some of them."""
        return not math.isnan(self.radius)

    def describe(self) -> str:
        """Return the result in one sentence."""
        count = len(self.basins)
        if count < MIN_BASINS:
            return f"The Wada test needs three basins; this view has {_NUMBER_WORDS[count]}."
        if not self.is_applicable:
            return f"The Wada test needs basins that touch; none of these {count} do."
        if math.isinf(self.radius):
            return f"Not Wada: of the {count} basins at least one touches no other."
        most_pixels = f"{_PERCENTAGE} % of the {self.boundary_pixels} boundary pixels within {self.radius_99:g}"
        return f"The boundaries of the {count} basins coincide within {format_count(int(self.radius), 'pixel')}, {most_pixels}."


def compute_wada_test(labels: Any, valid: Any = None) -> WadaTest:
    """Measure how far the boundaries of all basins of an image are from being identical.

    For each basin, all other basins are merged into one. The slim boundary of this two-colour image consists of the pixels of
    either colour with a pixel of the other colour above, below, left or right. Basins are Wada, up to the resolution, if each
    slim boundary, dilated by a few pixels, contains all other slim boundaries (Daza, Wagemakers & Sanjuán 2018, Sci. Rep. 8,
    9954). This function does not decide for a given radius, but returns the smallest radius, and the shares of the boundary
    pixels within smaller radii. Dilation uses the chessboard distance: radius r turns a pixel into a square with sides of 2r + 1.

    Parameters
    ----------
    labels
        A complete map or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep; its bounded orbits do not count. Or (rows,
        columns) integers; equal integers are one basin.
    valid
        (rows, columns) bool, the pixels that count. None for the escaping orbits of a map, or for all pixels of an array without
        negative labels. Other pixels and the edge of the image form no boundary; distances are measured straight across such
        pixels.

    Returns
    -------
    The `WadaTest`. No single radius proves the Wada property: at finer resolution the radius of Wada basins stays at a few
    pixels, while the radius of other basins grows in proportion.

    Raises
    ------
    ValueError
        If `labels` or `valid` has a wrong shape or type, or labels are negative without `valid`.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_map, compute_wada_test
    >>> print(compute_wada_test(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (80, 80), t_max=1e3))).describe())
    The boundaries of the 4 basins coincide within 9 pixels, 99 % of the 1756 boundary pixels within 6.
    """
    made_by = describe_labels(labels)
    labels, valid = checked_labels(labels, valid, bounded=COUNTS_BOUNDED)
    basins = tuple(np.unique(labels[valid]).tolist())
    boundary = _slim_boundary(labels, valid)
    count = int(np.count_nonzero(boundary))
    if len(basins) < MIN_BASINS or not count:
        return WadaTest(basins, math.nan, math.nan, count, np.empty(0), made_by=made_by)
    distances = np.sort(_largest_distances(labels, valid, basins, boundary))
    shares = np.cumsum(np.bincount(distances[np.isfinite(distances)].astype(np.intp))) / count
    required_count = math.ceil(_PERCENTAGE * count / 100)
    radius_99 = float(distances[required_count - 1])
    return WadaTest(basins, float(distances[-1]), radius_99, count, shares, made_by=made_by)


def _slim_boundary(colours: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Return the pixels, (rows, columns), that count and have a neighbour that counts and has another colour."""
    slim = np.zeros(colours.shape, np.bool_)
    # Neighbours in a column, and neighbours in a row.
    for first, second in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
        differs = (colours[first] != colours[second]) & valid[first] & valid[second]
        slim[first] |= differs
        slim[second] |= differs
    return slim


def _largest_distances(labels: np.ndarray, valid: np.ndarray, basins: tuple[int, ...], boundary: np.ndarray) -> np.ndarray:
    """Return the distance of each pixel of `boundary` from the furthest slim boundary; infinite if a basin has no boundary."""
    from scipy import ndimage

    distances = np.zeros(np.count_nonzero(boundary))
    for basin in basins:
        slim = _slim_boundary(labels == basin, valid)
        if not slim.any():
            return np.full_like(distances, np.inf)
        np.maximum(distances, ndimage.distance_transform_cdt(~slim, "chessboard")[boundary], out=distances)
    return distances
