"""Maps of escapes: coarse to fine and short horizon to long, in frames, resumable; and the same for free lists of orbits."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from importlib import metadata
from typing import Any

import numpy as np
import xarray as xr

from engine.fates import Fate
from engine.lyapunov_orbits import closed_curves, exit_curves
from engine.map_specs import MapSpec, checked_t_max
from engine.orbit_batches import OrbitBatch, carry_on
from engine.planes import Plane, start_states
from engine.potentials import Potential
from engine.taylor.codegen import ORDER, TOLERANCE

# A first frame holds at most this many pixels.
COARSE_PIXELS = 1200
SHORTEST_HORIZON = 100.0
HORIZON_FACTOR = 10.0
ENERGY_TOLERANCE = 1e-9
# Seconds between frames within a stage.
FRAME_PAUSE = 0.15


@dataclass(frozen=True, eq=False)
class Outcomes:
    """What became of n orbits: the arrays that `classify_orbits` returns.

    Attributes
    ----------
    fate
        int8 codes: channel k ≥ 1, or a `Fate`.
    escape_time
        float64, time of the outward crossing of the Lyapunov orbit; NaN for orbits that have not left.
    crossings
        int32, upward crossings of y = 0 (start not counted) before the escape, or until t_max; 0 where there is no orbit.
    energy_error
        float64, |H − h| / |h| at the end; NaN where there is no orbit.
    """

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    energy_error: np.ndarray


@dataclass(frozen=True, eq=False)
class EscapeMap:
    """A map, finished or on its way; arrays are (rows, columns) with row 0 lowest, and read-only.

    Attributes
    ----------
    spec
        What was asked for.
    x, ordinate
        (columns,), (rows,) pixel centres.
    fate, escape_time, crossings, energy_error
        As in `Outcomes`; pixels not decided yet are `Fate.NOT_COMPUTED`.
    outside
        int8, the channel beyond whose Lyapunov orbit the start lies, 0 inside.
    stride
        Of each square of this many pixels a side at least one has been started; 1 when all have.
    horizon
        Time to which this stage follows orbits; t_max in the last one.
    progress
        Share of the work that is certainly done, 0 to 1: undecided orbits count by the time they have covered.
    complete
        Whether every pixel is decided.
    started
        bool, the pixels whose orbits have been started.
    batch
        State to go on from with ``resume``; None in frames.
    """

    spec: MapSpec
    x: np.ndarray
    ordinate: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    energy_error: np.ndarray
    outside: np.ndarray
    stride: int
    horizon: float
    progress: float
    complete: bool
    started: np.ndarray = field(repr=False)
    batch: OrbitBatch | None = field(default=None, repr=False)

    @property
    def undecided(self) -> float:
        """Share of the interior starts whose fate is still open."""
        interior = (self.fate != Fate.FORBIDDEN) & (self.fate != Fate.OUTSIDE)
        return float(np.mean(self.fate[interior] == Fate.NOT_COMPUTED)) if interior.any() else 0.0

    @property
    def worst_energy_error(self) -> float:
        """Largest relative energy error of any decided orbit; NaN when there is none."""
        errors = self.energy_error[np.isfinite(self.energy_error)]
        return float(errors.max()) if errors.size else float("nan")

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays, the state to go on from included."""
        arrays = (self.fate, self.escape_time, self.crossings, self.energy_error, self.outside, self.started)
        return sum(array.nbytes for array in arrays) + (self.batch.nbytes if self.batch else 0)

    def fractions(self, *, count_outside: bool = False) -> dict[int, float]:
        """Share of the starts for each channel, and for `Fate.BOUNDED`, `NOT_COMPUTED` and `FAILED`.

        Out of the interior starts; with `count_outside` starts outside count as escaped at once through the channel they
        lie in, as the paper's percentages do (they then depend on the window).
        """
        fate = self.fate
        if count_outside:
            fate = np.where(fate == Fate.OUTSIDE, self.outside, fate)
        fate = fate[(fate != Fate.FORBIDDEN) & (fate != Fate.OUTSIDE)]
        codes = (*range(1, self.spec.potential.channels + 1), Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED)
        return {int(code): float(np.mean(fate == code)) if fate.size else 0.0 for code in codes}

    def stretched(self) -> dict[str, np.ndarray]:
        """fate, escape_time and crossings with pixels not started yet painted like a started one of their square."""
        names = ("fate", "escape_time", "crossings")
        if self.stride == 1:
            return {name: getattr(self, name) for name in names}
        rows, columns = (_anchors(size, self.stride) for size in self.fate.shape)
        use = np.where(
            self.started, np.arange(self.fate.size).reshape(self.fate.shape), rows[:, None] * self.fate.shape[1] + columns
        )
        empty = (self.fate == Fate.FORBIDDEN) | (self.fate == Fate.OUTSIDE)
        use = np.where(empty, np.arange(self.fate.size).reshape(self.fate.shape), use)
        return {name: getattr(self, name).ravel()[use] for name in names}

    def to_xarray(self) -> xr.Dataset:
        """The map with named axes, units and provenance, fit for NetCDF."""
        spec = self.spec
        dims = (spec.plane.ordinate, "x")
        variables = {
            "fate": (dims, self.fate, {"long_name": "exit channel (k >= 1) or outcome code", **_FATE_CODES}),
            "escape_time": (dims, self.escape_time, {"long_name": "escape time", "units": "1"}),
            "crossings": (dims, self.crossings, {"long_name": "upward crossings of y = 0 before escape"}),
            "energy_error": (dims, self.energy_error, {"long_name": "relative energy error", "units": "1"}),
        }
        coordinates = {
            spec.plane.ordinate: (spec.plane.ordinate, self.ordinate, {"units": "1"}),
            "x": ("x", self.x, {"units": "1"}),
        }
        return xr.Dataset(variables, coordinates, self.provenance())

    def provenance(self) -> dict[str, Any]:
        """What made this map, in plain values: the request, the integrator, its version, the worst energy error, the counts."""
        spec, window = self.spec, self.spec.window
        codes, counts = np.unique(self.fate, return_counts=True)
        return {
            "potential": spec.potential.name,
            "terms": "; ".join(f"{c!r} x^{i} y^{j}" for i, j, c in spec.potential.terms),
            "energy": spec.energy,
            "plane": spec.plane.value,
            "window": (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high),
            "resolution": spec.resolution,
            "t_max": spec.t_max,
            "integrator": f"Taylor series of order {ORDER}, tolerance {TOLERANCE:g}",
            "version": metadata.version("escape-explorer"),
            "worst_energy_error": self.worst_energy_error,
            "complete": int(self.complete),
            "counts": "; ".join(f"{code}: {count}" for code, count in zip(codes, counts, strict=True)),
        }


_FATE_CODES = {"codes": "; ".join(f"{fate.value}: {fate.name.lower()}" for fate in Fate)}


def classify_orbits(
    potential: Potential,
    energy: float,
    states: Any,
    t_max: float = 1e5,
    *,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> Outcomes:
    """Fate, escape time and crossings of any list of orbits of one energy.

    Parameters
    ----------
    potential
        The `Potential`.
    energy
        h, finite, dimensionless.
    states
        (n, 4) x, y, px, py; finite, all on that energy to 1e-9.
    t_max
        How long each orbit is followed, 0 < t_max ≤ 1e8.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, orbits not yet decided stay `Fate.NOT_COMPUTED`.

    Raises
    ------
    ValueError
        When a state is not finite or not on the energy, or a parameter is out of its range.
    """
    states = _checked_states(potential, energy, states)
    t_max = checked_t_max(t_max)
    curves = exit_curves(potential, energy)[None]
    batch = OrbitBatch.from_starts(states, np.zeros(len(states), np.int64))
    everything = np.arange(len(states))
    batch.mark_outside(everything, curves)
    carry_on(potential, curves, batch, everything, t_max, final=True, executor=executor, cancel=cancel)
    return _outcomes(potential, np.full(len(states), float(energy)), batch)


def _checked_states(potential: Potential, energy: float, states: Any) -> np.ndarray:
    states_array: np.ndarray = np.ascontiguousarray(states, dtype=float)
    if not np.isfinite(energy):
        raise ValueError(f"energy={energy}: must be a finite number")
    if states_array.ndim != 2 or states_array.shape[1] != 4:
        raise ValueError(f"states of shape {states_array.shape}: must be (n, 4) with columns x, y, px, py")
    if not np.isfinite(states_array).all():
        raise ValueError(f"states: row {int(np.argmin(np.isfinite(states_array).all(axis=1)))} holds a number that is not finite")
    off = np.abs(potential.energy(states_array) - energy)
    if np.any(off > ENERGY_TOLERANCE):
        row = int(np.argmax(off))
        raise ValueError(
            f"states: row {row} has energy {float(potential.energy(states_array[row]))!r}; "
            f"all must have energy={energy} to {ENERGY_TOLERANCE:g}"
        )
    return states_array


def _outcomes(potential: Potential, energy: np.ndarray, batch: OrbitBatch) -> Outcomes:
    orbit = (batch.fate >= Fate.BOUNDED) | (batch.fate == Fate.NOT_COMPUTED)
    crossings = np.where(orbit, batch.crossings + batch.last_crossings, 0).astype(np.int32)
    error = np.abs(potential.energy(batch.state) - energy) / np.maximum(np.abs(energy), np.finfo(float).tiny)
    decided = batch.fate >= Fate.BOUNDED
    return Outcomes(
        batch.fate.copy(), np.where(batch.fate >= 1, batch.t, np.nan), crossings, np.where(decided, error, np.nan)
    )  # fmt: skip


def _anchors(size: int, stride: int) -> np.ndarray:
    """For each index the one that stands for its square."""
    return np.minimum(np.arange(size) // stride * stride + stride // 2, size - 1)


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
            rows, columns = (np.unique(_anchors(size, stride)) for size in self.shape)
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
        outcomes = _outcomes(self.spec.potential, self.energy, self.batch)
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
