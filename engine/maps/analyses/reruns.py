"""Second integrations of orbits of a map, from slightly shifted starts or with another tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.integrator.source.recurrence import TOLERANCE
from engine.maps.spec import FINEST_PIXEL, MapSpec
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Fate
from engine.slices.sections.section import Crossing

SHIFT = 1e-11
"""Shift of a start along x and along the ordinate, in units of the well: far above rounding errors and far below a pixel."""

LARGEST_SHARE_OF_PIXEL = 0.01
"""Largest shift, as a share of a pixel. It matters in deep zooms."""

SECOND_TOLERANCE = 10.0 * TOLERANCE
"""Tolerance of the second rerun. Its steps are 15 % longer, so its errors are independent of the errors of the map."""

LARGEST_DELAY = 0.01
"""Largest change of an escape time by a rerun, in units of the well.

Near the boundary of a basin the escape time diverges like the logarithm of the distance. A shift by a fraction d of the distance
changes the time by about d. Below this limit, shifts of the same size in other directions therefore stay within the basin.
"""


type Points = tuple[np.ndarray, np.ndarray]
"""x and ordinate of n points, (n,) each."""


def shifted_starts(spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> tuple[Points, ...]:
    """Shift points of the plane in two directions, so that mirror images stay mirror images.

    The shift is `SHIFT`, but at most a hundredth of a pixel, and at least `FINEST_PIXEL`, so that it exceeds rounding errors. The
    first shift is towards 0 in both coordinates, so that the points stay inside. The second shift changes the abscissa only.
    Along an axis h nothing is shifted, so that the energy and its exits do not change. In this case, the first shift is towards 0
    in the other coordinate, and the second shift is away from 0.

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
    free_axes = spec.plane.free_axes
    points = x, ordinate
    axes = zip(points, sides, free_axes, strict=True)
    nearer_x, nearer_ordinate = (_shifted_towards_zero(values, side) if is_free else values for values, side, is_free in axes)
    nearer = nearer_x, nearer_ordinate
    others = (nearer_x, ordinate) if all(free_axes) else _reflected(points, nearer)
    return tuple(_shifted_beyond_section(spec, points, shifted) for shifted in (nearer, others))


def _reflected(points: Points, others: Points) -> Points:
    """Return the reflections of other points in these points."""
    (x, ordinate), (other_x, other_ordinate) = points, others
    return x + (x - other_x), ordinate + (ordinate - other_ordinate)


def _shifted_beyond_section(spec: MapSpec, points: Points, shifted: Points) -> Points:
    """Return shifted points, in the opposite direction where the orbit would otherwise cross the section once more.

    This concerns starts on the section, and those that have just crossed it.
    """
    section, states = spec.section, spec.start_states(*points)
    value, shifted_value = section.values(states), section.values(spec.start_states(*shifted))
    rate = section.rates(states, spec.potential.derivatives(states))
    is_near = np.abs(value) < np.abs(shifted_value)
    has_crossed = np.where(is_near, np.sign(rate), np.sign(value)) == np.sign(rate)
    counts = (rate > 0.0) | (section.direction is Crossing.BOTH)
    crosses = has_crossed & counts & (shifted_value * rate < 0.0)
    x, ordinate = (np.where(crosses, back, there) for back, there in zip(_reflected(points, shifted), shifted, strict=True))
    return x, ordinate


def _shifted_towards_zero(coordinate: np.ndarray, pixel: float) -> np.ndarray:
    """Return coordinates (n,) shifted towards 0, given the side of a pixel."""
    distance = np.maximum(min(SHIFT, LARGEST_SHARE_OF_PIXEL * pixel), FINEST_PIXEL * np.maximum(1.0, np.abs(coordinate)))
    # A start on an axis is shifted in the positive direction.
    return np.where(coordinate > 0.0, coordinate - distance, coordinate + distance)


def _same_starts(_spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> tuple[Points, ...]:
    """Return the points unchanged, for one rerun."""
    return ((x, ordinate),)


@dataclass(frozen=True)
class Perturbation:
    """Parameters of the reruns: their starts, see `shifted_starts`, their tolerances, and the largest change of escape times."""

    find_starts: Callable[[MapSpec, np.ndarray, np.ndarray], tuple[Points, ...]]
    tolerances: tuple[float, ...]
    largest_delay: float


SHIFTED_STARTS = Perturbation(shifted_starts, (TOLERANCE, SECOND_TOLERANCE), LARGEST_DELAY)
"""Two reruns from shifted starts, which test the outcomes of pixels."""

SAME_STARTS = Perturbation(_same_starts, (SECOND_TOLERANCE,), np.inf)
"""One rerun from the same starts, which shows only the errors of the integration."""


@dataclass(frozen=True, eq=False)
class Rerun:
    """A second integration of the n orbits of the tested pixels, with their outcomes on the map, (n,) each."""

    batch: OrbitBatch
    tolerance: float
    largest_delay: float
    fate: np.ndarray
    crossings: np.ndarray
    escape_time: np.ndarray

    def is_decided(self) -> np.ndarray:
        """Return whether each orbit has a fate, of shape (n,)."""
        return self.batch.fate != Fate.NOT_COMPUTED

    def has_changed(self) -> np.ndarray:
        """Return whether each outcome differs from that of the map, of shape (n,).

        An undecided orbit with more crossings than on the map will have another outcome.
        """
        batch, has_escaped = self.batch, self.fate >= 1
        has_other_fate = self.is_decided() & (batch.fate != self.fate)
        has_other_crossings = (batch.fate == self.fate) & (batch.crossings != self.crossings)
        is_delayed = (batch.fate == self.fate) & (np.abs(batch.t - self.escape_time) > self.largest_delay)
        has_other_escape = has_escaped & (has_other_crossings | is_delayed | (batch.crossings > self.crossings))
        return has_other_fate | has_other_escape
