"""The job of a sweep, which shares maps and measured values with other jobs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from engine.foundations.execution import Execution
from engine.jobs.job import Job
from engine.maps.map_jobs import map_job, members_job
from engine.measures.compute import compute_point
from engine.measures.measured_map import SweepPoint
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import Sweep, compute_sweep

if TYPE_CHECKING:
    import xarray as xr


def sweep_job(spec: SweepSpec) -> Job[Sweep]:
    """Return the job of a sweep; the measures at each value are cached separately."""
    return Job(_compute_sweep, (spec,))


def _compute_sweep(
    spec: SweepSpec,
    *,
    on_frame: Callable[[Sweep], None] | None = None,
    execution: Execution,
    find_result: Callable[[Job[Any]], Any],
) -> Sweep:
    """Compute a sweep. The job manager passes the keyword arguments; `find_result` returns the results of other jobs."""
    for axis in spec.searched_axes:
        members = members_job(axis)
        if members is not None:
            # The potentials of a typed formula must be found with limited resources before they are used in this process.
            find_result(members)

    def measure(point: SweepPoint) -> xr.Dataset:
        return find_result(Job(compute_point, (point, map_job(point.map_spec))))

    return compute_sweep(spec, on_frame=on_frame, execution=execution, measure=measure)
