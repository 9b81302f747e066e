"""Stable manifolds of the Lyapunov orbits, cut by the section y = 0, py > 0: the boundaries between exit basins on (x, px).

Orbits that tend to the Lyapunov orbit over an exit fill a tube, its stable manifold. Inside the tube are those that leave there,
outside those that turn back. Followed backward in time into the well, the tube meets the section again and again: its images.
Kinetic energy is even in the momenta, so the tube backward in time is the unstable manifold with all momenta reversed. It is
that one which is followed here, forward, from near the Lyapunov orbit; its downward passages (x, px) of y = 0 give (x, −px).
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
import shapely

from engine.arrays import read_only
from engine.dynamics.lyapunov_orbits import LyapunovOrbit, find_lyapunov_orbits
from engine.dynamics.planes import Plane, Window, default_window
from engine.invariant_sets.unstable_manifold import UnstableManifold
from engine.potentials.potential import Potential
from engine.validation import read_count

MOST_IMAGES = 6
"""Images beyond are threads too fine and too many for any picture."""

ORBITS_PER_IMAGE = 20_000
"""So many orbits times the images are followed for a channel at most, some 0.3 s of work an image; what is finer is left out."""

SPACING = 1 / 200
"""Share of the side of the window that neighbours in it are apart at most, before straight parts are thinned."""

# A part of the plane is drawn with a rim of this share of its sides, so that curves do not end at its edge.
_RIM = 0.1

# How far from the chord of its neighbours a point may lie, and how much of that thinning may take away: shares of the spacing.
_SAGITTA, _THINNED = 0.05, 0.025
# Points next to each other on an arc are reached at about the same time.
_TIME_APART = 0.3
# The orbits of a tube are numbered from 0 to 1: how many are followed at first, and how narrow an interval may become, for all
# images before the next width is tried. Below the last, rounding of the launch shows.
_FIRST_ORBITS = 512
_NARROWEST = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
_MOST_PARTS = 8


@dataclass(frozen=True, eq=False)
class ManifoldArc:
    """A piece of the section of one stable manifold.

    Attributes
    ----------
    channel
        Exit channel of the Lyapunov orbit, from 1.
    image
        1 for the first cut of the tube with y = 0, py > 0 met backward in time, 2 for the next, …
    x, px
        (n,) points in order along the curve, dimensionless, read-only; n ≥ 2. A closed curve ends where it begins.
    """

    channel: int
    image: int
    x: np.ndarray
    px: np.ndarray


@dataclass(frozen=True, eq=False)
class StableManifolds:
    """The sections of the stable manifolds of all Lyapunov orbits of one energy with y = 0, py > 0.

    Attributes
    ----------
    potential, energy
        Of all orbits.
    arcs
        By channel, then image.
    images
        How many images of each tube were looked for.
    truncated
        Whether an arc was left unfinished: one that winds round another arc for ever, or one too fine to be resolved.
    """

    potential: Potential
    energy: float
    arcs: tuple[ManifoldArc, ...]
    images: int
    truncated: bool

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        return sum(arc.x.nbytes + arc.px.nbytes for arc in self.arcs)


def find_stable_manifolds(
    potential: Potential,
    energy: float,
    images: int = 3,
    *,
    window: Window | None = None,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> StableManifolds:
    """The curves on (x, px) that part orbits that leave through a channel from those that turn back before it.

    On one side of an arc of image n orbits leave through its channel after exactly n − 1 upward crossings of y = 0, the start
    not counted; on the other they turn back before that exit, to leave later if at all. Where the Lyapunov orbit itself crosses
    y = 0 (channel 1 of Case II), orbits cross it the more often the longer they stay near: there images are numbered along the
    curve, which begins at that orbit's own point, and the number of crossings is not fixed.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        h, finite, dimensionless.
    images
        How many successive cuts of each tube with the section to look for, 1 to `MOST_IMAGES`.
    window
        The part of (x, px) to be drawn, for a closer look: points are as close there as its size asks for, as far as the number
        of orbits allows, and what lies beyond is left out. None for the whole plane.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, the work stops within about 0.1 s.

    Returns
    -------
    `StableManifolds`; no arcs at or below the escape energy. An arc ends where the tube has left through an exit, backward in
    time: it winds towards another manifold's section, in infinitely many turns of which the first few are given. Points are
    on the manifold to 1e-10.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When `energy` is not finite or too high for unstable Lyapunov orbits, or `images` is out of its range.

    Notes
    -----
    Tubes and their part in escapes: Contopoulos 1990, Astron. Astrophys. 231, 41; Koon, Lo, Marsden & Ross 2000, Chaos 10, 427.
    """
    images = read_count("images", images, 1, MOST_IMAGES)
    arcs: dict[int, list[ManifoldArc]] = {}
    truncated = False
    grain = _Grain.of(default_window(potential, Plane.X_PX, energy), window)
    for orbit in find_lyapunov_orbits(potential, energy):
        image = int(potential.mirror_channels[orbit.channel]) if potential.mirror_in_x else orbit.channel
        if image in arcs and window is None:
            # x → −x carries (x, px) into (−x, −px).
            mirrored = ((arc.image, read_only(-arc.x), read_only(-arc.px)) for arc in arcs[image])
            arcs[orbit.channel] = [ManifoldArc(orbit.channel, *fields) for fields in mirrored]
            continue
        arcs[orbit.channel], unfinished = _find_arcs(potential, orbit, images, grain, executor, cancel)
        truncated = truncated or unfinished
    return StableManifolds(potential, float(energy), tuple(arc for found in arcs.values() for arc in found), images, truncated)


def _find_arcs(
    potential: Potential,
    orbit: LyapunovOrbit,
    images: int,
    grain: _Grain,
    executor: Executor | None,
    cancel: threading.Event | None,
) -> tuple[list[ManifoldArc], bool]:
    """The arcs of one channel, and whether any is unfinished."""
    tube = UnstableManifold.from_orbit(potential, orbit)
    most = tube.near_cuts + images
    cuts = _refine(lambda numbers: tube.follow(numbers, most, executor, cancel), most, grain, images * ORBITS_PER_IMAGE)
    arcs = []
    unfinished = False
    for image in range(1, images + 1):
        first = 0 if image == 1 else tube.near_cuts + image - 1
        # Near the Lyapunov orbit each cut goes on where the one before it ends.
        curve = np.concatenate([cuts[:, k] for k in range(first, tube.near_cuts + image)])
        pieces = _split(curve, grain, closed=tube.near_cuts == 0)
        unfinished |= not (len(pieces) == 1 and np.isfinite(curve).all())
        arcs += [_arc(orbit.channel, image, line) for piece in pieces for line in grain.trim(piece)]
    return arcs, unfinished


@dataclass(frozen=True)
class _Grain:
    """How close points are to be: `fine` in the part of the plane that is drawn, `coarse` elsewhere.

    The part is given by its `low` and `high` corners on the plane of the unstable manifold, where px has the other sign; None for
    all.
    """

    coarse: float
    fine: float
    low: np.ndarray | None = None
    high: np.ndarray | None = None

    @classmethod
    def of(cls, whole: Window, part: Window | None) -> _Grain:
        coarse = SPACING * (whole.x_high - whole.x_low)
        if part is None:
            return cls(coarse, coarse)
        corners = np.array([[part.x_low, -part.ordinate_high], [part.x_high, -part.ordinate_low]])
        sides = corners[1] - corners[0]
        return cls(coarse, min(coarse, SPACING * float(sides.max())), corners[0] - _RIM * sides, corners[1] + _RIM * sides)

    def spacings(self, points: np.ndarray) -> np.ndarray:
        """(n − 1,) how far apart neighbours of the points (n, 2) may be."""
        if self.low is None or self.high is None:
            return np.full(len(points) - 1, self.fine)
        # Between two points a curve may bulge by as much as they are apart.
        apart = np.abs(np.diff(points, axis=0)).max(axis=1)[:, None]
        ahead, behind = points[1:], points[:-1]
        near = (np.minimum(ahead, behind) - apart <= self.high) & (np.maximum(ahead, behind) + apart >= self.low)
        spacing: np.ndarray = np.where(near.all(axis=1), self.fine, self.coarse)
        return spacing

    def trim(self, piece: np.ndarray) -> Iterator[np.ndarray]:
        """The (m, 2) lines of a piece that are drawn, without points that their neighbours imply."""
        line = shapely.simplify(shapely.LineString(piece), _THINNED * self.fine, preserve_topology=False)
        if self.low is not None and self.high is not None:
            line = shapely.clip_by_rect(line, *self.low, *self.high)
        yield from (shapely.get_coordinates(part) for part in shapely.get_parts(line) if not part.is_empty)


def _refine(follow: Callable[[np.ndarray], np.ndarray], most: int, grain: _Grain, room: int) -> np.ndarray:
    """(n, most, 3) cuts of orbits in order, enough of them for smooth curves unless that takes more than `room` orbits."""
    numbers = np.linspace(0.0, 1.0, _FIRST_ORBITS + 1)
    cuts = follow(numbers)
    for narrowest, image in itertools.product(_NARROWEST, range(most)):
        while True:
            width = np.diff(numbers)
            parts = _affordable(_parts_wanted(cuts[:, image], grain), width, narrowest, room)
            if parts.max() == 1:
                break
            gap = np.repeat(np.arange(parts.size), parts - 1)
            place = np.arange(gap.size) - np.repeat(np.cumsum(parts - 1) - (parts - 1), parts - 1) + 1
            new = numbers[gap] + width[gap] * place / parts[gap]
            numbers, cuts = np.insert(numbers, gap + 1, new), np.insert(cuts, gap + 1, follow(new), axis=0)
            room -= new.size
    return cuts


def _affordable(parts: np.ndarray, width: np.ndarray, narrowest: float, room: int) -> np.ndarray:
    """The parts that intervals are split into when none may become narrower than that and no more than `room` orbits be added."""
    parts = np.minimum(parts, np.maximum(width / narrowest, 1.0)).astype(int)
    widest_first = np.argsort(-width, kind="stable")
    parts[widest_first[np.cumsum(parts[widest_first] - 1) > room]] = 1
    return parts


def _parts_wanted(points: np.ndarray, grain: _Grain) -> np.ndarray:
    """(n − 1,) into how many parts each interval between neighbours (n, 3) is to be split, 1 where all is well."""
    spacing = grain.spacings(points[:, :2])
    there = np.isfinite(points[:, 0])
    step = np.diff(points, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    parts = np.ceil(np.maximum(length / spacing, np.abs(step[:, 2]) / _TIME_APART))
    parts = np.where(np.isnan(parts), np.where(there[1:] != there[:-1], _MOST_PARTS, 1), np.maximum(parts, 1))
    sharp = _sagitta(step[:, :2], length) > _SAGITTA * np.minimum(spacing[1:], spacing[:-1])
    parts[:-1][sharp] = np.maximum(parts[:-1][sharp], 2)
    parts[1:][sharp] = np.maximum(parts[1:][sharp], 2)
    return np.minimum(parts, _MOST_PARTS)


def _sagitta(step: np.ndarray, length: np.ndarray) -> np.ndarray:
    """How far each inner point lies from the chord of its neighbours; where the curve turns back, from the farther of them."""
    before, after = step[:-1], step[1:]
    area = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    chord = np.maximum(np.hypot(*(before + after).T), np.finfo(float).tiny)
    ahead = np.sum(before * after, axis=1) > 0.0
    sagitta: np.ndarray = np.where(ahead, area / chord, np.maximum(length[:-1], length[1:]))
    return np.where(np.isnan(area), 0.0, sagitta)


def _split(curve: np.ndarray, grain: _Grain, closed: bool) -> list[np.ndarray]:
    """The (m, 2) pieces, m ≥ 2, of a curve (n, 3) between its breaks; of a closed one the last goes on as the first."""
    step = np.diff(curve, axis=0)
    joined = (np.hypot(step[:, 0], step[:, 1]) <= 2.0 * grain.spacings(curve[:, :2])) & (np.abs(step[:, 2]) <= 2.0 * _TIME_APART)
    edges = np.concatenate([[0], np.flatnonzero(~joined) + 1, [len(curve)]])
    runs = [(begin, end) for begin, end in itertools.pairwise(edges) if end - begin > 1]
    pieces = [curve[begin:end, :2] for begin, end in runs]
    if closed and runs and runs[0][0] == 0 and runs[-1][1] == len(curve):
        # Its first and last orbit are the same one.
        last = pieces.pop()
        pieces[:1] = [np.concatenate([last[:-1], pieces[0] if pieces else last[:1]])]
    return pieces


def _arc(channel: int, image: int, line: np.ndarray) -> ManifoldArc:
    """A line (m, 2) of the unstable manifold as an arc of the stable one: with momenta reversed."""
    x, px = line.T
    return ManifoldArc(channel, image, read_only(x.copy()), read_only(-px))
