"""Long runs: maps at many energies, written to a store block by block, so that an interrupted run can be resumed."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from engine.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.exits.exit_rows import exit_curves
from engine.maps.compute import LARGEST_RUN, run_map
from engine.maps.result import PIXEL_ARRAYS, EscapeMap
from engine.maps.row_blocks import row_blocks
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.results.wording import format_count
from engine.storage.output_lock import hold_lock
from engine.sweeps.complete_map import require_complete
from engine.sweeps.spec import SweepSpec
from engine.sweeps.zarr_store import SweepStore, create_store
from engine.validation import checked_count, checks_types
from engine.warmup import prepare_kernels

if TYPE_CHECKING:
    import xarray as xr

# A plan is based on maps of these sides at this many energies; the small one measures the cost that does not depend on size.
_COARSE_SIDES = (48, 96)
_PLANNED_ENERGIES = 12

MOST_CORES = 1_000_000
"""Most workers of a plan."""


@shows_progress("sweep")
@checks_types(spec=SweepSpec, store=(str, os.PathLike), execution=Execution)
def run_sweep(
    spec: SweepSpec,
    store: str | os.PathLike[str],
    *,
    execution: Execution = DEFAULT_EXECUTION,
) -> xr.Dataset:
    """Compute the maps of a sweep, or those that are missing, into a store.

    Energies are computed one after the other, each on all workers. An energy is marked as finished once all its arrays are on the
    disk, and is never computed again. A map of more than `SweepSpec.piece` starts is computed in row blocks; finished blocks are
    stored too, so that a killed run loses only the block in progress. Only the orbits of one block are in memory.

    Parameters
    ----------
    spec
        The request.
    store
        Folder of the Zarr group (format 3): new, empty, or of an earlier run of the same request.
    execution
        How the computation runs; the store of a cancelled one can be resumed.

    Returns
    -------
    Dataset with the arrays fate, escape_time, crossings, certificate, outside and energy_error, (h, ordinate, x), named as in
    `EscapeMap.to_xarray` and read from the store on access. They are bit-identical for any executor and any interruptions.

    Raises
    ------
    ValueError
        When the store holds another sweep or other files, the folder that is to hold it does not exist, or no exit is defined at
        one of the energies.
    OSError
        When the store cannot be written to; finished energies and blocks stay valid. BlockingIOError when another process
        computes into it, with one sentence that names the process.
    concurrent.futures.CancelledError
        When cancelled.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from escape_explorer import CASES, Plane, SweepSpec, run_sweep
    >>> spec = SweepSpec(CASES["I"], Plane.X_PX, (0.2, 0.25), resolution=(20, 20), t_max=100.0)
    >>> with TemporaryDirectory() as folder:
    ...     dataset = run_sweep(spec, f"{folder}/maps.zarr")
    ...     print(dict(dataset["fate"].sizes))
    {'h': 2, 'px': 20, 'x': 20}
    """
    for energy in (spec.energies[0], spec.energies[-1]):
        exit_curves(spec.potential.in_well_units, energy / spec.potential.units.energy)
    path = Path(store)
    sweep = _find_store(spec, path)
    if sweep is None or sweep.pending():
        with hold_lock(path):
            sweep = _find_store(spec, path) or _create_store(spec, path)
            _compute_pending(spec, sweep, execution)
    execution.report(lambda: 1.0)
    return sweep.open_dataset()


def _compute_pending(spec: SweepSpec, sweep: SweepStore, execution: Execution) -> None:
    """Compute the unfinished energies, one after the other."""
    pending, count = sweep.pending(), len(spec.energies)
    sweep.prepare_writing()
    for finished, index in enumerate(pending, start=count - len(pending)):
        part = execution.part(finished, count)
        part.report(lambda: 0.0)
        _compute_energy(spec, sweep, index, part)


def _compute_energy(spec: SweepSpec, sweep: SweepStore, index: int, execution: Execution) -> None:
    """Compute the missing row blocks of the map at one energy into the store."""
    map_spec = spec.map_spec(spec.energies[index])
    blocks = list(row_blocks(map_spec, spec.piece or LARGEST_RUN))
    for number in sweep.unfinished_blocks(index, blocks):
        part = execution.part(number, len(blocks))
        block = _compute_block(map_spec, blocks[number], part) if len(blocks) > 1 else require_complete(run_map(map_spec, part))
        with _name_in_errors(sweep.path):
            sweep.write(index, blocks[number], block)
        part.report(lambda: 1.0)
    with _name_in_errors(sweep.path):
        sweep.mark_done(index)


@contextmanager
def _name_in_errors(path: Path) -> Iterator[None]:
    """Add the path of the store to errors of the operating system that name no file, such as that of a full disk."""
    try:
        yield
    except OSError as error:
        if error.errno is None or error.filename is not None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _compute_block(spec: MapSpec, rows: np.ndarray, execution: Execution) -> EscapeMap:
    """The given rows of a map. Raises CancelledError when cancelled."""
    run = MapRun(spec.in_well_units(), rows=rows)
    run.run(execution)
    return require_complete(run.frame().restored(spec))


def _find_store(spec: SweepSpec, path: Path) -> SweepStore | None:
    """Open the store of a request; None if the folder is missing or empty."""
    if not path.parent.exists():
        raise ValueError(f"store={path}: the folder {path.parent} does not exist; make it first")
    if not path.exists() or not any(path.iterdir()):
        return None
    if not (path / "zarr.json").exists():
        raise ValueError(f"store={path}: holds other files; must be new, empty, or the store of this sweep")
    sweep = SweepStore(path)
    sweep.check_request(spec.provenance(), spec.coordinates())
    return sweep


def _create_store(spec: SweepSpec, path: Path) -> SweepStore:
    one_pixel = replace(spec.map_spec(spec.energies[-1]), resolution=(1, 1))
    template = MapRun(one_pixel.in_well_units()).frame().restored(one_pixel).to_xarray()
    fill_values = {name: fill for name, (_, fill) in PIXEL_ARRAYS.items()}
    columns, rows = spec.resolution
    chunk_rows = min(max(LARGEST_RUN // columns, 1), rows)
    with _name_in_errors(path):
        create_store(path, template, fill_values, spec.coordinates(), spec.provenance(), chunk_rows)
    return SweepStore(path)


@dataclass(frozen=True)
class SweepPlan:
    """Estimated cost of a sweep.

    Attributes
    ----------
    orbits
        Starts at all energies, including forbidden ones and those outside.
    seconds
        Wall time in seconds if all cores are busy throughout.
    bytes
        Size of the arrays before compression, an upper bound for the store.
    cores
        Number of workers.
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
        cores = format_count(self.cores, "core")
        return f"{self.orbits:.3g} orbits: about {took} on {cores} ({spent}), at most {self.bytes / 1e9:.3g} GB"


@checks_types(spec=SweepSpec, execution=Execution)
def plan_sweep(spec: SweepSpec, *, cores: int | None = None, execution: Execution = DEFAULT_EXECUTION) -> SweepPlan:
    """Estimate the cost of a sweep from the processor time of coarse maps, 48 and 96 pixels a side, at twelve energies.

    For larger maps the cost grows at most linearly with the number of pixels, and more slowly where invariant curves enclose many
    orbits. In trials with 40 maps the estimate was within a fifth. At t_max = 1e5 planning takes some seconds; a minute or more
    where many orbits are bounded and few can be certified.

    Parameters
    ----------
    spec
        The request.
    cores
        Number of workers, 1 or more; None for those of `execution`.
    execution
        How the sweep is to run: its executor is only asked for the number of its workers, which are assumed to be as fast as this
        core.

    Raises
    ------
    ValueError
        When `cores` is less than 1, or no exit is defined at one of the energies.
    concurrent.futures.CancelledError
        When cancelled.

    Examples
    --------
    >>> from escape_explorer import CASES, Plane, SweepSpec, plan_sweep
    >>> plan = plan_sweep(SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.5), resolution=(1000, 1000), t_max=100.0), cores=64)
    >>> plan.orbits, plan.cores
    (2000000, 64)
    """
    if cores is not None:
        cores = checked_count("cores", cores, 1, MOST_CORES)
    workers = cores or execution.workers
    prepare_kernels(spec.potential)
    count = len(spec.energies)
    indices = np.unique(((np.arange(_PLANNED_ENERGIES) + 0.5) * count / _PLANNED_ENERGIES).astype(int))
    seconds = [_predict_seconds(spec.map_spec(spec.energies[index]), execution) for index in indices]
    pixel_bytes = sum(np.dtype(dtype).itemsize for name, (dtype, _) in PIXEL_ARRAYS.items() if name != "started")
    return SweepPlan(spec.orbits, count * float(np.mean(seconds)) / workers, spec.orbits * pixel_bytes, workers)


def _predict_seconds(spec: MapSpec, execution: Execution) -> float:
    """Processor time of one map in seconds, extrapolated linearly from two coarse ones."""
    pixels = np.prod(spec.resolution)
    small, large = (side * side for side in _COARSE_SIDES)
    first, second = (_measure_seconds(replace(spec, resolution=(side, side)), execution) for side in _COARSE_SIDES)
    slope = (second - first) / (large - small)
    # A slope that is not positive is measurement noise.
    rate = min(slope, second / large) if slope > 0.0 else second / large
    return second + rate * max(float(pixels) - large, 0.0)


def _measure_seconds(spec: MapSpec, execution: Execution) -> float:
    begun = time.thread_time()
    # In this thread, whose processor time is measured.
    require_complete(run_map(spec, execution.in_this_thread()))
    return time.thread_time() - begun
