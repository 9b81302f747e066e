"""Stable manifolds of the Lyapunov orbits on the section y = 0, py > 0: the boundaries between exit basins on (x, px).

Orbits that tend to the Lyapunov orbit over an exit form a tube, its stable manifold. Orbits inside the tube leave through that
exit, orbits outside it turn back. Backward in time the tube enters the well and intersects the section repeatedly; the successive
intersections are called its images. As the kinetic energy is even in the momenta, the tube backward in time is the unstable
manifold with reversed momenta. The code therefore integrates the unstable manifold forward from near the Lyapunov orbit; each
downward passage (x, px) of y = 0 gives a point (x, −px) of the stable manifold.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from engine.exits.lyapunov_orbits import LyapunovOrbit, find_orbits_in_well_units
from engine.foundations.arrays import ReadOnlyArrays, read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.result import Result
from engine.foundations.validation import checked_count, checked_number, checks_types
from engine.periodic.unstable_manifold import UnstableManifold
from engine.slices.default_window import default_window
from engine.slices.planes import SECTION
from engine.slices.window import GivenWindow, Window, checked_window
from engine.systems.potential import Potential
from engine.systems.provenance import describe_run
from engine.systems.well_units import LENGTH, MOMENTUM

MOST_IMAGES = 6
"""Largest number of images; later ones are too fine and too many to plot."""

ORBITS_PER_IMAGE = 20_000
"""Orbits integrated per channel and image at most, about 0.3 s of work; finer structure is left out."""

SPACING = 1 / 200
"""Largest distance between neighbouring points as a share of the window's side, before straight parts are thinned."""

# Curves in a window extend beyond its edges by this share of its sides.
_WINDOW_MARGIN = 0.1

# Largest distance of a point from the chord of its neighbours, and how much of it thinning may remove, as shares of the spacing.
_MAX_SAGITTA, _THINNING_TOLERANCE = 0.05, 0.025
# Largest difference in passage time between neighbouring points of an arc.
_MAX_TIME_GAP = 0.3
# Orbits of a tube have phases from 0 to 1: the number of first intervals, and the smallest widths to which intervals are refined,
# each for all images before the next. Below the last width rounding errors of the start states are visible.
_FIRST_INTERVALS = 512
_MIN_WIDTHS = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
_MAX_PARTS = 8


@dataclass(frozen=True, eq=False)
class ManifoldArc(ReadOnlyArrays):
    """A connected piece of one stable manifold on the section.

    Attributes
    ----------
    channel
        Exit channel of the Lyapunov orbit, from 1.
    image
        1 for the tube's first intersection with y = 0, py > 0 backward in time, 2 for the next, …
    x, px
        (n,) points in order along the curve, dimensionless, read-only; n ≥ 2. The last point of a closed curve equals the first.
    """

    channel: int
    image: int
    x: np.ndarray = field(metadata=LENGTH)
    px: np.ndarray = field(metadata=MOMENTUM)


@dataclass(frozen=True, eq=False, repr=False)
class StableManifolds(Result):
    """Intersections of the stable manifolds of all Lyapunov orbits of one energy with y = 0, py > 0.

    Attributes
    ----------
    potential, energy
        The `Potential` and h, dimensionless.
    arcs
        Sorted by channel, then image.
    images
        Number of images computed for each tube.
    truncated
        Whether an arc is incomplete: it winds around another arc infinitely often, or is too fine to be resolved.
    """

    potential: Potential
    energy: float
    arcs: tuple[ManifoldArc, ...]
    images: int
    truncated: bool
    row_dimension: ClassVar = "point"
    held_as: ClassVar = {"arcs": "arc"}

    def provenance(self) -> dict[str, Any]:
        """The potential, the energy, the slice, the integrator and the version."""
        return describe_run(self.potential, energy=self.energy, plane=SECTION.title)

    def columns(self) -> Mapping[str, np.ndarray]:
        """All points, with the number of their arc from 1, its channel and its image."""
        labels = [(number, arc.channel, arc.image) for number, arc in enumerate(self.arcs, 1)]
        sizes = [arc.x.size for arc in self.arcs]
        points = (np.concatenate([np.empty(0), *(getattr(arc, name) for arc in self.arcs)]) for name in ("x", "px"))
        codes = np.repeat(np.array(labels, int).reshape(-1, 3), sizes, axis=0).T
        return dict(zip(("arc", "channel", "image", "x", "px"), (*codes, *points), strict=True))

    @staticmethod
    def arcs_of(columns: Mapping[str, np.ndarray]) -> tuple[ManifoldArc, ...]:
        """The arcs of such `columns`."""
        starts = np.flatnonzero(np.diff(columns["arc"], prepend=0))
        parts = [np.split(columns[name], starts[1:]) for name in ("channel", "image", "x", "px")] if starts.size else [[]] * 4
        return tuple(
            ManifoldArc(int(channel[0]), int(image[0]), read_only(x), read_only(px))
            for channel, image, x, px in zip(*parts, strict=True)
        )

    def describe(self) -> str:
        """The numbers of arcs and points in one sentence."""
        images = sorted({arc.image for arc in self.arcs})
        shown = f"images {', '.join(map(str, images))}" if len(images) > 1 else f"image {images[0]}" if images else "no image"
        points = sum(arc.x.size for arc in self.arcs)
        truncated = ", some of them truncated spirals" if self.truncated else ""
        return f"Stable manifolds of the Lyapunov orbits, {shown}: {len(self.arcs)} arcs of {points} points{truncated}."

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return sum(arc.x.nbytes + arc.px.nbytes for arc in self.arcs)


@checks_types(potential=Potential, execution=Execution)
def find_stable_manifolds(
    potential: Potential,
    energy: float,
    *,
    images: int = 3,
    window: GivenWindow | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> StableManifolds:
    """Find the curves on (x, px) that separate orbits leaving through a channel from orbits turning back before it.

    On one side of an arc of image n, orbits leave through its channel after exactly n − 1 upward crossings of y = 0, the start
    not counted. On the other side they turn back before that exit, and leave later or never. Where the Lyapunov orbit itself
    crosses y = 0 (channel 1 of Case II), orbits cross it more often the longer they stay near that orbit; images are then
    numbered along the curve, which starts at the orbit's own point, and the number of crossings is not fixed.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        h, finite, dimensionless.
    images
        Number of successive intersections of each tube with the section, 1 to 6.
    window
        Part of (x, px) to resolve in a zoom, given as in `MapSpec`: the spacing of points follows from its size, as far as the
        number of orbits allows, and curves beyond it are left out. None for the whole plane.
    execution
        How the computation runs.

    Returns
    -------
    `StableManifolds`; no arcs at or below the escape energy. An arc ends where the tube, backward in time, leaves through an
    exit: it winds towards another manifold's section in infinitely many turns, of which the first few are given. Points lie on
    the manifold to 1e-10.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When `energy` is not finite or too high for unstable Lyapunov orbits, `images` is out of range, or the frame rotates.

    Notes
    -----
    Tubes and their role in escapes: Contopoulos 1990, Astron. Astrophys. 231, 41; Koon, Lo, Marsden & Ross 2000, Chaos 10, 427.

    Examples
    --------
    >>> from escape_explorer import CASES, find_stable_manifolds
    >>> manifolds = find_stable_manifolds(CASES["I"], 0.19, images=1)
    >>> [(arc.channel, arc.image) for arc in manifolds.arcs]
    [(1, 1), (2, 1)]
    """
    potential.check_at_rest("stable manifolds")
    images = checked_count("images", images, 1, MOST_IMAGES)
    given, given_energy, units = potential, checked_number("energy", energy), potential.units
    whole = default_window(potential, SECTION, given_energy)
    part = None if window is None else checked_window(window)
    potential, energy = potential.in_well_units, given_energy / units.energy
    factors = 1.0 / units.length, 1.0 / units.momentum
    spacing = _PointSpacing.for_window(whole.scaled(*factors), part.scaled(*factors) if part is not None else None)
    orbits = {orbit.channel: orbit for orbit in find_orbits_in_well_units(potential, energy)}
    mirror = potential.well.mirror_in_x and window is None
    image = potential.well.mirror_numbers(energy) if mirror else np.arange(potential.channels + 1)
    firsts = [channel for channel in orbits if channel <= image[channel]]
    # Each thread waits for the tiles of its channel most of the time.
    with ThreadPoolExecutor(max(len(firsts), 1)) as threads:
        found = threads.map(lambda channel: _find_arcs(orbits[channel], images, spacing, execution), firsts)
        arcs = dict(zip(firsts, found, strict=True))
    truncated = any(unfinished for _, unfinished in arcs.values())
    restored = tuple(units.restore(arc) for channel in orbits for arc in _arcs_of(channel, arcs, int(image[channel])))
    return StableManifolds(given, given_energy, restored, images, truncated)


def _arcs_of(channel: int, arcs: dict[int, tuple[list[ManifoldArc], bool]], image: int) -> list[ManifoldArc]:
    """The arcs of a channel, or the images of those of its mirror channel."""
    if channel in arcs:
        return arcs[channel][0]
    return [_mirrored(arc, channel) for arc in arcs[image][0]]


def _mirrored(arc: ManifoldArc, channel: int) -> ManifoldArc:
    """The image under x → −x, which maps (x, px) to (−x, −px)."""
    return ManifoldArc(channel, arc.image, read_only(-arc.x), read_only(-arc.px))


def _find_arcs(orbit: LyapunovOrbit, images: int, spacing: _PointSpacing, execution: Execution) -> tuple[list[ManifoldArc], bool]:
    """The arcs of one channel, and whether any of them is incomplete."""
    try:
        tube = UnstableManifold.from_orbit(orbit)
    except ValueError as error:
        raise ValueError(f"energy={orbit.energy * orbit.potential.well.stated_units.energy}: {error}") from None
    count = tube.near_passages + images
    passages = _refine(lambda phases: tube.find_passages(phases, count, execution), count, spacing, images * ORBITS_PER_IMAGE)
    arcs = []
    unfinished = False
    for image in range(1, images + 1):
        first = 0 if image == 1 else tube.near_passages + image - 1
        # The passages near the Lyapunov orbit join end to end and belong to image 1.
        curve = np.concatenate([passages[:, k] for k in range(first, tube.near_passages + image)])
        pieces = _split(curve, spacing, closed=tube.near_passages == 0)
        unfinished |= not (len(pieces) == 1 and np.isfinite(curve).all())
        arcs += [_arc(orbit.channel, image, line) for piece in pieces for line in spacing.thin(piece)]
    return arcs, unfinished


@dataclass(frozen=True)
class _PointSpacing:
    """Largest distance between neighbouring points: `fine` in the window that is drawn, `coarse` elsewhere.

    The window is given by its `low` and `high` corners on the plane of the unstable manifold, where px has the opposite sign;
    None for the whole plane.
    """

    coarse: float
    fine: float
    low: np.ndarray | None = None
    high: np.ndarray | None = None

    @classmethod
    def for_window(cls, whole: Window, window: Window | None) -> _PointSpacing:
        coarse = SPACING * (whole.x_high - whole.x_low)
        if window is None:
            return cls(coarse, coarse)
        low, high = np.array([[window.x_low, -window.ordinate_high], [window.x_high, -window.ordinate_low]])
        sides = high - low
        fine = min(coarse, SPACING * float(sides.max()))
        return cls(coarse, fine, low - _WINDOW_MARGIN * sides, high + _WINDOW_MARGIN * sides)

    def between(self, points: np.ndarray) -> np.ndarray:
        """(n − 1,) largest distance allowed between neighbours of the points (n, 2)."""
        if self.low is None or self.high is None:
            return np.full(len(points) - 1, self.fine)
        # Between two points, a curve may bulge by as much as their distance.
        distance = np.abs(np.diff(points, axis=0)).max(axis=1)[:, None]
        start, end = points[:-1], points[1:]
        near = (np.minimum(end, start) - distance <= self.high) & (np.maximum(end, start) + distance >= self.low)
        spacing: np.ndarray = np.where(near.all(axis=1), self.fine, self.coarse)
        return spacing

    def thin(self, piece: np.ndarray) -> Iterator[np.ndarray]:
        """The (m, 2) lines of a piece within the window, without points that their neighbours imply."""
        import shapely

        line = shapely.simplify(shapely.LineString(piece), _THINNING_TOLERANCE * self.fine, preserve_topology=False)
        if self.low is not None and self.high is not None:
            line = shapely.clip_by_rect(line, *self.low, *self.high)
        yield from (shapely.get_coordinates(part) for part in shapely.get_parts(line) if not part.is_empty)


def _refine(find_passages: Callable[[np.ndarray], np.ndarray], count: int, spacing: _PointSpacing, max_orbits: int) -> np.ndarray:
    """(n, count, 3) passages of orbits of rising phase, refined until curves are smooth or `max_orbits` have been added."""
    phases = np.linspace(0.0, 1.0, _FIRST_INTERVALS + 1)
    passages = find_passages(phases)
    for min_width, passage in itertools.product(_MIN_WIDTHS, range(count)):
        while True:
            width = np.diff(phases)
            parts = _affordable(_parts_needed(passages[:, passage], spacing), width, min_width, max_orbits)
            if parts.max() == 1:
                break
            interval, new = _subdivide(phases, width, parts)
            phases = np.insert(phases, interval + 1, new)
            passages = np.insert(passages, interval + 1, find_passages(new), axis=0)
            max_orbits -= new.size
    return passages


def _subdivide(phases: np.ndarray, width: np.ndarray, parts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each new phase, the interval it lies in and its value, when intervals are split into equal `parts` (n,)."""
    interval = np.repeat(np.arange(parts.size), parts - 1)
    position = np.arange(interval.size) - np.repeat(np.cumsum(parts - 1) - (parts - 1), parts - 1) + 1
    return interval, phases[interval] + width[interval] * position / parts[interval]


def _affordable(parts: np.ndarray, width: np.ndarray, min_width: float, max_orbits: int) -> np.ndarray:
    """Limit `parts` (n,) so that no part is narrower than `min_width` and at most `max_orbits` are added, widest first."""
    parts = np.minimum(parts, np.maximum(width / min_width, 1.0)).astype(int)
    widest_first = np.argsort(-width, kind="stable")
    parts[widest_first[np.cumsum(parts[widest_first] - 1) > max_orbits]] = 1
    return parts


def _parts_needed(points: np.ndarray, spacing: _PointSpacing) -> np.ndarray:
    """(n − 1,) number of parts into which to split the intervals between neighbours of (n, 3) x, px, time; 1 to keep one."""
    allowed = spacing.between(points[:, :2])
    exists = np.isfinite(points[:, 0])
    step = np.diff(points, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    parts = np.ceil(np.maximum(length / allowed, np.abs(step[:, 2]) / _MAX_TIME_GAP))
    parts = np.where(np.isnan(parts), np.where(exists[1:] != exists[:-1], _MAX_PARTS, 1), np.maximum(parts, 1))
    sharp = _sagitta(step[:, :2], length) > _MAX_SAGITTA * np.minimum(allowed[1:], allowed[:-1])
    parts[:-1][sharp] = np.maximum(parts[:-1][sharp], 2)
    parts[1:][sharp] = np.maximum(parts[1:][sharp], 2)
    return np.minimum(parts, _MAX_PARTS)


def _sagitta(step: np.ndarray, length: np.ndarray) -> np.ndarray:
    """Distance of each inner point from the chord of its neighbours; where the curve reverses, from the farther neighbour.

    step, length: (n − 1, 2) and (n − 1,) differences between neighbouring points and their lengths; NaN distances become 0.
    """
    before, after = step[:-1], step[1:]
    area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    chord = np.maximum(np.hypot(*(before + after).T), np.finfo(float).tiny)
    ahead = np.sum(before * after, axis=1) > 0.0
    sagitta: np.ndarray = np.where(ahead, area / chord, np.maximum(length[:-1], length[1:]))
    return np.where(np.isnan(area), 0.0, sagitta)


def _split(curve: np.ndarray, spacing: _PointSpacing, closed: bool) -> list[np.ndarray]:
    """The (m, 2) pieces, m ≥ 2, of a curve (n, 3) between its gaps; on a closed curve the last piece is joined to the first."""
    step = np.diff(curve, axis=0)
    short = np.hypot(step[:, 0], step[:, 1]) <= 2.0 * spacing.between(curve[:, :2])
    joined = short & (np.abs(step[:, 2]) <= 2.0 * _MAX_TIME_GAP)
    edges = np.concatenate([[0], np.flatnonzero(~joined) + 1, [len(curve)]])
    runs = [(begin, end) for begin, end in itertools.pairwise(edges) if end - begin > 1]
    pieces = [curve[begin:end, :2] for begin, end in runs]
    if closed and runs and runs[0][0] == 0 and runs[-1][1] == len(curve):
        # The first and the last orbit of a closed curve are the same.
        last = pieces.pop()
        pieces[:1] = [np.concatenate([last[:-1], pieces[0] if pieces else last[:1]])]
    return pieces


def _arc(channel: int, image: int, line: np.ndarray) -> ManifoldArc:
    """The arc of the stable manifold given by a line (m, 2) of the unstable one: its momenta are reversed."""
    x, px = line.T
    return ManifoldArc(channel, image, read_only(x.copy()), read_only(-px))
