"""Smooth curves through the passages of the orbits of a tube: the spacing of their points, and where more points are needed."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from engine.slices.window import Window

SPACING = 1 / 200
"""Largest distance between neighbouring points as a share of the window's side, before straight parts are thinned."""

# Distance by which curves extend beyond the edges of a window, as a share of its sides.
_WINDOW_MARGIN = 0.1

# Largest distance of a point from the chord of its neighbours, as a share of the spacing.
_MAX_SAGITTA = 0.05
# Largest distance by which thinning may change a curve, as a share of the spacing.
_THINNING_TOLERANCE = 0.025
# Largest difference in passage time between neighbouring points of an arc, in units of the well.
_MAX_TIME_GAP = 0.3
# Initial number of intervals of the phase; orbits of a tube have phases from 0 to 1.
_FIRST_INTERVALS = 512
# Smallest widths of the intervals in successive rounds of refinement of all passages; below the last width, rounding errors of
# the start states are visible.
_MIN_WIDTHS = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
# Largest number of parts into which an interval is split at once.
_MAX_PARTS = 8


@dataclass(frozen=True)
class PointSpacing:
    """Largest distance between neighbouring points, in units of the well: `fine` in the window that is drawn, `coarse` elsewhere.

    `low` and `high`, (2,) each, are the corners of the window with its margin; None for the whole plane.
    """

    coarse: float
    fine: float
    low: np.ndarray | None = None
    high: np.ndarray | None = None

    @classmethod
    def for_window(cls, plane_window: Window, window: Window | None) -> PointSpacing:
        """Return the spacing for a window, or for the window of the whole plane."""
        coarse = SPACING * plane_window.width
        if window is None:
            return cls(coarse, coarse)
        low, high = np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])
        sides = high - low
        fine = min(coarse, SPACING * float(sides.max()))
        return cls(coarse, fine, low - _WINDOW_MARGIN * sides, high + _WINDOW_MARGIN * sides)

    def between(self, points: np.ndarray) -> np.ndarray:
        """Return the largest allowed distances between neighbours of n points (n, 2), of shape (n − 1,)."""
        if self.low is None or self.high is None:
            return np.full(len(points) - 1, self.fine)
        # Between two points, a curve may bulge by as much as their distance.
        distance = np.abs(np.diff(points, axis=0)).max(axis=1)[:, None]
        start, end = points[:-1], points[1:]
        is_near = (np.minimum(end, start) - distance <= self.high) & (np.maximum(end, start) + distance >= self.low)
        return np.where(is_near.all(axis=1), self.fine, self.coarse)

    def thin(self, piece: np.ndarray) -> Iterator[np.ndarray]:
        """Yield the lines (m, 2) of a piece in the window, without points close to the line between their neighbours."""
        # The import is slow and seldom needed.
        import shapely

        line = shapely.simplify(shapely.LineString(piece), _THINNING_TOLERANCE * self.fine, preserve_topology=False)
        if self.low is not None and self.high is not None:
            line = shapely.clip_by_rect(line, *self.low, *self.high)
        yield from (shapely.get_coordinates(part) for part in shapely.get_parts(line) if not part.is_empty)


def refine_passages(
    find_passages: Callable[[np.ndarray], np.ndarray], count: int, spacing: PointSpacing, max_orbits: int
) -> np.ndarray:
    """Return passages of orbits in order of phase, (n, count, 3). Orbits are added until the curves are smooth.

    `find_passages` is a function of phases (m,) that returns the passages, (m, count, 3): two coordinates and the time. At most
    `max_orbits` orbits are added.
    """
    phases = np.linspace(0.0, 1.0, _FIRST_INTERVALS + 1)
    passages = find_passages(phases)
    for min_width, passage in itertools.product(_MIN_WIDTHS, range(count)):
        while True:
            width = np.diff(phases)
            parts = _limit_parts(_count_parts(passages[:, passage], spacing), width, min_width, max_orbits)
            if parts.max() == 1:
                break
            interval, new_phases = _subdivide(phases, width, parts)
            phases = np.insert(phases, interval + 1, new_phases)
            passages = np.insert(passages, interval + 1, find_passages(new_phases), axis=0)
            max_orbits -= new_phases.size
    return passages


def _subdivide(phases: np.ndarray, width: np.ndarray, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return, for each new phase, its interval and its value, if each interval is split into equal `parts` (n,)."""
    new_counts = parts - 1
    first_index = np.cumsum(new_counts) - new_counts
    interval = np.repeat(np.arange(parts.size), new_counts)
    # The new phases of each interval have the positions 1, 2, …
    position = np.arange(interval.size) - first_index[interval] + 1
    return interval, phases[interval] + width[interval] * position / parts[interval]


def _limit_parts(parts: np.ndarray, width: np.ndarray, min_width: float, max_orbits: int) -> np.ndarray:
    """Limit `parts` (n,) to widths of `min_width` or more, and to `max_orbits` new orbits in the widest intervals."""
    parts = np.minimum(parts, np.maximum(width / min_width, 1.0)).astype(int)
    widest_first = np.argsort(-width, kind="stable")
    parts[widest_first[np.cumsum(parts[widest_first] - 1) > max_orbits]] = 1
    return parts


def _count_parts(points: np.ndarray, spacing: PointSpacing) -> np.ndarray:
    """Return the number of parts, (n − 1,), into which to split each interval between passages (n, 3); 1 keeps it."""
    allowed = spacing.between(points[:, :2])
    exists = np.isfinite(points[:, 0])
    step = np.diff(points, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    parts = np.ceil(np.maximum(length / allowed, np.abs(step[:, 2]) / _MAX_TIME_GAP))
    # NaN marks an interval with a missing passage at one end or at both.
    parts = np.where(np.isnan(parts), np.where(exists[1:] != exists[:-1], _MAX_PARTS, 1), np.maximum(parts, 1))
    # Both intervals next to a sharp bend are split.
    is_sharp = _sagitta(step[:, :2], length) > _MAX_SAGITTA * np.minimum(allowed[1:], allowed[:-1])
    parts[:-1][is_sharp] = np.maximum(parts[:-1][is_sharp], 2)
    parts[1:][is_sharp] = np.maximum(parts[1:][is_sharp], 2)
    return np.minimum(parts, _MAX_PARTS)


def _sagitta(step: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Return the distance of each inner point from the chord of its neighbours, of shape (n − 2,).

    Where the curve reverses, the distance is that from the farther neighbour. NaN becomes 0. `step`, (n − 1, 2), and `length`,
    (n − 1,), are the differences between neighbouring points and their lengths.
    """
    step_in, step_out = step[:-1], step[1:]
    area = np.abs(step_in[:, 0] * step_out[:, 1] - step_in[:, 1] * step_out[:, 0])
    chord = np.maximum(np.hypot(*(step_in + step_out).T), np.finfo(float).tiny)
    continues_forward = np.sum(step_in * step_out, axis=1) > 0.0
    sagitta: np.ndarray = np.where(continues_forward, area / chord, np.maximum(length[:-1], length[1:]))
    return np.where(np.isnan(area), 0.0, sagitta)


def split_curve(curve: np.ndarray, spacing: PointSpacing, closed: bool) -> list[np.ndarray]:
    """Return the pieces of a curve (n, 3) between gaps, each (m, 2), m ≥ 2; the last piece of a closed curve joins the first."""
    step = np.diff(curve, axis=0)
    is_short = np.hypot(step[:, 0], step[:, 1]) <= 2.0 * spacing.between(curve[:, :2])
    is_joined = is_short & (np.abs(step[:, 2]) <= 2.0 * _MAX_TIME_GAP)
    edges = np.concatenate([[0], np.flatnonzero(~is_joined) + 1, [len(curve)]])
    runs = [(begin, end) for begin, end in itertools.pairwise(edges) if end - begin > 1]
    pieces = [curve[begin:end, :2] for begin, end in runs]
    if closed and runs and runs[0][0] == 0 and runs[-1][1] == len(curve):
        # The first and the last point of a closed curve belong to the same orbit. The first piece, or without a gap its first
        # point, replaces the last point.
        last = pieces.pop()
        pieces[:1] = [np.concatenate([last[:-1], pieces[0] if pieces else last[:1]])]
    return pieces
