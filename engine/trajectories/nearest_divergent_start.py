"""The nearest start that leaves elsewhere: how far apart two orbits may begin and still share an exit."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass

import numpy as np

from engine.dynamics.classification import classify_orbits
from engine.dynamics.fates import Fate
from engine.dynamics.planes import Plane, start_states
from engine.potentials.potential import Potential
from engine.validation import read_number, read_t_max

# Some hundred units in the last place of coordinates of order 1.
_NEAREST = 1e-13
_DIRECTIONS = 16
_STARTS_PER_DECADE = 80
# Looked at together, from the inside out: an orbit that leaves late has its twin on the first rings, and the many neighbours
# further out, some of which stay far longer, need not be followed.
_STARTS_AT_ONCE = 128
# Twice as many sections bring the distance between two rings, at most a factor of 1.6, below a hundredth.
_ROUNDS = 2
_SECTIONS = 10
# How long neighbours are followed: this many times the escape time of the orbit itself, and no less than the time after it.
_PATIENCE = 3.0
_SHORTEST_HORIZON = 1000.0


@dataclass(frozen=True)
class Twin:
    """A neighbouring start on the same plane whose orbit leaves elsewhere; lengths are dimensionless.

    Attributes
    ----------
    x, ordinate
        Where it starts.
    distance
        From the start it is the twin of, in the plane.
    fate
        The channel through which it leaves, k ≥ 1.
    first_fate
        Another channel, or the `Fate`, of the orbit it is the twin of.
    """

    x: float
    ordinate: float
    distance: float
    fate: int
    first_fate: int


def find_twin(
    potential: Potential,
    plane: Plane,
    energy: float | tuple[float, float],
    x: float,
    ordinate: float,
    t_max: float = 1e5,
    *,
    furthest: float = 1.0,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Twin | None:
    """The nearest neighbour of a start that leaves through another channel, or that leaves at all if the start is bounded.

    Neighbours stand on rings around the start, in 16 directions on rings that grow by a factor of 1.6; on (x, h) in the two
    directions that keep the energy, by a factor of 1.06. Between the first ring with a twin and the one before, the distance is
    narrowed down to a hundredth along the directions of that ring. A basin so thin that it lies between rings or directions is
    missed.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        Plane of initial conditions.
    energy
        h, finite, dimensionless; for (x, h) ignored: there the ordinate is the energy.
    x, ordinate
        The start, interior to the plane.
    t_max
        How long its orbit is followed, 0 < t_max ≤ 1e8. Neighbours are followed for 1000 or, if it escapes, for three times its
        escape time, whichever is longer, but not beyond t_max; one still inside by then is no twin.
    furthest
        Largest distance to look at, above 1e-13, finite.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, the work stops within about 0.1 s.

    Returns
    -------
    The twin; None when no neighbour within `furthest` leaves elsewhere. At a distance of 1e-13 it may be nearer still.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range, or the start is forbidden or outside.
    """
    t_max = read_t_max(t_max)
    if not read_number("furthest", furthest, f"a finite number above {_NEAREST:g}") > _NEAREST:
        raise ValueError(f"furthest={furthest}: must be a finite number above {_NEAREST:g}")
    plane = Plane(plane)
    h = _checked_energy(plane, energy, x, ordinate)
    search = _Search(potential, plane, h, np.array([x, ordinate], dtype=float), executor, cancel)
    search.follow_the_first(t_max)
    if search.first in (Fate.FORBIDDEN, Fate.OUTSIDE):
        raise ValueError(
            f"x={x}, {plane.ordinate}={ordinate}: {Fate(search.first).name.lower()} on {plane.value} at h={h}; "
            f"must have V + px²/2 ≤ h and lie inside every Lyapunov orbit"
        )
    return search.find_nearest(furthest)


def _checked_energy(plane: Plane, energy: float | tuple[float, float], x: float, ordinate: float) -> float:
    """h of the start."""
    for name, value in (("x", x), (plane.ordinate, ordinate)):
        read_number(name, value)
    if plane is Plane.X_H:
        return float(ordinate)
    return read_number("energy", energy, f"one finite number on {plane.value}")


@dataclass(frozen=True, eq=False)
class _Bracket:
    """Radii between which twins begin along some directions (m, 2): none at `low`, at `high` through these channels (m,)."""

    low: float
    high: float
    directions: np.ndarray
    channels: np.ndarray


class _Search:
    """The starts of energy `h` around `centre` (2,), and what became of the first of all."""

    def __init__(
        self,
        potential: Potential,
        plane: Plane,
        h: float,
        centre: np.ndarray,
        executor: Executor | None,
        cancel: threading.Event | None,
    ) -> None:
        self.potential, self.plane, self.h, self.centre = potential, plane, h, centre
        self.executor, self.cancel = executor, cancel

    def follow_the_first(self, t_max: float) -> None:
        """Find its fate, and from that how long to follow its neighbours."""
        fate, escape_time = self.classify(self.centre[None], t_max)
        self.first = int(fate[0])
        patience = _PATIENCE * escape_time[0] if self.first >= 1 else 0.0
        self.horizon = min(t_max, max(_SHORTEST_HORIZON, patience))

    def find_nearest(self, furthest: float) -> Twin | None:
        """The nearest start that leaves elsewhere, from the inside out."""
        directions = _directions(self.plane)
        brackets = (self.look(radii, directions) for radii in _rings(furthest, len(directions)))
        bracket = next(filter(None, brackets), None)
        if bracket is None:
            return None
        for _ in range(_ROUNDS if bracket.high > _NEAREST else 0):
            bracket = self.look(np.linspace(bracket.low, bracket.high, _SECTIONS + 1), bracket.directions) or bracket
        x, ordinate = (self.centre + bracket.high * bracket.directions[0]).tolist()
        distance = float(np.hypot(*(self.centre - [x, ordinate])))
        return Twin(x, ordinate, distance, int(bracket.channels[0]), self.first)

    def look(self, radii: np.ndarray, directions: np.ndarray) -> _Bracket | None:
        """The smallest of the rising radii with a twin, the first of which is known to have none."""
        fate = self.classify(self.centre + radii[1:, None, None] * directions, self.horizon)[0]
        elsewhere = (fate >= 1) & (fate != self.first)
        if not elsewhere.any():
            return None
        ring = int(np.argmax(elsewhere.any(axis=1)))
        which = elsewhere[ring]
        return _Bracket(float(radii[ring]), float(radii[ring + 1]), directions[which], fate[ring, which])

    def classify(self, points: np.ndarray, t_max: float) -> tuple[np.ndarray, np.ndarray]:
        """Fates and escape times (…) of points (…, 2)."""
        x, ordinate = points.reshape(-1, 2).T
        states = start_states(self.potential, self.plane, self.h, x, ordinate)
        exists = np.isfinite(states).all(axis=1)
        outcomes = classify_orbits(self.potential, self.h, states[exists], t_max, executor=self.executor, cancel=self.cancel)
        if self.cancel is not None and self.cancel.is_set():
            raise CancelledError
        fate, escape_time = np.full(x.size, Fate.FORBIDDEN, np.int8), np.full(x.size, np.nan)
        fate[exists], escape_time[exists] = outcomes.fate, outcomes.escape_time
        return fate.reshape(points.shape[:-1]), escape_time.reshape(points.shape[:-1])


def _directions(plane: Plane) -> np.ndarray:
    """(m, 2) unit vectors; on (x, h) all neighbours keep the energy of the start."""
    if plane is Plane.X_H:
        return np.array([[1.0, 0.0], [-1.0, 0.0]])
    angle = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    # Rounded, so that the neighbours of mirror images are mirror images.
    return np.round(np.column_stack([np.cos(angle), np.sin(angle)]), 12)


def _rings(furthest: float, directions: int) -> Iterator[np.ndarray]:
    """Radii, rising evenly on a logarithmic scale, some at a time; each time the last one of before comes first."""
    count = int(np.ceil(_STARTS_PER_DECADE / directions * np.log10(furthest / _NEAREST))) + 1
    radii = np.concatenate([[0.0], np.geomspace(_NEAREST, furthest, count)])
    together = _STARTS_AT_ONCE // directions
    yield from (radii[begin : begin + together + 1] for begin in range(0, count, together))
