"""Compute measures of a map, and the dataset of the measures at one value of a sweep."""

from __future__ import annotations

from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.jobs.job import Job, Queue
from engine.maps.compute import compute_map
from engine.maps.map_jobs import map_job
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.measured_map import MeasuredMap, SweepPoint
from engine.measures.table import MEASURES
from engine.slices.window import Window

if TYPE_CHECKING:
    import xarray as xr

# Number of additional orbits of a measure as a share of the usual number, small because a sweep measures many maps.
_SWEEP_EFFORT = 0.1


def measure_map(escape_map: EscapeMap, name: str, box: Window | None = None, *, execution: Execution = DEFAULT_EXECUTION) -> Any:
    """Return the result of the measure `name` for a complete map, or for a box in it; None if it is not defined there."""
    return MEASURES[name].compute(MeasuredMap(escape_map, box, execution))


def compute_point(
    point: SweepPoint, escape_map: EscapeMap | None = None, *, execution: Execution = DEFAULT_EXECUTION
) -> xr.Dataset:
    """Measure the map at one value of a sweep.

    Parameters
    ----------
    point
        The request.
    escape_map
        The map of `point.map_spec`; None to compute it.
    execution
        How the computation runs.

    Returns
    -------
    The dataset of the measures. Its first dimensions, of size 1, have the names of the axes of the sweep.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    # This import is slow.
    import xarray as xr

    if escape_map is None:
        escape_map = compute_map(point.map_spec, execution=execution.part(0, 2))
    if not escape_map.complete:
        raise CancelledError
    measured = MeasuredMap(escape_map, execution=execution.part(1, 2), effort=_SWEEP_EFFORT)
    variables: dict[str, Any] = {}
    for name in point.measures:
        variables |= MEASURES[name].variables(point, MEASURES[name].compute(measured))
    values = {name: ((), value, {"long_name": name, "units": "1"}) for name, value in point.place}
    return xr.Dataset(variables, values).expand_dims([name for name, _ in point.place])


def measure_job(spec: MapSpec, name: str, box: Window | None = None) -> Job[Any]:
    """Return the job of a measure of a map, or of the starts in a box. A measure with a `Measure.place` ignores the box."""
    measure = MEASURES[name]
    used_box = box if measure.place == "" else None
    # Slow measures make many short calls.
    queue = Queue.BACKGROUND if measure.slow else Queue.LONG_CALL
    return Job(measure_map, (map_job(spec), name, used_box), queue=queue)
