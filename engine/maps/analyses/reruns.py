"""Second integrations of orbits of a map, from slightly shifted starts or with another tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.integrator.source.recurrence import TOLERANCE
from engine.maps.spec import FINEST_PIXEL, MapSpec
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Fate

SHIFT = 1e-11
"""Shift of a start along x and along the ordinate, in units of the well: far above rounding errors and far below a pixel."""

LARGEST_SHARE_OF_PIXEL = 0.01
"""Largest shift as a share of the pixel; this limits the shift in deep zooms."""

SECOND_TOLERANCE = 10.0 * TOLERANCE
"""Tolerance of the second rerun. Its steps are a sixth longer, so its errors are independent of those of the map."""

LARGEST_DELAY = 0.01
"""Largest change of an escape time by a rerun, in units of the well.

Near the boundary of a basin the escape time diverges like the logarithm of the distance. A shift by a fraction d of that distance
changes the time by about d. Below this limit, shifts of the same size in other directions therefore stay within the basin.
"""


def shifted_starts(spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Shift points of the plane in two directions, so that mirror images stay mirror images.

    The shift is `SHIFT`, but at most a hundredth of a pixel, and at least `FINEST_PIXEL` so that it exceeds rounding errors. The
    first shift is towards 0 in both coordinates, so that the points stay inside; the second changes the abscissa only. An axis h
    is not shifted, so that the energy and its exits do not change. In this case, the other coordinate is shifted first towards 0
    and second away from 0.

    Parameters
    ----------
    spec
        The map in units of its well.
    x, ordinate
        (n,) coordinates of the points.

    Returns
    -------
    For each direction, x and ordinate of the shifted points, (n,) each.
    """
    window, (columns, rows) = spec.find_window(), spec.resolution
    sides = window.width / columns, window.height / rows
    is_free = spec.plane.free_axes
    points = x, ordinate
    axes = zip(points, sides, is_free, strict=True)
    nearer = tuple(_shifted_towards_zero(along, side) if free else along for along, side, free in axes)
    if all(is_free):
        return (nearer[0], nearer[1]), (nearer[0], ordinate)
    away = tuple(along + (along - shifted) for along, shifted in zip(points, nearer, strict=True))
    return (nearer[0], nearer[1]), (away[0], away[1])


def _shifted_towards_zero(coordinate: np.ndarray, pixel: float) -> np.ndarray:
    distance = np.maximum(min(SHIFT, LARGEST_SHARE_OF_PIXEL * pixel), FINEST_PIXEL * np.maximum(1.0, np.abs(coordinate)))
    # A start on y = 0 is shifted up, because from below it would cross y = 0 once more.
    shifted: np.ndarray = np.where(coordinate > 0.0, coordinate - distance, coordinate + distance)
    return shifted


def _same_starts(_spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Return the points unchanged."""
    return ((x, ordinate),)


@dataclass(frozen=True)
class Perturbation:
    """Parameters of the reruns: the starts and the tolerance of each rerun, and the largest change of escape times."""

    starts: Callable[[MapSpec, np.ndarray, np.ndarray], tuple[tuple[np.ndarray, np.ndarray], ...]]
    tolerances: tuple[float, ...]
    largest_delay: float


SHIFTED_STARTS = Perturbation(shifted_starts, (TOLERANCE, SECOND_TOLERANCE), LARGEST_DELAY)
SAME_STARTS = Perturbation(_same_starts, (SECOND_TOLERANCE,), np.inf)


@dataclass(frozen=True, eq=False)
class Rerun:
    """A second integration of the orbits (n,) of the tested pixels, with their outcomes on the map."""

    batch: OrbitBatch
    tolerance: float
    largest_delay: float
    fate: np.ndarray
    crossings: np.ndarray
    escape_time: np.ndarray

    def is_decided(self) -> np.ndarray:
        """Return whether each orbit has a fate, of shape (n,)."""
        decided: np.ndarray = self.batch.fate != Fate.NOT_COMPUTED
        return decided

    def has_changed(self) -> np.ndarray:
        """Return whether each outcome differs from that of the map, or must because there are already more crossings."""
        batch, escaped = self.batch, self.fate >= 1
        other_fate = self.is_decided() & (batch.fate != self.fate)
        other_crossings = (batch.fate == self.fate) & (batch.crossings != self.crossings)
        delayed = (batch.fate == self.fate) & (np.abs(batch.t - self.escape_time) > self.largest_delay)
        changed: np.ndarray = other_fate | escaped & (other_crossings | delayed | (batch.crossings > self.crossings))
        return changed
