"""Early certificates for the orbits of a map that have not left: quasi-periodic ones, and what their invariant curves enclose."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from typing import Any

import numpy as np

from engine.dynamics.batch import LANES
from engine.dynamics.certificates import Certificate
from engine.dynamics.section_points import find_section_points
from engine.invariant_sets.birkhoff_averages import CERTIFIED_DIGITS, WINDOWS, count_agreeing_digits
from engine.invariant_sets.exit_entry_points import find_entry_points
from engine.invariant_sets.invariant_curves import InvariantCurve, find_invariant_curve
from engine.potentials.potential import Potential

SHORTEST_T_MAX = 1e4
"""Below this t_max, following all orbits costs no more than certifying them."""

# To how many digits an orbit's averages over the window before must have agreed to make the next one worth trying.
_PROMISING = 3.5
# A window is tried on every promising orbit when it takes less than this share of the time still to be covered; a longer one only
# on the few most promising, for the sake of what their curves enclose, and only when that costs less than this share of all work.
_SHARE_OF_TIME, _SHARE_OF_WORK = 0.4, 0.1
_MOST_SEEDS = 2 * LANES
_STRIDES = (16, 8, 4, 2, 1)
# Section points of an orbit whose invariant curve is sought, for how long, and of how many such orbits a round.
_CURVE_POINTS = 800
_CURVE_TIME = 8000.0
_CURVES_A_ROUND = 192
_FIRST_POINT_TIME = 30.0


class BoundednessCertifier:
    """The certifying of the open orbits of one map, all of one energy or (on the (x, h) plane) of many.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        The common energy; None when orbits differ in it, and no curve of one is a wall for another.
    states
        (n, 4) the orbits now, all finite.
    place
        (n, 2) row and column of each.
    time_left
        How long each orbit would have to be followed otherwise: what a certificate saves.
    executor, cancel
        As everywhere.
    """

    def __init__(
        self,
        potential: Potential,
        energy: float | None,
        states: np.ndarray,
        place: np.ndarray,
        time_left: float,
        executor: Executor | None = None,
        cancel: threading.Event | None = None,
    ) -> None:
        self.potential, self.states, self.place = potential, states, place
        self._pool: dict[str, Any] = {"executor": executor, "cancel": cancel}
        self._cancel, self._time_left = cancel, time_left
        self.certificate = np.zeros(len(states), np.int8)
        self._digits = np.full(len(states), np.inf)
        self._entries = () if energy is None else find_entry_points(potential, energy)
        self._walls_help = bool(self._entries) and all(map(len, self._entries))
        if self._walls_help:
            self._points = find_section_points(potential, states, 1, _FIRST_POINT_TIME, **self._pool)[:, 0]
            self._parted = np.zeros((len(states), len(self._entries)), bool)

    def run(self, on_round: Callable[[], None]) -> None:
        """Certify what can be; `on_round` is called whenever some more may have been."""
        for window, chosen in self._rounds():
            if self._is_cancelled():
                return
            self._digits[chosen] = count_agreeing_digits(self.potential, self.states[chosen], window, **self._pool)
            certified = chosen[self._digits[chosen] >= CERTIFIED_DIGITS]
            self.certificate[certified] = Certificate.QUASI_PERIODIC
            if self._walls_help:
                self._build_walls(certified)
            on_round()

    def _rounds(self) -> Iterator[tuple[float, np.ndarray]]:
        """(window, orbits) of each round; what a round certifies is taken into account in the next."""
        for window in WINDOWS:
            promising = self._digits >= _PROMISING
            if 2.0 * window <= _SHARE_OF_TIME * self._time_left:
                yield from ((window, chosen) for chosen in self._lattices(promising))
            elif self._walls_help:
                yield from ((window, chosen) for chosen in self._seeds(promising, 2.0 * window))

    def _lattices(self, candidates: np.ndarray) -> Iterator[np.ndarray]:
        """All candidates, a coarse lattice first, so that the curves of few can enclose many."""
        for stride in _STRIDES:
            chosen = np.flatnonzero(self._open() & candidates & np.all(self.place % stride == stride // 2, axis=1))
            if chosen.size:
                yield chosen

    def _seeds(self, candidates: np.ndarray, duration: float) -> Iterator[np.ndarray]:
        """The most promising candidates, again and again while that saves more than it costs."""
        candidates = candidates.copy()
        while True:
            before = np.count_nonzero(self._open())
            affordable = int(_SHARE_OF_WORK * before * self._time_left / duration) // LANES * LANES
            waiting = np.flatnonzero(self._open() & candidates)
            best_first = waiting[np.argsort(-self._digits[waiting], kind="stable")]
            chosen = best_first[: min(affordable, _MOST_SEEDS)]
            if not chosen.size:
                return
            candidates[chosen] = False
            yield chosen
            saved = before - np.count_nonzero(self._open())
            if saved * self._time_left < chosen.size * duration:
                return

    def _is_cancelled(self) -> bool:
        return self._cancel is not None and self._cancel.is_set()

    def _open(self) -> np.ndarray:
        still_open: np.ndarray = self.certificate == Certificate.NONE
        return still_open

    def _build_walls(self, certified: np.ndarray) -> None:
        certified = certified[:: -(-certified.size // _CURVES_A_ROUND) or 1]
        points = find_section_points(self.potential, self.states[certified], _CURVE_POINTS, _CURVE_TIME, **self._pool)
        curves = [None if self._is_cancelled() else find_invariant_curve(p[np.isfinite(p).all(axis=1)]) for p in points]
        for number in _from_both_ends([0.0 if curve is None else curve.area for curve in curves]):
            if self._is_cancelled():
                return
            curve = curves[number]
            # Within walls already, a torus parts nothing more.
            if curve is not None and not self._parted[certified[number]].all():
                self._part(curve)
                if self.potential.mirror_in_x:
                    self._part(curve.mirrored())

    def _part(self, wall: InvariantCurve) -> None:
        """Note which open orbits a wall parts from which exits, and certify those parted from all."""
        exits = [wall.find_side(points) for points in self._entries]
        sides = np.array([side.min() if side.min() == side.max() else 0 for side in exits])
        orbits = np.flatnonzero(~self._parted.all(axis=1) & np.isfinite(self._points).all(axis=1))
        own = wall.find_side(self._points[orbits])
        self._parted[orbits] |= own[:, None] * sides == -1
        enclosed = self._parted.all(axis=1) & self._open()
        self.certificate[enclosed] = Certificate.ENCLOSED


def _from_both_ends(sizes: list[float]) -> Iterator[int]:
    """Numbers by size: the largest, the smallest, the second largest, …; of nested curves the outer and inner ones come first."""
    order = np.argsort(sizes, kind="stable")[::-1]
    for k in range(order.size):
        yield int(order[k // 2] if k % 2 == 0 else order[-1 - k // 2])
