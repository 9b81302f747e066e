"""Long runs: maps at many energies, kept in a store as they are finished, so that a run that was stopped goes on from there."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from engine.escape_maps import IMAGES, EscapeMap
from engine.lyapunov_orbits import exit_curves
from engine.map_runs import MapRun
from engine.map_specs import MapSpec
from engine.maps import LARGEST_RUN, compute_map
from engine.orbit_batches import SerialExecutor, count_workers, default_executor
from engine.planes import Plane, Window
from engine.potentials import Potential
from engine.preparation import prepare_kernels
from engine.sweep_stores import SweepStore, create_store
from engine.swept_energies import checked_sweep

MOST_SWEPT_ENERGIES = 10_000
"""Most energies of a stored sweep: each is some files in every array's folder."""

# A plan is made from maps of these sides at this many energies. The smaller one is mostly what any map costs, whatever its size.
_COARSE_SIDES = (48, 96)
_PLANNED_ENERGIES = 12


@dataclass(frozen=True)
class SweepSpec:
    """A sweep of maps over energies on one plane and in one window, so that all of it is one labelled block.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        (x, y) or (x, px).
    energies
        h, finite, dimensionless, 1 to 10 000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy, each 1 to 4096.
    window
        As of `MapSpec`, for all energies; None for the default window of the highest one. The interior grows with h on both
        planes of the three cases, so that this window contains those of the other energies.
    t_max
        How long orbits are followed, 0 < t_max ≤ 1e8.
    certify
        As of `MapSpec`.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Plane
    energies: tuple[float, ...]
    resolution: tuple[int, int] = (225, 225)
    window: Window | None = None
    t_max: float = 1e5
    certify: bool = True

    def __post_init__(self) -> None:
        plane, energies = checked_sweep(self.plane, self.energies, MOST_SWEPT_ENERGIES)
        highest = MapSpec(
            self.potential, plane, energies[-1], self.resolution, self.window, self.t_max, self.certify  # type: ignore[arg-type]
        )  # fmt: skip
        object.__setattr__(self, "energies", energies)
        for name in ("plane", "resolution", "window", "t_max", "certify"):
            object.__setattr__(self, name, getattr(highest, name))

    def map_spec(self, energy: float) -> MapSpec:
        """The request for the map at one energy."""
        assert self.window is not None
        return MapSpec(self.potential, self.plane, energy, self.resolution, self.window, self.t_max, self.certify)

    def provenance(self) -> dict[str, Any]:
        """What all maps have in common, in plain values; see `MapSpec.provenance`."""
        common = self.map_spec(self.energies[-1]).provenance()
        return {name: value for name, value in common.items() if name != "energy"}

    def coordinates(self) -> dict[str, np.ndarray]:
        """h (energies,), y or px (rows,), x (columns,): the dimensions of the block."""
        x, ordinate = self.map_spec(self.energies[-1]).pixel_centres()
        return {"h": np.array(self.energies), self.plane.ordinate: ordinate, "x": x}

    @property
    def orbits(self) -> int:
        """How many starts there are at all energies together, forbidden and outside ones included."""
        return len(self.energies) * self.resolution[0] * self.resolution[1]


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
    are on the disk; one that was under way when the run was killed is computed again, one that is done never.

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
        When the store cannot be written to; energies done stay valid.
    concurrent.futures.CancelledError
        When cancelled.
    """
    for energy in (spec.energies[0], spec.energies[-1]):
        exit_curves(spec.potential, energy)
    sweep = _open_store(spec, Path(store))
    pending = sweep.pending()
    if pending:
        sweep.check_writable()
    count = len(spec.energies)
    for already, place in enumerate(pending, start=count - len(pending)):
        on_frame = _report_share(on_progress, already, count)
        sweep.write(place, _compute_whole_map(spec.map_spec(spec.energies[place]), on_frame, cancel, executor).to_xarray())
    if on_progress is not None:
        on_progress(1.0)
    return sweep.open_dataset()


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


def _report_share(on_progress: Callable[[float], None] | None, already: int, count: int) -> Callable[[EscapeMap], None] | None:
    """Say how many energies are done, and what to call with the frames of the next; None when nobody listens."""
    if on_progress is None:
        return None
    on_progress(already / count)
    return lambda frame: on_progress((already + frame.progress) / count)


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
    if cores is not None and cores < 1:
        raise ValueError(f"cores={cores}: must be 1 or more")
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
