"""Which pixels of a map to trust: those that survive a change far smaller than a pixel, and another tolerance."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.certificates import Certificate
from engine.dynamics.fates import Fate, Trust
from engine.dynamics.lyapunov_orbits import closed_curves, exit_curves
from engine.dynamics.planes import Plane, find_mirror_images
from engine.execution import is_cancelled
from engine.invariant_sets.boundedness_certifier import SHORTEST_T_MAX, BoundednessCertifier
from engine.maps.result import EscapeMap
from engine.maps.run import CERTIFIED_FROM
from engine.maps.spec import FINEST_PIXEL, MapSpec
from engine.taylor.source.recurrence import TOLERANCE

SHIFT = 1e-11
"""How far a start is moved along x and along the ordinate: well above all rounding, well below any pixel of a whole map."""

LARGEST_SHARE_OF_PIXEL = 0.01
"""In a deep zoom a start is moved by no more than this share of its pixel."""

SECOND_TOLERANCE = 10.0 * TOLERANCE
"""Steps a sixth longer, whose errors have nothing in common with those of the map."""

# The first stretch of time; each one doubles the last, so that an orbit is hardly followed beyond what its pixel asks for, and
# one of them ends where certificates begin to pay.
_FIRST_HORIZON = CERTIFIED_FROM / 8.0
# A row and column on the coarsest lattice of `BoundednessCertifier`.
# The bounded pixels to test are few and stand around islands: tried
# all at once they fill the lanes, lattice by lattice they do not.
_ON_COARSEST_LATTICE = 8


@dataclass(frozen=True, eq=False)
class TrustMap:
    """Which pixels of a map to trust, finished or on the way.

    Attributes
    ----------
    spec
        The map's request.
    trust
        (rows, columns) int8 `Trust` codes, read-only.
    complete
        Whether every pixel that asks for a test has had it.
    """

    spec: MapSpec
    trust: np.ndarray
    complete: bool

    @property
    def nbytes(self) -> int:
        """Bytes held by the array."""
        return self.trust.nbytes

    @property
    def doubtful_share(self) -> float:
        """Share of doubtful pixels among all that have an answer; NaN when there are none."""
        return self._share(Trust.DOUBTFUL)

    @property
    def tested_share(self) -> float:
        """Share of the pixels tested so far among all that have an answer; NaN when there are none."""
        return self._share(Trust.CONFIRMED, Trust.DOUBTFUL)

    def describe(self) -> str:
        """The shares in a sentence."""
        if np.isnan(self.doubtful_share):
            return "No pixel has an answer that could be doubted."
        doubtful, tested, like = (
            f"{100.0 * share:.2f} %" for share in (self.doubtful_share, self.tested_share, self._share(Trust.LIKE_NEIGHBOURS))
        )
        so_far = "" if self.complete else " so far"
        return f"{doubtful} of the pixels inside are doubtful{so_far}: {tested} were tested, {like} agree with their neighbours."

    def _share(self, *codes: Trust) -> float:
        asked = self.trust[self.trust != Trust.NO_QUESTION]
        return float(np.mean(np.isin(asked, codes))) if asked.size else float("nan")


def compute_trust(
    escape_map: EscapeMap,
    on_frame: Callable[[TrustMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
) -> TrustMap:
    """Find the pixels of a finished map whose answer does not survive a change far smaller than a pixel.

    A pixel is tested when one of its eight neighbours has another fate or, both having escaped, other crossings. It is followed
    twice more: from a start `SHIFT` nearer to 0 in x and in the ordinate (see `shifted_starts`), and from the same start at
    `SECOND_TOLERANCE`. It is doubtful when its fate, or its crossings before the escape, change in either; crossings of bounded
    orbits are not compared, as certified ones are not followed to t_max. Of two pixels that are mirror images only the first is
    tested.

    Parameters
    ----------
    escape_map
        A complete map.
    on_frame
        Called in this thread with what is known so far.
    cancel
        When set, pixels whose test is not over stay `Trust.NOT_TESTED`.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.

    Raises
    ------
    ValueError
        When the map is not complete.
    """
    if not escape_map.complete:
        raise ValueError("escape_map: is not complete; which pixels to test is known only then")
    spec, reached = escape_map.spec, 0.0
    trial = _Trial(escape_map, on_frame, cancel, executor)
    for horizon in _horizons(spec.t_max):
        if trial.is_over():
            break
        if spec.certify and spec.t_max >= SHORTEST_T_MAX and horizon > CERTIFIED_FROM >= reached:
            trial.certify(reached)
        trial.follow(horizon)
        reached = horizon
    return trial.result()


def find_unlike_neighbours(fate: np.ndarray, crossings: np.ndarray) -> np.ndarray:
    """(rows, columns) bool: pixels with an answer, one of whose eight neighbours has another.

    Answers are the fate and, of what escapes, the crossings.
    """
    answer = np.where(fate >= 1, crossings.astype(np.int64) * (int(fate.max(initial=0)) + 1) + fate, 0)
    asked = fate >= Fate.BOUNDED
    rows, columns = fate.shape
    unlike = np.zeros(fate.shape, bool)
    padded, present = np.pad(answer, 1), np.pad(asked, 1)
    for down, right in np.ndindex(3, 3):
        neighbour = np.s_[down : down + rows, right : right + columns]
        unlike |= present[neighbour] & (padded[neighbour] != answer)
    return unlike & asked


def shifted_starts(spec: MapSpec, x: np.ndarray, ordinate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n,), (n,) of the plane moved a little towards 0, where they stay inside and mirror images stay images.

    By `SHIFT`, but no more than a hundredth of a pixel and no less than `FINEST_PIXEL`, below which rounding would swallow it.
    On (x, h) only x is moved: the energy, and the exits with it, stay.
    """
    window, (columns, rows) = spec.window, spec.resolution
    moved = _towards_zero(x, (window.x_high - window.x_low) / columns)
    if spec.plane is Plane.X_H:
        return moved, ordinate
    return moved, _towards_zero(ordinate, (window.ordinate_high - window.ordinate_low) / rows)


def _towards_zero(coordinate: np.ndarray, pixel: float) -> np.ndarray:
    shift = np.maximum(min(SHIFT, LARGEST_SHARE_OF_PIXEL * pixel), FINEST_PIXEL * np.maximum(1.0, np.abs(coordinate)))
    # A start on y = 0 goes up: just below it would cross once more.
    moved: np.ndarray = np.where(coordinate > 0.0, coordinate - shift, coordinate + shift)
    return moved


def _horizons(t_max: float) -> Iterator[float]:
    """Rising to t_max, each twice the last; times between half and all of t_max are not worth a stage."""
    horizon = _FIRST_HORIZON
    while horizon <= 0.5 * t_max:
        yield horizon
        horizon *= 2.0
    yield t_max


@dataclass(frozen=True, eq=False)
class _Rerun:
    """The tested pixels' orbits once more, (n,) of them, with what the map says of each."""

    batch: OrbitBatch
    tolerance: float
    fate: np.ndarray
    crossings: np.ndarray

    def changed(self) -> np.ndarray:
        """(n,) bool: the answer has changed, or can no longer be the same as the orbit has crossed too often."""
        batch, escaped = self.batch, self.fate >= 1
        other_fate = (batch.fate != Fate.NOT_COMPUTED) & (batch.fate != self.fate)
        other_crossings = (batch.fate == self.fate) & (batch.crossings != self.crossings)
        changed: np.ndarray = other_fate | escaped & (other_crossings | (batch.crossings > self.crossings))
        return changed


class _Trial:
    """The pixels to test, and how far their orbits have come."""

    def __init__(
        self,
        escape_map: EscapeMap,
        on_frame: Callable[[TrustMap], None] | None,
        cancel: threading.Event | None,
        executor: Executor | None,
    ) -> None:
        spec = self.spec = escape_map.spec
        self.on_frame = on_frame
        self.pool: dict[str, Any] = {"cancel": cancel, "executor": executor}
        unlike = find_unlike_neighbours(escape_map.fate, escape_map.crossings)
        self.trust = np.where(escape_map.fate >= Fate.BOUNDED, Trust.LIKE_NEIGHBOURS, Trust.NO_QUESTION).astype(np.int8)
        self.trust[unlike] = Trust.NOT_TESTED
        self.images = find_mirror_images(spec.potential, spec.plane, escape_map.x, escape_map.ordinate)
        self.pixels = np.flatnonzero(unlike)
        if self.images is not None:
            self.pixels = self.pixels[self.pixels <= self.images[self.pixels]]
        self.open = np.arange(self.pixels.size)
        self.curves, self.reruns = self._prepare(escape_map)

    def _prepare(self, escape_map: EscapeMap) -> tuple[np.ndarray, list[_Rerun]]:
        """The exits of each energy, and the orbits at their starts."""
        spec, potential = self.spec, self.spec.potential
        row, column = np.divmod(self.pixels, escape_map.x.size)
        ordinate, x = escape_map.ordinate[row], escape_map.x[column]
        said = escape_map.fate.ravel()[self.pixels], escape_map.crossings.ravel()[self.pixels]
        energies, curve_row = np.unique(
            ordinate if spec.plane is Plane.X_H else np.full(x.size, spec.energy), return_inverse=True
        )
        curves = np.repeat(closed_curves(potential)[None], energies.size, axis=0)
        for k, energy in enumerate(energies):
            curves[k] = exit_curves(potential, float(energy))
        closed = np.flatnonzero(energies[curve_row] <= potential.escape_energy)
        reruns = []
        for start, tolerance in ((shifted_starts(spec, x, ordinate), TOLERANCE), ((x, ordinate), SECOND_TOLERANCE)):
            batch = OrbitBatch.from_starts(spec.start_states(*start), curve_row)
            batch.mark_outside(self.open, curves)
            batch.settle(closed[batch.fate[closed] == Fate.NOT_COMPUTED], Certificate.CLOSED)
            reruns.append(_Rerun(batch, tolerance, *said))
        return curves, reruns

    def is_over(self) -> bool:
        """Whether nothing is left to test, or nobody waits any more."""
        cancel = self.pool["cancel"]
        return not self.open.size or is_cancelled(cancel)

    def follow(self, horizon: float) -> None:
        """Carry all orbits of open pixels on, first the shifted ones."""
        for rerun in self.reruns:
            propagate_batch(
                self.spec.potential, self.curves, rerun.batch, self.open, horizon,
                final=horizon == self.spec.t_max, tolerance=rerun.tolerance, **self.pool,
            )  # fmt: skip
            self.judge()

    def certify(self, horizon: float) -> None:
        """Settle the orbits that can be shown never to leave, as the map says they do not.

        Certificates know no tolerance, and what it has done to a regular orbit until now is far below the digits they go by: what
        the shifted orbit is certified as holds for both.
        """
        shifted = self.reruns[0]
        waiting = self.open[(shifted.fate[self.open] == Fate.BOUNDED) & (shifted.batch.fate[self.open] == Fate.NOT_COMPUTED)]
        if not waiting.size:
            return
        energy = None if isinstance(self.spec.energy, tuple) else self.spec.energy
        states, place = shifted.batch.state[waiting], np.full((waiting.size, 2), _ON_COARSEST_LATTICE)
        time_left = self.spec.t_max - horizon
        certification = BoundednessCertifier(self.spec.potential, energy, states, place, time_left, **self.pool)

        def settle() -> None:
            for rerun in self.reruns:
                still_open = rerun.batch.fate[waiting] == Fate.NOT_COMPUTED
                rerun.batch.settle(waiting[still_open], certification.certificate[still_open])
            self.judge()

        certification.run(settle)

    def judge(self) -> None:
        """Note which pixels are decided, leave them behind, and publish."""
        changed = np.any([rerun.changed() for rerun in self.reruns], axis=0)
        over = np.all([rerun.batch.fate != Fate.NOT_COMPUTED for rerun in self.reruns], axis=0)
        trust = self.trust.ravel()
        trust[self.pixels[over]] = Trust.CONFIRMED
        trust[self.pixels[changed]] = Trust.DOUBTFUL
        self.open = np.flatnonzero(~over & ~changed)
        if self.on_frame is not None:
            self.on_frame(self.result())

    def result(self) -> TrustMap:
        """As far as it is known."""
        trust = self.trust.copy()
        if self.images is not None:
            later = np.flatnonzero(self.images < np.arange(self.images.size))
            trust.ravel()[later] = trust.ravel()[self.images[later]]
        trust.flags.writeable = False
        return TrustMap(self.spec, trust, not np.any(trust == Trust.NOT_TESTED))
