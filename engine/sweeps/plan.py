"""Estimates of the cost of sweeps."""

from __future__ import annotations

import itertools
import time
from concurrent.futures import CancelledError
from dataclasses import dataclass, replace

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.foundations.validation import checked_count, checks_types
from engine.foundations.wording import format_count
from engine.maps.compute import compute_map
from engine.maps.result import PIXEL_ARRAYS
from engine.maps.spec import MapSpec
from engine.maps.warmup import prepare_for_evidence, prepare_for_maps
from engine.sweeps.spec import SweepSpec

# Sides in pixels of the coarse maps on which plans are based. From two sizes follows the cost that does not depend on the size.
_COARSE_SIDES = (48, 96)
# Largest number of values at which these maps are computed.
_MAX_PLANNED_VALUES = 12

MOST_CORES = 1_000_000
"""Largest number of workers of a plan."""


@dataclass(frozen=True)
class SweepPlan:
    """The estimated cost of a sweep.

    Attributes
    ----------
    orbits
        Number of starts at all values, including forbidden and outside starts.
    seconds
        Wall time in seconds if all workers are busy throughout.
    bytes
        Size of the arrays of the maps before compression, an upper bound for the size of their store.
    cores
        Number of workers.
    """

    orbits: int
    seconds: float
    bytes: int
    cores: int

    def describe(self) -> str:
        """Return the plan in a sentence."""
        hours = self.seconds / 3600.0
        wall_time = f"{hours:.3g} hours" if hours >= 1.0 else f"{self.seconds:.3g} s"
        core_time = f"{hours * self.cores:.3g} core hours"
        cores = format_count(self.cores, "core")
        return f"{self.orbits:.3g} orbits: about {wall_time} on {cores} ({core_time}), at most {self.bytes / 1e9:.3g} GB"


@checks_types(spec=SweepSpec, execution=Execution)
def plan_sweep(spec: SweepSpec, *, cores: int | None = None, execution: Execution = DEFAULT_EXECUTION) -> SweepPlan:
    """Estimate the cost of a sweep of maps from the processor time of coarse maps, 48 and 96 pixels a side, at up to 12 values.

    For larger maps the cost grows at most linearly with the number of pixels, and more slowly if invariant curves enclose many
    orbits. In trials with 40 maps the estimate was correct to within a fifth. At t_max = 1e5 planning takes some seconds, or a
    minute or more if many orbits are bounded and evidence is found for few.

    Parameters
    ----------
    spec
        The request; the plan does not include the cost of its measures.
    cores
        Number of workers, 1 or more; by default that of `execution`.
    execution
        How the sweep will run. Only the number of its workers is used; all are assumed to be as fast as this core.

    Returns
    -------
    The plan, with the number of `orbits`, the wall time in `seconds` if all `cores` are busy, and the `bytes` of the arrays of
    the maps; `describe` puts these numbers in a sentence.

    Raises
    ------
    ValueError
        When `cores` is less than 1, or no exit is defined at one of the values.
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
    prepare_for_maps(spec.potential)
    prepare_for_evidence(spec.potential)
    places = list(itertools.product(*spec.axis_values))
    indices = np.unique(((np.arange(_MAX_PLANNED_VALUES) + 0.5) * len(places) / _MAX_PLANNED_VALUES).astype(int))
    seconds = [_predict_seconds(spec.point(*places[index]).map_spec, execution) for index in indices]
    pixel_bytes = sum(np.dtype(dtype).itemsize for name, (dtype, _) in PIXEL_ARRAYS.items() if name != "started")
    orbits = spec.map_count * spec.resolution[0] * spec.resolution[1]
    return SweepPlan(orbits, spec.map_count * float(np.mean(seconds)) / workers, orbits * pixel_bytes, workers)


def _predict_seconds(spec: MapSpec, execution: Execution) -> float:
    """Predict the processor time of one map in seconds, extrapolated linearly from two coarse maps."""
    pixel_count = np.prod(spec.resolution)
    small_count, large_count = (side * side for side in _COARSE_SIDES)
    small_seconds, large_seconds = (measure_seconds(replace(spec, resolution=(side, side)), execution) for side in _COARSE_SIDES)
    slope, mean = (large_seconds - small_seconds) / (large_count - small_count), large_seconds / large_count
    # A slope of 0 or less is measurement noise.
    seconds_per_pixel = min(slope, mean) if slope > 0.0 else mean
    return large_seconds + seconds_per_pixel * max(float(pixel_count) - large_count, 0.0)


def measure_seconds(spec: MapSpec, execution: Execution) -> float:
    """Measure the processor time of a map in seconds; CancelledError if its computation is cancelled."""
    begin = time.thread_time()
    # The map is computed in this thread, because its processor time is measured.
    if not compute_map(spec, execution=execution.in_this_thread()).complete:
        raise CancelledError
    return time.thread_time() - begin
