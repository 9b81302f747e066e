"""Jobs of maps, of their measures, and of sweeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from engine.foundations.execution import Execution
from engine.jobs.cache import ResultCache
from engine.jobs.job import Job, Queue
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.slices.axes import ParameterAxis
from engine.slices.parameter_family import find_members
from engine.slices.window import Window
from engine.sweeps.measured_map import SweepPoint
from engine.sweeps.measures import MEASURES, compute_point, measure_map
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import Sweep, compute_sweep
from engine.systems.system import TYPED

if TYPE_CHECKING:
    import xarray as xr


def map_job(spec: MapSpec) -> Job[EscapeMap]:
    """Return the job of a map; the job continues a cached map that was interrupted or has a smaller t_max."""
    columns, rows = spec.resolution
    orbits = min(columns * rows, LARGEST_RUN)
    return Job(compute_map, (spec,), queue=Queue.FIRST_FRAME, orbits=orbits, find_earlier=_find_shorter_map)


def members_job(axis: ParameterAxis | None) -> Job[None] | None:
    """Return the job that finds the potentials along a parameter of a typed formula, with limited resources; else None."""
    if axis is None or axis.system.case != TYPED:
        return None
    return Job(find_members, (axis,), queue=Queue.LIMITED)


def measure_job(spec: MapSpec, name: str, box: Window | None = None) -> Job[Any]:
    """Return the job of a measure of a map, or of the starts in a box. A measure with a `Measure.place` ignores the box."""
    measure = MEASURES[name]
    used_box = box if measure.place == "" else None
    # Slow measures make many short calls.
    queue = Queue.BACKGROUND if measure.slow else Queue.LONG_CALL
    return Job(measure_map, (map_job(spec), name, used_box), queue=queue)


def sweep_job(spec: SweepSpec) -> Job[Sweep]:
    """Return the job of a sweep; the measures at each value are cached separately."""
    return Job(_compute_sweep, (spec,))


def _find_shorter_map(job: Job[EscapeMap], cache: ResultCache) -> EscapeMap | None:
    """Return the cached map, otherwise equal, with the largest t_max up to that of the job; None unless it can be resumed."""
    (spec,) = job.arguments
    cached_specs = (key.arguments[0] for key in cache if isinstance(key, Job) and key.function is compute_map)
    # Energies are compared first, because this is cheap and there may be thousands of maps.
    specs_of_energy = (cached for cached in cached_specs if cached.energy == spec.energy)
    shorter = [cached for cached in specs_of_energy if cached.t_max <= spec.t_max and replace(cached, t_max=spec.t_max) == spec]
    if not shorter:
        return None
    # The map may have been evicted since.
    longest: EscapeMap | None = cache.get(map_job(max(shorter, key=lambda cached: cached.t_max)))
    return longest if longest is not None and longest.batch is not None else None


def _measure_point(point: SweepPoint, escape_map: EscapeMap, *, execution: Execution) -> xr.Dataset:
    """Return the measures at one value of a sweep. The job manager passes the map in place of its job."""
    return compute_point(point, escape_map=escape_map, execution=execution)


def _compute_sweep(
    spec: SweepSpec,
    *,
    on_frame: Callable[[Sweep], None] | None = None,
    execution: Execution,
    find_result: Callable[[Job[Any]], Any],
) -> Sweep:
    """Compute a sweep. The job manager passes the keyword arguments; `find_result` returns the results of other jobs."""
    members = members_job(spec.along)
    if members is not None:
        # The potentials of a typed formula must be found with limited resources before they are used in this process.
        find_result(members)

    def measure(point: SweepPoint) -> xr.Dataset:
        return find_result(Job(_measure_point, (point, map_job(point.map_spec))))

    return compute_sweep(spec, on_frame=on_frame, execution=execution, measure=measure)
