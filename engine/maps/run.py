"""One map on its way: coarse to fine, short horizon to long, certificates between; cancellable and resumable."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from engine.dynamics.batch import OrbitBatch, propagate_batch
from engine.dynamics.certificates import Certificate
from engine.dynamics.classification import Outcomes, read_outcomes
from engine.dynamics.fates import Fate
from engine.dynamics.lyapunov_orbits import closed_curves, exit_curves
from engine.dynamics.planes import Plane, find_mirror_images
from engine.execution import is_cancelled
from engine.invariant_sets.boundedness_certifier import SHORTEST_T_MAX, BoundednessCertifier
from engine.maps.result import EscapeMap, anchors, find_interior
from engine.maps.spec import MapSpec

# A first frame holds at most this many pixels.
COARSE_PIXELS = 1200
SHORTEST_HORIZON = 100.0
HORIZON_FACTOR = 10.0
# Most escapes are over by then: what is still open is worth a certificate.
CERTIFIED_FROM = 1000.0


def _coarsest_stride(resolution: tuple[int, int]) -> int:
    stride = 1
    while -(-resolution[0] // stride) * -(-resolution[1] // stride) > COARSE_PIXELS:
        stride *= 2
    return stride


def _horizons(t_max: float) -> list[float]:
    """Short first, each ten times the last, and t_max; times between half and all of t_max are not worth a stage."""
    horizons = []
    horizon = SHORTEST_HORIZON
    while horizon < 0.5 * t_max:
        horizons.append(horizon)
        horizon *= HORIZON_FACTOR
    return [*horizons, t_max]


class MapRun:
    """The computation of a map, or of some rows of it, on its way: the batch behind its pixels and the stage it is in.

    Of two pixels that are mirror images of each other only the first is computed.

    Parameters
    ----------
    spec
        The request.
    resume
        An earlier map to go on from.
    rows
        Numbers of the rows, rising; None for all.
    """

    def __init__(self, spec: MapSpec, resume: EscapeMap | None = None, rows: np.ndarray | None = None) -> None:
        self.spec = spec
        self.x, self.ordinate = spec.pixel_centres()
        self.ordinate = self.ordinate if rows is None else self.ordinate[rows]
        self.shape = (self.ordinate.size, self.x.size)
        self.images = find_mirror_images(spec.potential, spec.plane, self.x, self.ordinate)
        x, ordinate = (grid.ravel() for grid in np.meshgrid(self.x, self.ordinate))
        rows = np.repeat(np.arange(self.shape[0]), self.shape[1])
        self.energy = ordinate if isinstance(spec.energy, tuple) else np.full(x.size, spec.energy)
        self.curve_row = rows if spec.plane is Plane.X_H else np.zeros(x.size, np.int64)
        if resume is None:
            self.batch = OrbitBatch.from_starts(spec.start_states(x, ordinate), self.curve_row)
            self.started = np.zeros(x.size, bool)
        else:
            assert resume.batch is not None
            self.batch, self.started = resume.batch.copy(), resume.started.ravel().copy()
            self.batch.reopen_bounded()
        self.curves = np.repeat(closed_curves(spec.potential)[None], self.curve_row[-1] + 1, axis=0)
        self.stride = _coarsest_stride(self.shape)
        self.horizon = min(SHORTEST_HORIZON, spec.t_max)
        self.unsolved = set(range(len(self.curves)))

    def levels(self) -> Iterator[tuple[np.ndarray, int]]:
        """(pixels, stride) of each refinement, coarse to fine; the last one holds all pixels."""
        numbers = np.arange(self.started.size).reshape(self.shape)
        stride = 1 if self.started.all() else self.stride
        while stride > 1:
            rows, columns = (np.unique(anchors(size, stride)) for size in self.shape)
            yield self._first_of_images(numbers[np.ix_(rows, columns)].ravel()), stride
            stride //= 2
        yield self._first_of_images(numbers.ravel()), 1

    def _first_of_images(self, pixels: np.ndarray) -> np.ndarray:
        """The pixels to compute for these, each once."""
        return pixels if self.images is None else np.unique(np.minimum(pixels, self.images[pixels]))

    def stages(self) -> Iterator[tuple[np.ndarray, int, float]]:
        """(pixels, stride, horizon): every level at the shortest horizon, then all pixels at longer ones."""
        horizons = _horizons(self.spec.t_max)
        for pixels, stride in self.levels():
            yield pixels, stride, horizons[0]
        everything = self._first_of_images(np.arange(self.started.size))
        for horizon in horizons[1:]:
            yield everything, 1, horizon

    def begin(self, pixels: np.ndarray, stride: int, horizon: float) -> np.ndarray:
        """Start a stage: find the exits that its pixels need, mark starts that lie outside, and return the exit curves."""
        self.stride, self.horizon = stride, horizon
        for row in self.unsolved.intersection(np.unique(self.curve_row[pixels]).tolist()):
            self.curves[row] = exit_curves(self.spec.potential, self._row_energy(row))
            self.unsolved.discard(row)
        fresh = pixels[~self.started[pixels]]
        self.batch.mark_outside(fresh, self.curves)
        self.started[fresh] = True
        return self.curves

    def certify(self, executor: Executor | None, cancel: threading.Event | None, on_round: Callable[[], None]) -> None:
        """Settle the open orbits that can be shown never to leave."""
        spec, batch = self.spec, self.batch
        waiting = np.flatnonzero(batch.fate == Fate.NOT_COMPUTED)
        waiting = np.intersect1d(waiting, self._first_of_images(waiting))
        closed = self.energy[waiting] <= spec.potential.escape_energy
        batch.settle(waiting[closed], Certificate.CLOSED)
        waiting = waiting[~closed]
        place = np.column_stack(np.divmod(waiting, self.shape[1]))
        energy = None if isinstance(spec.energy, tuple) else spec.energy
        time_left = spec.t_max - self.horizon
        certification = BoundednessCertifier(spec.potential, energy, batch.state[waiting], place, time_left, executor, cancel)

        def settle() -> None:
            batch.settle(waiting, certification.certificate)
            on_round()

        certification.run(settle)

    def _row_energy(self, row: int) -> float:
        return float(self.ordinate[row]) if self.spec.plane is Plane.X_H else float(self.energy[0])

    def result(self) -> EscapeMap:
        """The last frame, with the state to go on from."""
        return replace(self.frame(), batch=self.batch)

    def outcomes(self) -> Outcomes:
        """What is known of each pixel; (n,) arrays."""
        if self.images is not None:
            first = np.flatnonzero(self.started & (self.images > np.arange(self.images.size)))
            self.batch.copy_to_images(first, self.images[first], self.spec.potential.mirror_channels)
            self.started[self.images[first]] = True
        return read_outcomes(self.spec.potential, self.energy, self.batch)

    def frame(self) -> EscapeMap:
        """The map so far."""
        outcomes = self.outcomes()
        complete = bool(self.started.all() and not np.any(outcomes.fate == Fate.NOT_COMPUTED))
        arrays = {
            name: getattr(outcomes, name).reshape(self.shape) for name in ("fate", "escape_time", "crossings", "energy_error")
        }
        arrays |= {"certificate": self.batch.certificates().reshape(self.shape)}
        arrays |= {"outside": self.batch.outside.reshape(self.shape).copy(), "started": self.started.reshape(self.shape).copy()}
        for array in (*arrays.values(), self.x, self.ordinate):
            array.flags.writeable = False
        return EscapeMap(
            spec=self.spec, x=self.x, ordinate=self.ordinate, stride=self.stride, horizon=self.horizon,
            progress=self._progress(), complete=complete, **arrays,
        )  # fmt: skip

    def _progress(self) -> float:
        fate = self.batch.fate
        covered = np.where(fate == Fate.NOT_COMPUTED, np.minimum(self.batch.t / self.spec.t_max, 1.0), 1.0)
        interior = find_interior(fate)
        return float(covered[interior].mean()) if interior.any() else 1.0


def carry_through(
    run: MapRun,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
    publish: Callable[[bool], None] = lambda stage_over: None,
) -> None:
    """Take a run through all its stages; `publish(stage_over)` is called whenever there may be news."""
    spec = run.spec
    for pixels, stride, horizon in run.stages():
        if is_cancelled(cancel):
            break
        if spec.certify and spec.t_max >= SHORTEST_T_MAX and horizon > CERTIFIED_FROM >= run.horizon:
            run.certify(executor, cancel, lambda: publish(False))
        curves = run.begin(pixels, stride, horizon)
        propagate_batch(
            spec.potential, curves, run.batch, pixels, horizon,
            final=horizon == spec.t_max, executor=executor, cancel=cancel, on_progress=lambda: publish(False),
        )  # fmt: skip
        publish(True)
