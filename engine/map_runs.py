"""The computing of maps: coarse to fine and short horizon to long, in frames, cancellable and resumable."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from engine.escape_maps import EscapeMap, anchors
from engine.fates import Fate
from engine.lyapunov_orbits import closed_curves, exit_curves
from engine.map_specs import MapSpec
from engine.orbit_batches import OrbitBatch, carry_on
from engine.outcomes import read_outcomes
from engine.planes import Plane, start_states

# A first frame holds at most this many pixels.
COARSE_PIXELS = 1200
SHORTEST_HORIZON = 100.0
HORIZON_FACTOR = 10.0
# Seconds between frames within a stage.
FRAME_PAUSE = 0.15


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


class _MapRun:
    """One computation of a map on its way: the batch behind its pixels and the stage it is in."""

    def __init__(self, spec: MapSpec, resume: EscapeMap | None) -> None:
        self.spec = spec
        self.x, self.ordinate = spec.pixel_centres()
        self.shape = (spec.resolution[1], spec.resolution[0])
        x, ordinate = (grid.ravel() for grid in np.meshgrid(self.x, self.ordinate))
        rows = np.repeat(np.arange(self.shape[0]), self.shape[1])
        self.energy = ordinate if isinstance(spec.energy, tuple) else np.full(x.size, spec.energy)
        self.curve_row = rows if spec.plane is Plane.X_H else np.zeros(x.size, np.int64)
        if resume is None:
            h = 0.0 if isinstance(spec.energy, tuple) else spec.energy
            states = start_states(spec.potential, spec.plane, h, x, ordinate)
            self.batch = OrbitBatch.from_starts(states, self.curve_row)
            self.started = np.zeros(x.size, bool)
        else:
            assert resume.batch is not None
            self.batch, self.started = resume.batch.copy(), resume.started.ravel().copy()
            self.batch.reopen_bounded()
        self.curves = np.repeat(closed_curves(spec.potential)[None], self.curve_row[-1] + 1, axis=0)
        self.stride = _coarsest_stride(spec.resolution)
        self.horizon = min(SHORTEST_HORIZON, spec.t_max)
        self.unsolved = set(range(len(self.curves)))

    def levels(self) -> Iterator[tuple[np.ndarray, int]]:
        """(pixels, stride) of each refinement, coarse to fine; the last one holds all pixels."""
        numbers = np.arange(self.started.size).reshape(self.shape)
        stride = 1 if self.started.all() else self.stride
        while stride > 1:
            rows, columns = (np.unique(anchors(size, stride)) for size in self.shape)
            yield numbers[np.ix_(rows, columns)].ravel(), stride
            stride //= 2
        yield numbers.ravel(), 1

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

    def _row_energy(self, row: int) -> float:
        return float(self.ordinate[row]) if self.spec.plane is Plane.X_H else float(self.energy[0])

    def result(self) -> EscapeMap:
        """The last frame, with the state to go on from."""
        return replace(self.frame(), batch=self.batch)

    def frame(self) -> EscapeMap:
        outcomes = read_outcomes(self.spec.potential, self.energy, self.batch)
        complete = bool(self.started.all() and not np.any(outcomes.fate == Fate.NOT_COMPUTED))
        arrays = {
            name: getattr(outcomes, name).reshape(self.shape) for name in ("fate", "escape_time", "crossings", "energy_error")
        }
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
        interior = (fate != Fate.FORBIDDEN) & (fate != Fate.OUTSIDE)
        return float(covered[interior].mean()) if interior.any() else 1.0


def compute_map(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    resume: EscapeMap | None = None,
) -> EscapeMap:
    """Compute a map of escapes.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with the map so far, often at first: coarse pixels first, then all, then longer horizons.
    cancel
        When set, the map is returned as it is within about 0.1 s, with ``complete`` False.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    resume
        An earlier map, finished or cancelled, whose spec differs at most by a smaller or equal t_max: its orbits go on
        from where they are.

    Returns
    -------
    `EscapeMap`, equal to the bit whatever the executor, the interruptions and the resumptions.

    Raises
    ------
    ValueError
        When `resume` belongs to another map, or no exit is defined at an energy that `spec` asks for.
    """
    if resume is not None:
        _check_resumable(spec, resume)
    run = _MapRun(spec, resume)

    last = time.monotonic()

    def publish(pause: float = 0.0) -> None:
        nonlocal last
        if on_frame is not None and time.monotonic() - last >= pause:
            on_frame(run.frame())
            last = time.monotonic()

    for pixels, stride, horizon in _stages(run):
        if cancel is not None and cancel.is_set():
            break
        curves = run.begin(pixels, stride, horizon)
        carry_on(
            spec.potential, curves, run.batch, pixels, horizon,
            final=horizon == spec.t_max, executor=executor, cancel=cancel, on_progress=lambda: publish(FRAME_PAUSE),
        )  # fmt: skip
        publish()
    return run.result()


def _stages(run: _MapRun) -> Iterator[tuple[np.ndarray, int, float]]:
    """(pixels, stride, horizon): every level at the shortest horizon, then all pixels at longer ones."""
    horizons = _horizons(run.spec.t_max)
    for pixels, stride in run.levels():
        yield pixels, stride, horizons[0]
    everything = np.arange(run.started.size)
    for horizon in horizons[1:]:
        yield everything, 1, horizon


def _check_resumable(spec: MapSpec, resume: EscapeMap) -> None:
    earlier = resume.spec
    same = (earlier.potential, earlier.plane, earlier.energy, earlier.resolution, earlier.window) == (
        spec.potential, spec.plane, spec.energy, spec.resolution, spec.window,
    )  # fmt: skip
    if resume.batch is None:
        raise ValueError("resume: a frame holds no orbits to go on from; give the map that compute_map returned")
    if not same or earlier.t_max > spec.t_max:
        raise ValueError(f"resume: a map of {earlier} cannot go on to {spec}; all but a larger t_max must be equal")
