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
from engine.propagation.fates import Evidence
from engine.propagation.limited_steps import find_section_points, trace_section_points
from engine.propagation.tiles import run_tiles
from engine.systems.potential import Potential

# Smallest number of agreeing digits with which an orbit is tested with the next window.
_PROMISING_DIGITS = 3.5
# Largest cost of a test with a window that takes longer than the time left, as a share of the work left. Such a window is used
# for the few most promising orbits alone, because their curves can enclose other orbits.
_LARGEST_WORK_SHARE = 0.15
# Largest number of these most promising orbits in a round.
_MOST_SEEDS = 2 * LANES
# Distances in pixels between the orbits of successive rounds.
_LATTICE_STRIDES = (16, 8, 4, 2, 1)
# Smallest number of candidates on a coarse lattice; a round with fewer orbits would not keep all workers busy.
_SMALLEST_ROUND = 16
# Number of section points of an orbit for an invariant curve.
_CURVE_POINTS = 800
# Time to collect these points, in units of the well.
_CURVE_TIME = 8000.0
# Largest number of orbits of a round for which an invariant curve is computed.
_MOST_CURVES_PER_ROUND = 192
# Time to find the first section point of an orbit, in units of the well.
_FIRST_POINT_TIME = 30.0
# Largest number of points to which one worker applies barriers faster than several workers, which each need a copy of them.
_MOST_POINTS_OF_ONE_WORKER = 2000


class BoundedOrbitSearch:
    """Looks for evidence that undecided orbits of one map are bounded.

    Parameters
    ----------
    potential
        The `Potential` in units of its well.
    energy
        The energy of all orbits, in units of the well; None if the energies differ, as with an axis h. The invariant curves of
        an orbit do not bound orbits of other energies.
    states
        (n, 4) current states x, y, px, py, finite, in units of the well.
    grid_indices
        (n, 2) row and column of each orbit's pixel.
    time_left
        Time until the next test, or until t_max, in units of the well: the integration time that evidence saves.
    execution
        How the computation runs.
    tested_for
        `time_left` of an earlier test of the same orbits, whose windows are not used again; 0 without an earlier test.
    digits
        (n,) digits from the earlier test; None without an earlier test.

    Attributes
    ----------
    evidence
        (n,) int8 `Evidence` codes found so far.
    digits
        (n,) digits to which the averages over two consecutive windows agreed in the last test; infinite before the first test.
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
        self._uses_curves = bool(self._entry_points) and all(map(len, self._entry_points))
        if self._uses_curves:
            self._section_points = find_section_points(potential, states, 1, _FIRST_POINT_TIME, execution=self._execution)[:, 0]
            self._reaches_section = np.isfinite(self._section_points).all(axis=1)
            self._separated = np.zeros((len(states), len(self._entry_points)), bool)

    def run(self, on_round: Callable[[], None]) -> bool:
        """Find evidence for as many orbits as possible, and call `on_round` after each round of tests.

        Returns True if the search was completed, and False if it was cancelled.
        """
        for window, tested in self._rounds():
            if self._execution.is_cancelled:
                return False
            digits_of_two, digits_of_three = compare_averages(
                self.potential, self.states[tested], window, execution=self._execution
            ).T
            self.digits[tested] = digits_of_two
            self.evidence[tested[digits_of_three >= TORUS_DIGITS]] = Evidence.QUASI_PERIODIC
            if self._uses_curves:
                # Two averages suffice here, because the invariant curve is itself evidence of a torus.
                self._find_enclosed(tested[digits_of_two >= TORUS_DIGITS])
            on_round()
        return not self._execution.is_cancelled

    def _rounds(self) -> Iterator[tuple[float, np.ndarray]]:
        """Yield the window and the indices of the tested orbits of each round; orbits with evidence are left out."""
        for window in WINDOWS:
            is_promising = self.digits >= _PROMISING_DIGITS
            duration = 2.0 * window
            if self._tested_for < duration <= self._time_left:
                yield from ((window, tested) for tested in self._lattices(is_promising))
            elif duration > self._time_left and self._uses_curves:
                yield from ((window, tested) for tested in self._most_promising(is_promising, duration))

    def _lattices(self, is_candidate: np.ndarray) -> Iterator[np.ndarray]:
        """Yield groups of candidates, those on a coarse lattice first, because the curves of a few orbits can enclose many."""
        for stride in _LATTICE_STRIDES:
            on_lattice = np.all(self.grid_indices % stride == stride // 2, axis=1)
            group = np.flatnonzero(self._lacks_evidence() & is_candidate & on_lattice)
            if group.size >= _SMALLEST_ROUND or (stride == _LATTICE_STRIDES[-1] and group.size):
                yield group

    def _most_promising(self, is_candidate: np.ndarray, duration: float) -> Iterator[np.ndarray]:
        """Yield small groups of the candidates with the most digits, until a group costs more than it saves."""
        is_candidate = is_candidate.copy()
        while True:
            count_before = np.count_nonzero(self._lacks_evidence())
            most_affordable = int(_LARGEST_WORK_SHARE * count_before * self._time_left / duration) // LANES * LANES
            candidates = np.flatnonzero(self._lacks_evidence() & is_candidate)
            best_first = candidates[np.argsort(-self.digits[candidates], kind="stable")]
            group = best_first[: min(most_affordable, _MOST_SEEDS)]
            if not group.size:
                return
            is_candidate[group] = False
            yield group
            # The caller has tested the group.
            saved_count = count_before - np.count_nonzero(self._lacks_evidence())
            if saved_count * self._time_left < group.size * duration:
                return

    def _lacks_evidence(self) -> np.ndarray:
        """Return whether there is no evidence yet for each orbit, of shape (n,)."""
        return self.evidence == Evidence.NONE

    def _find_enclosed(self, torus_orbits: np.ndarray) -> None:
        """Mark all orbits that invariant curves enclose. The curves are those of some of `torus_orbits`, (k,) indices."""
        on_section = torus_orbits[self._reaches_section[torus_orbits]]
        seeds = on_section[:: max(1, math.ceil(on_section.size / _MOST_CURVES_PER_ROUND))]
        arguments = (self.potential.well.mirror_in_x, self._entry_points)
        tiles = run_tiles(_find_barriers, self.potential, self.states[seeds], *arguments, execution=self._execution)
        all_barriers = [barrier for _, tile_barriers in tiles for barrier in tile_barriers]
        if self._execution.is_cancelled:
            return
        barriers = _without_enclosed(all_barriers, self._section_points[seeds], self._separated[seeds])
        remaining = np.flatnonzero(self._reaches_section & ~self._separated.all(axis=1))
        if remaining.size <= _MOST_POINTS_OF_ONE_WORKER:
            self._separated[remaining] = _separated_by_any(barriers, self._section_points[remaining], self._separated[remaining])
        else:
            self._separate_in_parallel(barriers, remaining)
        self.evidence[self._separated.all(axis=1) & self._lacks_evidence()] = Evidence.ENCLOSED

    def _separate_in_parallel(self, barriers: list[_Barrier], orbits: np.ndarray) -> None:
        """Apply `_separated_by_any` to orbits, (k,) indices, in several workers."""
        # Prepared polygons must not be used by two threads at once, so each task unpickles its own copies.
        pickled_barriers = pickle.dumps(barriers)

        def select_arguments(part: np.ndarray) -> tuple[Any, ...]:
            return pickled_barriers, self._section_points[part], self._separated[part]

        for part, separated in run_parts(_separated_by_pickled, orbits, select_arguments, self._execution):
            self._separated[part] = separated


@dataclass(frozen=True, eq=False)
class _Barrier:
    """An invariant curve, with its mirror image if the potential has one.

    Attributes
    ----------
    curve
        The curve.
    exit_sides
        The side on which each exit lies, see `InvariantCurve.find_side`; 0 if the side is unknown. The key is 1.0 for the sides
        of the curve and −1.0 for those of its mirror image.
    """

    curve: InvariantCurve
    exit_sides: dict[float, np.ndarray]

    def find_separated(self, points: np.ndarray) -> np.ndarray:
        """Return whether the curve or its mirror image separates each point (n, 2) from each exit, of shape (n, channels)."""
        # Rotating the points by 180° is equivalent to rotating the curve into its mirror image.
        products = [self.curve.find_side(sign * points)[:, None] * exit_sides for sign, exit_sides in self.exit_sides.items()]
        # The product is −1 for a point and an exit on opposite sides.
        return np.any(np.equal(products, -1), axis=0)


def _find_barriers(
    potential: Potential, tile: np.ndarray, has_mirror_image: bool, entry_points: tuple[np.ndarray, ...]
) -> list[_Barrier | None]:
    """Return the barrier of each orbit in a tile (4, lanes), or None for an orbit without a curve; called in a worker."""
    barriers: list[_Barrier | None] = []
    for points in trace_section_points(potential, tile, _CURVE_POINTS, _CURVE_TIME):
        curve = find_invariant_curve(points[np.isfinite(points).all(axis=1)])
        barriers.append(None if curve is None else _Barrier(curve, _exit_sides(curve, has_mirror_image, entry_points)))
    return barriers


def _exit_sides(curve: InvariantCurve, has_mirror_image: bool, entry_points: tuple[np.ndarray, ...]) -> dict[float, np.ndarray]:
    """Return `_Barrier.exit_sides`: the side on which all entry points of an exit lie."""
    exit_sides = {}
    for sign in (1.0, -1.0) if has_mirror_image else (1.0,):
        entry_sides = [curve.find_side(sign * points) for points in entry_points]
        exit_sides[sign] = np.array([sides.min() if sides.min() == sides.max() else 0 for sides in entry_sides])
    return exit_sides


def _without_enclosed(barriers: list[_Barrier | None], points: np.ndarray, separated: np.ndarray) -> list[_Barrier]:
    """Return the barriers of the orbits at `points` (n, 2), except of orbits that barriers earlier in the result enclose.

    An orbit is enclosed if it is separated from all exits. `separated`, (n, channels), holds the separations of earlier rounds.
    """
    kept_barriers = []
    for index in _alternating_by_size([0.0 if barrier is None else barrier.curve.area for barrier in barriers]):
        barrier = barriers[index]
        if barrier is not None and not separated[index].all():
            kept_barriers.append(barrier)
            separated = separated | barrier.find_separated(points)
    return kept_barriers


def _separated_by_pickled(barriers: bytes, points: np.ndarray, separated: np.ndarray) -> np.ndarray:
    """Call `_separated_by_any` with pickled barriers; called in a worker."""
    return _separated_by_any(pickle.loads(barriers), points, separated)


def _separated_by_any(barriers: list[_Barrier], points: np.ndarray, separated: np.ndarray) -> np.ndarray:
    """Set `separated`, (n, channels), where a barrier separates a point (n, 2) from an exit, in place, and return it."""
    for barrier in barriers:
        remaining = np.flatnonzero(~separated.all(axis=1))
        separated[remaining] |= barrier.find_separated(points[remaining])
    return separated


def _alternating_by_size(sizes: list[float]) -> Iterator[int]:
    """Yield the indices of the largest size, the smallest, the second largest, …: the extremes of nested curves come first."""
    order = np.argsort(sizes, kind="stable")[::-1]
    for k in range(order.size):
        yield int(order[k // 2] if k % 2 == 0 else order[-1 - k // 2])
