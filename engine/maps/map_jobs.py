"""Jobs of maps, and of the potentials along a parameter."""

from __future__ import annotations

from dataclasses import replace

from engine.jobs.cache import ResultCache
from engine.jobs.job import Job, Queue
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.slices.axes import ParameterAxis
from engine.slices.parameter_family import find_members
from engine.systems.system import TYPED


def map_job(spec: MapSpec, queue: Queue = Queue.FIRST_FRAME) -> Job[EscapeMap]:
    """Return the job of a map; the job continues a cached map that was interrupted or has a smaller t_max."""
    columns, rows = spec.resolution
    orbits = min(columns * rows, LARGEST_RUN)
    return Job(compute_map, (spec,), queue=queue, orbits=orbits, find_earlier=_find_shorter_map)


def members_job(axis: ParameterAxis | None) -> Job[None] | None:
    """Return the job that finds the potentials along a parameter of a typed formula, with limited resources; else None."""
    if axis is None or axis.system.case != TYPED:
        return None
    return Job(find_members, (axis,), queue=Queue.LIMITED)


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
