"""Islands: connected parts of the bounded starts of a map. Their areas have an error due to the resolution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.foundations.result import RecordedResult
from engine.foundations.wording import format_count
from engine.measures.basins.starts import Measurable, Starts, read_complete_starts
from engine.propagation.fates import Fate

MIN_ISLAND_PIXELS = 4
"""Smallest number of pixels of an island; smaller connected parts of the bounded starts do not count."""

# Variance of the number of points of a square lattice in a region with a smooth edge, divided by the length of the edge.
_VARIANCE_PER_LENGTH = 0.0724


@dataclass(frozen=True)
class Islands(RecordedResult):
    """Areas of the bounded starts of a map, in units of its axes.

    Attributes
    ----------
    area, area_error
        Area of all bounded starts, and its error.
    count
        Number of connected parts of at least four pixels; pixels that share a corner are connected.
    largest, largest_error
        Area of the largest of these parts, and its error; 0 if there is no such part.
    """

    area: float
    area_error: float
    count: int
    largest: float
    largest_error: float

    def describe(self) -> str:
        """Return the areas in a sentence."""
        if not self.area:
            return "No start is bounded."
        area = f"The bounded starts have the area {self.area:.4g} ± {self.area_error:.1g}"
        if not self.count:
            return f"{area}, in no part of four pixels or more."
        islands = format_count(self.count, "island")
        return f"{area}, in {islands}; the largest has {self.largest:.4g} ± {self.largest_error:.1g}."


def compute_islands(starts: Measurable | Starts) -> Islands:
    """Count the islands of a map and compute their areas.

    An area is the number of pixels times the area of a pixel. Its error is due to the resolution alone: the number of points of a
    square lattice in a region with a smooth edge of length L, in units of the spacing, has the variance 0.0724 L if the lattice
    lies at random (Matérn 1989, J. Microsc. 153, 269; Gundersen & Jensen 1987, J. Microsc. 147, 229). L is π/4 times the number
    of pairs of neighbours of which only one is bounded, as for an edge that has all directions equally. Islands with an edge that
    is not smooth at the scale of a pixel have larger errors. The error does not include orbits that escape after t_max.

    Parameters
    ----------
    starts
        A complete map, or its dataset, such as ``dataset.sel(h=0.3)`` of a sweep.

    Returns
    -------
    The `Islands`.

    Raises
    ------
    ValueError
        If `starts` is not a complete map.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_islands, compute_map
    >>> islands = compute_islands(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.13, (100, 100), t_max=1e3)))
    >>> islands.count > 1, 0.5 < islands.area < 1.0, islands.area_error < 0.01
    (True, True, True)
    """
    # This import is slow.
    from scipy import ndimage

    checked_starts = read_complete_starts("starts", starts)
    if checked_starts.axes is None:
        raise ValueError("starts: must be a map")
    bounded = checked_starts.fate == Fate.BOUNDED
    part_numbers, _ = ndimage.label(bounded, np.ones((3, 3)))
    # The number 0 means that a start is not bounded.
    pixel_counts = np.bincount(part_numbers.ravel())[1:]
    has_island = pixel_counts.max(initial=0) >= MIN_ISLAND_PIXELS
    in_largest = part_numbers == 1 + int(pixel_counts.argmax()) if has_island else np.zeros_like(bounded)
    return Islands(
        *_measure_area(bounded, checked_starts.pixel_area),
        int(np.count_nonzero(pixel_counts >= MIN_ISLAND_PIXELS)),
        *_measure_area(in_largest, checked_starts.pixel_area),
        made_by=checked_starts.made_by,
    )


def _measure_area(inside: np.ndarray, pixel_area: float) -> tuple[float, float]:
    """Return the area of the pixels selected by a mask (rows, columns), and its error, see `compute_islands`."""
    edge_pairs = sum(int(np.count_nonzero(np.diff(inside, axis=axis))) for axis in (0, 1))
    length = 0.25 * np.pi * edge_pairs
    return float(np.count_nonzero(inside) * pixel_area), float(np.sqrt(_VARIANCE_PER_LENGTH * length) * pixel_area)
