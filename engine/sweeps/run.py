"""Long runs: maps at many energies, kept in a store band by band, so that a run that was stopped goes on from there."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from engine.dynamics.lyapunov_orbits import exit_curves
from engine.execution import SerialExecutor, count_workers, default_executor
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import IMAGES, EscapeMap
from engine.maps.row_blocks import row_blocks
from engine.maps.run import MapRun, carry_through
from engine.maps.spec import MapSpec
from engine.sweeps.spec import SweepSpec as SweepSpec
from engine.sweeps.zarr_store import SweepStore, create_store
from engine.validation import read_count
from engine.warmup import prepare_kernels

# A plan is made from maps of these sides at this many energies. The smaller one is mostly what any map costs, whatever its size.
_COARSE_SIDES = (48, 96)
_PLANNED_ENERGIES = 12

MOST_CORES = 1_000_000
"""Most workers that a sweep is planned for."""


def run_sweep(
    spec: SweepSpec,
    store: Path,
    *,
    on_progress: Callable[[float], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Compute the maps of a sweep, or those that are missing, into a store.

    Energies are computed one after the other, the orbits of each on all workers. An energy is marked as done when all its arrays
    are on the disk, and is never computed again. A map of more than `SweepSpec.piece` starts is computed band by band; finished
    bands are kept in the store, so that a run that was killed loses the band that was under way, and no other. Of orbits, no more
    than those of one band are in memory.

    Parameters
    ----------
    spec
        The request.
    store
        Folder of the Zarr group (format 3): a new one, an empty one, or that of an earlier run of the same request.
    on_progress
        Called in this thread with the share of the energies that is done, 0 to 1, the energy at hand counted in part.
    cancel
        When set, the work stops within about 0.2 s; the store can be gone on with.
    executor
        Any `concurrent.futures.Executor`, that of a Dask client included; None for the pool of this process.

    Returns
    -------
    Arrays fate, escape_time, crossings, certificate, outside and energy_error, (h, ordinate, x), as `EscapeMap.to_xarray` names
    them, read from the store when looked at. They are equal to the bit whatever the executor and the interruptions.

    Raises
    ------
    ValueError
        When the store holds another sweep or something else, or no exit is defined at one of the energies.
    OSError
        When the store cannot be written to; energies and bands done stay valid.
    concurrent.futures.CancelledError
        When cancelled.
    """
    for energy in (spec.energies[0], spec.energies[-1]):
        exit_curves(spec.potential, energy)
    sweep = _open_store(spec, Path(store))
    pending = sweep.pending()
    if pending:
        sweep.check_writable()
    sweep.discard_leftovers()
    count = len(spec.energies)
    for already, place in enumerate(pending, start=count - len(pending)):
        _compute_energy(spec, sweep, place, _report_share(on_progress, already, count), cancel, executor)
    if on_progress is not None:
        on_progress(1.0)
    return sweep.open_dataset()


def _compute_energy(
    spec: SweepSpec,
    sweep: SweepStore,
    place: int,
    report: Callable[[float], None] | None,
    cancel: threading.Event | None,
    executor: Executor | None,
) -> None:
    """Compute the map at one energy, or the bands of it that are missing, into the store."""
    map_spec = spec.map_spec(spec.energies[place])
    bands = list(row_blocks(map_spec, spec.piece or LARGEST_RUN))
    if len(bands) == 1:
        on_frame = None if report is None else lambda frame: report(frame.progress)
        sweep.write(place, _compute_whole_map(map_spec, on_frame, cancel, executor).to_xarray())
        return
    kept = sweep.kept_bands(place)
    for number, rows in enumerate(bands):
        if number not in kept:
            part = _compute_band(map_spec, rows, cancel, executor)
            kept.keep(number, {name: getattr(part, name) for name in sweep.image_names})
        if report is not None:
            report((number + 1) / len(bands))
    sweep.write_bands(place, bands)


def _compute_band(spec: MapSpec, rows: np.ndarray, cancel: threading.Event | None, executor: Executor | None) -> EscapeMap:
    """Some rows of a map, finished; CancelledError when they are not."""
    run = MapRun(spec, rows=rows)
    carry_through(run, executor, cancel)
    part = run.frame()
    if not part.complete:
        raise CancelledError
    return part


def _open_store(spec: SweepSpec, path: Path) -> SweepStore:
    """The store of a request, made if there is none."""
    attributes, coordinates = spec.provenance(), spec.coordinates()
    if not path.exists() or not any(path.iterdir()):
        map_spec = spec.map_spec(spec.energies[-1])
        labels = MapRun(replace(map_spec, resolution=(1, 1))).frame().to_xarray()
        fills = {name: fill for name, (_, fill) in IMAGES.items()}
        columns, rows = spec.resolution
        create_store(path, labels, fills, coordinates, attributes, min(max(LARGEST_RUN // columns, 1), rows))
    elif not (path / "zarr.json").exists():
        raise ValueError(f"store={path}: holds something else; must be new, empty, or the store of this sweep")
    sweep = SweepStore(path)
    sweep.check_request(attributes, coordinates)
    return sweep


def _report_share(on_progress: Callable[[float], None] | None, already: int, count: int) -> Callable[[float], None] | None:
    """Say how many energies are done, and what to call with the share of the next that is; None when nobody listens."""
    if on_progress is None:
        return None
    on_progress(already / count)
    return lambda share: on_progress((already + share) / count)


def _compute_whole_map(
    spec: MapSpec,
    on_frame: Callable[[EscapeMap], None] | None,
    cancel: threading.Event | None,
    executor: Executor | None,
) -> EscapeMap:
    """The map, finished; CancelledError when it is not."""
    whole = compute_map(spec, on_frame, cancel, executor)
    if not whole.complete:
        raise CancelledError
    return whole


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep will cost.

    Attributes
    ----------
    orbits
        Starts at all energies, forbidden and outside ones included.
    seconds
        Wall time on `cores`, if all of them are busy all the time.
    bytes
        Size of the arrays before compression: an upper bound for the store.
    cores
        Workers that it is planned for.
    """

    orbits: int
    seconds: float
    bytes: int
    cores: int

    def describe(self) -> str:
        """The plan in a sentence."""
        hours = self.seconds / 3600.0
        took = f"{hours:.3g} hours" if hours >= 1.0 else f"{self.seconds:.3g} s"
        spent = f"{hours * self.cores:.3g} core hours"
        cores = "1 core" if self.cores == 1 else f"{self.cores} cores"
        return f"{self.orbits:.3g} orbits: about {took} on {cores} ({spent}), at most {self.bytes / 1e9:.3g} GB"


def plan_sweep(
    spec: SweepSpec, *, cores: int | None = None, executor: Executor | None = None, cancel: threading.Event | None = None
) -> SweepPlan:
    """Estimate what a sweep will cost, from the processor time of coarse maps, 48 and 96 pixels a side, at twelve energies.

    What a map costs grows no faster than its pixels once it is larger than that, and more slowly where invariant curves enclose
    many orbits. In trials of 40 maps the estimate was within a fifth. With t_max = 1e5 planning itself takes some seconds, a
    minute or more where much is bounded and little can be certified.

    Parameters
    ----------
    spec
        The request.
    cores
        For how many workers, 1 or more; None for those of `executor`.
    executor
        Where the sweep is to run; nothing is run there, and its cores are taken to be as fast as this one. None for the pool of
        this process.
    cancel
        When set, the work stops within about 0.2 s.

    Raises
    ------
    ValueError
        When `cores` is less than 1, or no exit is defined at one of the energies.
    concurrent.futures.CancelledError
        When cancelled.
    """
    if cores is not None:
        cores = read_count("cores", cores, 1, MOST_CORES)
    workers = cores or count_workers(executor or default_executor())
    prepare_kernels(spec.potential)
    count = len(spec.energies)
    places = np.unique(((np.arange(_PLANNED_ENERGIES) + 0.5) * count / _PLANNED_ENERGIES).astype(int))
    seconds = [_predict_seconds(spec.map_spec(spec.energies[place]), cancel) for place in places]
    pixel_bytes = sum(np.dtype(dtype).itemsize for name, (dtype, _) in IMAGES.items() if name != "started")
    return SweepPlan(spec.orbits, count * float(np.mean(seconds)) / workers, spec.orbits * pixel_bytes, workers)


def _predict_seconds(spec: MapSpec, cancel: threading.Event | None) -> float:
    """Processor time of one map, carried on from two coarse ones along a straight line."""
    pixels = np.prod(spec.resolution)
    small, large = (side * side for side in _COARSE_SIDES)
    first, second = (_measure_seconds(replace(spec, resolution=(side, side)), cancel) for side in _COARSE_SIDES)
    slope = (second - first) / (large - small)
    # Where the two are as long as each other, what is measured is noise.
    rate = min(slope, second / large) if slope > 0.0 else second / large
    return second + rate * max(float(pixels) - large, 0.0)


def _measure_seconds(spec: MapSpec, cancel: threading.Event | None) -> float:
    begun = time.thread_time()
    # In this thread, so that the time of nothing else is counted.
    _compute_whole_map(spec, None, cancel, SerialExecutor())
    return time.thread_time() - begun
