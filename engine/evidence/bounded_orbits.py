"""Evidence that orbits of a map are bounded: quasi-periodic orbits, and orbits enclosed by their invariant curves."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.evidence.birkhoff_averages import TORUS_DIGITS, WINDOWS, compare_averages
from engine.evidence.exit_entry_points import find_entry_points
from engine.evidence.invariant_curves import InvariantCurve, find_invariant_curve
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, run_parts
from engine.integrator.source.recurrence import LANES
from engine.propagation.evidence import Evidence
from engine.propagation.fixed_step_batches import run_tiles
from engine.propagation.section_points import find_section_points, trace_section_points
from engine.systems.potential import Potential

# An orbit is tested with the next window if its averages over the previous window agreed to at least this many digits.
_PROMISING_DIGITS = 3.5
# A window that takes longer than the time left is used for the few most promising orbits alone, because their curves can enclose
# other orbits, and only if the test costs less than this share of the work left.
_MAX_WORK_SHARE = 0.15
# Largest number of these orbits in a round.
_MAX_SEEDS = 2 * LANES
# Distances in pixels between the orbits of successive rounds.
_LATTICE_STRIDES = (16, 8, 4, 2, 1)
# A coarse lattice with fewer candidates is skipped, because a round with few orbits does not keep all workers busy.
_SMALLEST_ROUND = 16
# Section points per orbit for an invariant curve.
_CURVE_POINTS = 800
# Time to collect these points, dimensionless.
_CURVE_TIME = 8000.0
# Orbits per round for which an invariant curve is computed.
_MAX_CURVES_PER_ROUND = 192
# Time to find the first section point of an orbit, dimensionless.
_FIRST_POINT_TIME = 30.0
# With at most this many points, sharing barriers among workers takes longer than applying them.
_FEW_POINTS = 2000


class BoundedOrbitSearch:
    """Looks for evidence that undecided orbits of one map are bounded. They have one energy or, with an axis h, several.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        The energy of all orbits; None if the energies differ, in which case the invariant curves of one orbit do not bound
        another.
    states
        (n, 4) current states x, y, px, py, finite.
    grid_indices
        (n, 2) row and column of each orbit's pixel.
    time_left
        Time until the next test, or until t_max, dimensionless: the integration that evidence saves.
    execution
        How the computation runs.
    tested_for
        `time_left` of an earlier test of the same orbits, whose windows are not used again; 0 if there was no earlier test.
    digits
        (n,) digits found by the earlier test; None if there was no earlier test.

    Attributes
    ----------
    evidence
        (n,) int8 `Evidence` codes found so far.
    digits
        (n,) digits to which the averages over two windows agree, for the longest windows tested; infinite before the first test.
    """

    def __init__(
        self,
        potential: Potential,
        energy: float | None,
        states: np.ndarray,
        grid_indices: np.ndarray,
        time_left: float,
        execution: Execution = DEFAULT_EXECUTION,
        *,
        tested_for: float = 0.0,
        digits: np.ndarray | None = None,
    ) -> None:
        self.potential, self.states, self.grid_indices = potential, states, grid_indices
        self._execution, self._time_left, self._tested_for = execution, time_left, tested_for
        self.evidence = np.zeros(len(states), np.int8)
        self.digits = np.full(len(states), np.inf) if digits is None else digits.copy()
        self._entry_points = () if energy is None else find_entry_points(potential, energy)
        self._use_curves = bool(self._entry_points) and all(map(len, self._entry_points))
        if self._use_curves:
            self._points = find_section_points(potential, states, 1, _FIRST_POINT_TIME, execution=self._execution)[:, 0]
            self._on_section = np.isfinite(self._points).all(axis=1)
            self._separated = np.zeros((len(states), len(self._entry_points)), bool)

    def run(self, on_round: Callable[[], None]) -> bool:
        """Find evidence for as many orbits as possible; `on_round` is called after each round of tests.

        Returns whether the test was completed; False if it was cancelled.
        """
        for window, tested in self._rounds():
            if self._execution.is_cancelled:
                return False
            two, three = compare_averages(self.potential, self.states[tested], window, execution=self._execution).T
            self.digits[tested] = two
            self.evidence[tested[three >= TORUS_DIGITS]] = Evidence.QUASI_PERIODIC
            if self._use_curves:
                # Two averages suffice here, because the invariant curve is itself evidence of a torus.
                self._find_enclosed(tested[two >= TORUS_DIGITS])
            on_round()
        return not self._execution.is_cancelled

    def _rounds(self) -> Iterator[tuple[float, np.ndarray]]:
        """Yield (window, orbits) for each round; orbits for which a round finds evidence are left out of the next round."""
        for window in WINDOWS:
            promising = self.digits >= _PROMISING_DIGITS
            duration = 2.0 * window
            if self._tested_for < duration <= self._time_left:
                yield from ((window, tested) for tested in self._lattices(promising))
            elif duration > self._time_left and self._use_curves:
                yield from ((window, tested) for tested in self._most_promising(promising, duration))

    def _lattices(self, candidates: np.ndarray) -> Iterator[np.ndarray]:
        """Yield groups of candidates, a coarse lattice first, because the curves of a few orbits can enclose many others."""
        for stride in _LATTICE_STRIDES:
            on_lattice = np.all(self.grid_indices % stride == stride // 2, axis=1)
            tested = np.flatnonzero(self._without_evidence() & candidates & on_lattice)
            if tested.size >= _SMALLEST_ROUND or (stride == _LATTICE_STRIDES[-1] and tested.size):
                yield tested

    def _most_promising(self, candidates: np.ndarray, duration: float) -> Iterator[np.ndarray]:
        """Yield small groups of the candidates with the most digits, until a group costs more than it saves."""
        candidates = candidates.copy()
        while True:
            before = np.count_nonzero(self._without_evidence())
            affordable = int(_MAX_WORK_SHARE * before * self._time_left / duration) // LANES * LANES
            remaining = np.flatnonzero(self._without_evidence() & candidates)
            best_first = remaining[np.argsort(-self.digits[remaining], kind="stable")]
            tested = best_first[: min(affordable, _MAX_SEEDS)]
            if not tested.size:
                return
            candidates[tested] = False
            yield tested
            saved = before - np.count_nonzero(self._without_evidence())
            if saved * self._time_left < tested.size * duration:
                return

    def _without_evidence(self) -> np.ndarray:
        """Return whether each orbit is without evidence, of shape (n,)."""
        without_evidence: np.ndarray = self.evidence == Evidence.NONE
        return without_evidence

    def _find_enclosed(self, regular: np.ndarray) -> None:
        """Mark orbits enclosed by the invariant curves of some of the given orbits."""
        regular = regular[self._on_section[regular]]
        step = max(1, math.ceil(regular.size / _MAX_CURVES_PER_ROUND))
        regular = regular[::step]
        arguments = (self.potential.well.mirror_in_x, self._entry_points)
        tiles = run_tiles(_find_barriers, self.potential, self.states[regular], *arguments, execution=self._execution)
        found = [barrier for _, tile in tiles for barrier in tile]
        if self._execution.is_cancelled:
            return
        barriers = _without_enclosed(found, self._points[regular], self._separated[regular])
        left = np.flatnonzero(self._on_section & ~self._separated.all(axis=1))
        if left.size <= _FEW_POINTS:
            self._separated[left] = _separated_by_any(barriers, self._points[left], self._separated[left])
        else:
            self._separate_in_parallel(barriers, left)
        self.evidence[self._separated.all(axis=1) & self._without_evidence()] = Evidence.ENCLOSED

    def _separate_in_parallel(self, barriers: list[_Barrier], orbits: np.ndarray) -> None:
        # Prepared polygons must not be used by two threads at once: each task unpickles its own copies.
        pickled = pickle.dumps(barriers)

        def select(part: np.ndarray) -> tuple[Any, ...]:
            return pickled, self._points[part], self._separated[part]

        for part, separated in run_parts(_separated_by_pickled, orbits, select, self._execution):
            self._separated[part] = separated


@dataclass(frozen=True, eq=False)
class _Barrier:
    """An invariant curve, with its mirror image if the potential has one.

    Attributes
    ----------
    curve
        The curve.
    exit_sides
        The side of the curve on which each exit lies, see `InvariantCurve.find_side`; 0 if the side is unknown. The key is 1.0
        for the curve and −1.0 for its mirror image.
    """

    curve: InvariantCurve
    exit_sides: dict[float, np.ndarray]

    def find_separated(self, points: np.ndarray) -> np.ndarray:
        """Return whether the curve or its mirror image separates each point (n, 2) from each exit, of shape (n, channels)."""
        # Rotating the points by 180° is equivalent to rotating the curve into its mirror image.
        sides = [self.curve.find_side(sign * points)[:, None] * exit_side for sign, exit_side in self.exit_sides.items()]
        separated: np.ndarray = np.any(np.equal(sides, -1), axis=0)
        return separated


def _find_barriers(
    potential: Potential, tile: np.ndarray, mirror: bool, entry_points: tuple[np.ndarray, ...]
) -> list[_Barrier | None]:
    """Return the barrier of each orbit in a tile (4, lanes), or None for an orbit without a curve; runs in a worker."""
    barriers: list[_Barrier | None] = []
    for points in trace_section_points(potential, tile, _CURVE_POINTS, _CURVE_TIME):
        curve = find_invariant_curve(points[np.isfinite(points).all(axis=1)])
        barriers.append(None if curve is None else _Barrier(curve, _exit_sides(curve, mirror, entry_points)))
    return barriers


def _exit_sides(curve: InvariantCurve, mirror: bool, entry_points: tuple[np.ndarray, ...]) -> dict[float, np.ndarray]:
    exit_sides = {}
    for sign in (1.0, -1.0) if mirror else (1.0,):
        entry_sides = [curve.find_side(sign * points) for points in entry_points]
        exit_sides[sign] = np.array([sides.min() if sides.min() == sides.max() else 0 for sides in entry_sides])
    return exit_sides


def _without_enclosed(barriers: list[_Barrier | None], points: np.ndarray, separated: np.ndarray) -> list[_Barrier]:
    """Return the barriers of the orbits (n, 2) that the preceding barriers do not separate from all exits."""
    kept = []
    for number in _alternating_by_size([0.0 if barrier is None else barrier.curve.area for barrier in barriers]):
        barrier = barriers[number]
        if barrier is not None and not separated[number].all():
            kept.append(barrier)
            separated = separated | barrier.find_separated(points)
    return kept


def _separated_by_pickled(barriers: bytes, points: np.ndarray, separated: np.ndarray) -> np.ndarray:
    """Call `_separated_by_any` with pickled barriers, in a worker."""
    return _separated_by_any(pickle.loads(barriers), points, separated)


def _separated_by_any(barriers: list[_Barrier], points: np.ndarray, separated: np.ndarray) -> np.ndarray:
    """Mark in `separated`, (n, channels), from which exits any barrier separates each point (n, 2)."""
    for barrier in barriers:
        left = np.flatnonzero(~separated.all(axis=1))
        separated[left] |= barrier.find_separated(points[left])
    return separated


def _alternating_by_size(sizes: list[float]) -> Iterator[int]:
    """Yield the indices of the largest, smallest, second largest size, …, so that the extremes of nested curves come first."""
    order = np.argsort(sizes, kind="stable")[::-1]
    for k in range(order.size):
        yield int(order[k // 2] if k % 2 == 0 else order[-1 - k // 2])
