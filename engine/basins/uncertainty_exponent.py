"""The uncertainty exponent of exit basins, from pairs of starts followed anew: it sees as far below a pixel as numbers reach."""

from __future__ import annotations

import numbers
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import replace
from functools import partial

import numpy as np

from engine.basins.power_law_fit import LEAST_EXPECTED, UncertaintyExponent, fit_uncertainty, predict_shares
from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.certificates import Certificate
from engine.dynamics.fates import Fate
from engine.dynamics.lyapunov_orbits import closed_curves, exit_curves
from engine.dynamics.planes import Plane
from engine.maps.spec import MapSpec
from engine.validation import read_count, shown

__all__ = ["HORIZON", "UncertaintyExponent", "compute_uncertainty_exponent", "fit_uncertainty"]

HORIZON = 1e4
"""Pairs are followed no longer than this: going on to t = 1e5 moved the exponents of I (h = 0.15), II (0.17), III (0.45) within
their intervals only.

To t = 1000 alone, the exponent of I at h = 0.15 came out 0.02 too high: the sea that leaks slowly looks like an island.
"""

SMALLEST_SEPARATION = 1e-10
"""The least distance of two starts, unless the pixels themselves are not far above it."""

WORK = 1.5e8
"""Time units that all orbits together may be followed for, unless otherwise said: some seconds of work."""

# In a deep zoom: so far below a pixel, but no closer than some hundred units in the last place of coordinates of order 1.
_DECADES_BELOW_PIXEL, _CLOSEST = 4.0, 1e-13
_MOST_SEPARATIONS, _MOST_PAIRS = 100, 100_000
# At first each separation has as many pairs as asked for; then more, until the law expects this many uncertain ones, which tells
# a share to 7 %, but at most this many times as many pairs; and no more orbits than can be followed in some seconds.
_WANTED_UNCERTAIN, _LARGEST_GROWTH = 200, 2000
# What a pair costs besides following it, in time units that could be followed instead.
_PAIR_COST = 20.0
_CHUNK = 2**17
# Of many orbits few stay as long as this.
_STAGES = (30.0, 300.0)
# Of the points drawn in a window, the least share in the interior that is worth going on with.
_LEAST_YIELD = 1e-3


def compute_uncertainty_exponent(
    spec: MapSpec,
    *,
    pairs: int = 200,
    separations: int = 17,
    work: float = WORK,
    seed: int = 0,
    on_progress: Callable[[float], None] | None = None,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> UncertaintyExponent:
    """Find how fast the share of uncertain starts falls with the error ε of a start, and with it the dimension of the boundary.

    A start is ε-uncertain when one at the distance ε leaves elsewhere. Their share falls as f(ε) ~ ε^α, and the boundary has the
    dimension 2 − α in the plane of starts (Grebogi, McDonald, Ott & Yorke 1983, Phys. Lett. A 99, 415; McDonald, Grebogi, Ott &
    Yorke 1985, Physica D 17, 125). Each ε has its own random pairs: the first start is uniform over the interior of the window,
    the second stands at the distance ε in a random direction of the plane; on (x, h) both have the energy of a row of pixels, and
    the second is displaced along x. Pairs of which one is forbidden or outside are drawn again.

    Orbits are followed to min(t_max, `HORIZON`), and being inside then is a fate like a channel. `UncertaintyExponent.one_inside`
    and `both_inside` count the pairs that this may have decided; without these, ``fit_uncertainty(separations, pairs − one_inside
    − both_inside, uncertain − one_inside)`` is the exponent of the basins of those that leave.

    Where few pairs are uncertain more are followed, as the law that fits the first ones asks for, within a fixed amount of work.

    Parameters
    ----------
    spec
        Plane, energy, window, direction of time and t_max; its resolution sets the largest ε, the shorter side of a pixel. The
        smallest is 1e-10; in a deep zoom, four decades below a pixel, but not below 1e-13.
    pairs
        How many pairs there are at each separation at first, 10 to 100 000.
    separations
        How many values of ε, evenly spaced on a logarithmic scale, 5 to 100.
    work
        Time units that all orbits together may be followed for, above 0; but no fewer than the first pairs take.
    seed
        Of the random numbers, 0 or more: the same one, the same result, to the bit.
    on_progress
        Called in this thread with the share of the work that is done, rising to 1.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process. The result does not depend on it.
    cancel
        When set, the work stops within about 0.2 s.

    Returns
    -------
    The `UncertaintyExponent`, as `fit_uncertainty` finds it.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range, or the pixels are too small to put starts below them.
    """
    pairs = read_count("pairs", pairs, 10, _MOST_PAIRS)
    separations = read_count("separations", separations, 5, _MOST_SEPARATIONS)
    seed = read_count("seed", seed, 0, 2**63 - 1)
    given: object = work
    if not isinstance(given, numbers.Real) or not work > 0.0:
        raise ValueError(f"work={shown(work)}: must be above 0")
    report = on_progress or (lambda share: None)
    survey = _Survey(spec, _separations(spec, separations), seed, executor, cancel)
    survey.follow(np.full(separations, pairs), lambda share: report(0.5 * share))
    survey.follow(survey.plan(work), lambda share: report(0.5 + 0.5 * share))
    report(1.0)
    return survey.result()


def _report_part(report: Callable[[float], None], done: int, parts: int, share: float) -> None:
    report((done + share) / parts)


def _separations(spec: MapSpec, count: int) -> np.ndarray:
    """(count,) ε, falling from the side of a pixel."""
    window, (columns, rows) = spec.window, spec.resolution
    pixel = (window.x_high - window.x_low) / columns
    if spec.plane is not Plane.X_H:
        pixel = min(pixel, (window.ordinate_high - window.ordinate_low) / rows)
    smallest = max(min(SMALLEST_SEPARATION, pixel * 10.0**-_DECADES_BELOW_PIXEL), _CLOSEST)
    if pixel < 100.0 * smallest:
        raise ValueError(
            f"window={window}: double precision ends here; pixels of {pixel:.0e} leave no room for starts below them"
        )
    return np.geomspace(pixel, smallest, count)


class _Survey:
    """The pairs followed so far, as counts for each of the separations (m,)."""

    def __init__(
        self,
        spec: MapSpec,
        separations: np.ndarray,
        seed: int,
        executor: Executor | None,
        cancel: threading.Event | None,
    ) -> None:
        self.spec, self.separations = spec, separations
        self.executor, self.cancel = executor, cancel
        self.horizon = min(spec.t_max, HORIZON)
        self.random = [np.random.default_rng([seed, number]) for number in range(separations.size)]
        self.pairs, self.uncertain, self.one_inside, self.both_inside = np.zeros((4, separations.size), np.int64)
        self.time = 0.0
        self.row_energy = spec.pixel_centres()[1] if isinstance(spec.energy, tuple) else np.array([spec.energy])
        self.open = self.row_energy > spec.potential.escape_energy
        self.curves = self._find_curves()

    def _find_curves(self) -> np.ndarray:
        """The exits at each energy."""
        curves = np.repeat(closed_curves(self.spec.potential)[None], self.row_energy.size, axis=0)
        for row in np.flatnonzero(self.open):
            self._stop_if_cancelled()
            curves[row] = exit_curves(self.spec.potential, float(self.row_energy[row]))
        return curves

    def _stop_if_cancelled(self) -> None:
        if self.cancel is not None and self.cancel.is_set():
            raise CancelledError

    def plan(self, work: float) -> np.ndarray:
        """(m,) how many more pairs to follow."""
        if not self.uncertain.any() or np.any(self.uncertain == self.pairs):
            return np.zeros_like(self.pairs)
        if np.count_nonzero(self.uncertain) > 1:
            share = predict_shares(self.separations, self.pairs, self.uncertain)
        else:
            # Too few to tell a law: the boundary may be smooth.
            share = self.uncertain.max() / self.pairs.max() * self.separations / self.separations[0]
        most = _LARGEST_GROWTH * self.pairs
        wanted = np.clip(_WANTED_UNCERTAIN / share, self.pairs, most) - self.pairs
        # Where even the most would not make the separation count, more are in vain.
        wanted[share * most < LEAST_EXPECTED] = 0.0
        cost = _PAIR_COST + self.time / self.pairs.sum()
        affordable = max(work / cost - self.pairs.sum(), 0.0)
        more: np.ndarray = (wanted * min(1.0, affordable / max(wanted.sum(), 1.0))).astype(np.int64)
        return more

    def follow(self, wanted: np.ndarray, report: Callable[[float], None]) -> None:
        """Draw and follow `wanted` (m,) more pairs."""
        numbers = np.repeat(np.arange(wanted.size), wanted)
        chunks = np.split(numbers, range(_CHUNK, numbers.size, _CHUNK)) if numbers.size else []
        for done, chunk in enumerate(chunks):
            batch, number = self._draw_chunk(np.bincount(chunk, minlength=wanted.size))
            self._carry_on(batch, partial(_report_part, report, done, len(chunks)))
            self.time += float(batch.t.sum())
            self._count(number, *batch.fate.reshape(2, -1))

    def _draw_chunk(self, wanted: np.ndarray) -> tuple[OrbitBatch, np.ndarray]:
        """The orbits of `wanted` (m,) pairs, first starts before second ones, and the number of each pair's separation."""
        present = np.flatnonzero(wanted)
        drawn = [self._draw(number, int(wanted[number])) for number in present.tolist()]
        states = np.concatenate([states for states, _ in drawn], axis=1).reshape(-1, 4)
        rows = np.concatenate([rows for _, rows in drawn])
        batch = OrbitBatch.from_starts(states, np.tile(rows, 2))
        batch.settle(np.flatnonzero(~self.open[batch.curve_row]), Certificate.CLOSED)
        return batch, np.repeat(present, [rows.size for _, rows in drawn])

    def _carry_on(self, batch: OrbitBatch, report: Callable[[float], None]) -> None:
        """Follow all orbits, stage by stage, so that the few that stay long share tiles."""

        def tell() -> None:
            report(float(np.mean(np.where(batch.fate == Fate.NOT_COMPUTED, batch.t / self.horizon, 1.0))))

        everything = np.arange(batch.fate.size)
        for horizon in (*(stage for stage in _STAGES if stage < self.horizon), self.horizon):
            propagate_batch(
                self.spec.potential, self.curves, batch, everything, horizon,
                final=horizon == self.horizon, executor=self.executor, cancel=self.cancel, on_progress=tell,
            )  # fmt: skip
            self._stop_if_cancelled()

    def _count(self, number: np.ndarray, first: np.ndarray, second: np.ndarray) -> None:
        inside = (first == Fate.BOUNDED).astype(int) + (second == Fate.BOUNDED)
        followed = (first >= Fate.BOUNDED) & (second >= Fate.BOUNDED)
        for counts, which in (
            (self.pairs, followed),
            (self.uncertain, followed & (first != second)),
            (self.one_inside, followed & (inside == 1)),
            (self.both_inside, followed & (inside == 2)),
        ):
            counts += np.bincount(number[which], minlength=counts.size)

    def _draw(self, number: int, count: int) -> tuple[np.ndarray, np.ndarray]:
        """(2, count, 4) states of pairs at one separation and (count,) rows of their energies; fewer where hardly any exist."""
        states, rows = np.zeros((2, 0, 4)), np.zeros(0, np.int64)
        drawn = 0
        while rows.size < count and drawn * _LEAST_YIELD < rows.size + 10:
            self._stop_if_cancelled()
            size = 2 * (count - rows.size) + 100
            more, more_rows = self._draw_some(number, size)
            states, rows = np.concatenate([states, more], axis=1), np.concatenate([rows, more_rows])
            drawn += size
        return states[:, :count], rows[:count]

    def _draw_some(self, number: int, size: int) -> tuple[np.ndarray, np.ndarray]:
        """The interior ones among `size` pairs anywhere in the window."""
        window, random = self.spec.window, self.random[number]
        x = random.uniform(window.x_low, window.x_high, size)
        if self.spec.plane is Plane.X_H:
            rows = random.integers(0, self.row_energy.size, size)
            ordinate, angle = self.row_energy[rows], np.pi * random.integers(0, 2, size)
        else:
            rows = np.zeros(size, np.int64)
            ordinate, angle = (
                random.uniform(window.ordinate_low, window.ordinate_high, size),
                random.uniform(0.0, 2.0 * np.pi, size),
            )
        shift = self.separations[number] * np.array([np.cos(angle), np.sin(angle)])
        if self.spec.plane is Plane.X_H:
            shift[1] = 0.0
        points = np.concatenate([[x, ordinate], [x + shift[0], ordinate + shift[1]]], axis=1)
        batch = OrbitBatch.from_starts(self.spec.start_states(*points), np.tile(rows, 2))
        batch.mark_outside(np.arange(2 * size), self.curves)
        inside = (batch.fate == Fate.NOT_COMPUTED).reshape(2, -1).all(axis=0)
        return batch.state.reshape(2, -1, 4)[:, inside], rows[inside]

    def result(self) -> UncertaintyExponent:
        """The exponent from all pairs so far."""
        for counts in (self.one_inside, self.both_inside):
            counts.flags.writeable = False
        fit = fit_uncertainty(self.separations, self.pairs, self.uncertain)
        return replace(fit, one_inside=self.one_inside, both_inside=self.both_inside, horizon=self.horizon)
