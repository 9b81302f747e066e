"""Jobs of maps, and of the analyses that need a complete map."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from engine.foundations.execution import Execution
from engine.jobs.cache import ResultCache
from engine.jobs.job import Job, Queue
from engine.maps.compute import LARGEST_RUN, compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.measures.decay_law_fits import fit_decay_laws
from engine.measures.decay_laws import DecayLaws
from engine.measures.escape_statistics import compute_statistics, pixels_inside
from engine.measures.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.measures.wada import WadaTest, compute_wada_test
from engine.slices.axes import ParameterAxis
from engine.slices.parameter_family import find_members
from engine.slices.window import Window
from engine.sweeps.measures import SweepPoint, compute_point
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import Sweep, compute_sweep
from engine.systems.system import TYPED
from engine.trajectories.flux import EscapeFlux, compute_flux

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class BasinMeasures:
    """Measures of the basins of escape that need only the pixels of a map.

    Attributes
    ----------
    entropy
        Basin entropy.
    merging
        Merging test for Wada basins.
    """

    entropy: BasinEntropy
    merging: WadaTest

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return self.merging.shares.nbytes + 1024


def map_job(spec: MapSpec) -> Job[EscapeMap]:
    """The job of a map; it continues an interrupted map, or one with a shorter t_max."""
    columns, rows = spec.resolution
    orbits = min(columns * rows, LARGEST_RUN)
    return Job(compute_map, (spec,), queue=Queue.FIRST_FRAME, orbits=orbits, find_earlier=_find_shorter_map)


def members_job(axis: ParameterAxis | None) -> Job[None] | None:
    """The job that finds the potentials along a parameter of a typed formula within limits, before maps need them; else None."""
    if axis is None or axis.system.case != TYPED:
        return None
    return Job(find_members, (axis,), queue=Queue.LIMITED)


def basin_measures_job(spec: MapSpec, box: Window | None = None) -> Job[BasinMeasures]:
    """The job of the basin entropy and the Wada test of a map, or of the pixels in a box."""
    return Job(_measure_basins, (map_job(spec), box))


def decay_laws_job(spec: MapSpec, box: Window | None = None) -> Job[DecayLaws]:
    """The job of the decay laws of a map's escape times, or of those in a box."""
    return Job(_fit_laws, (map_job(spec), box), queue=Queue.LONG_CALL)


def flux_job(spec: MapSpec) -> Job[EscapeFlux] | None:
    """The job of the flux through the exits at the energy of a map; None on a slice of several energies or potentials."""
    several = spec.common_energy is None or spec.plane.parameter is not None
    return None if several else Job(compute_flux, (spec.potential, spec.common_energy))


def sweep_job(spec: SweepSpec) -> Job[Sweep]:
    """The job of a sweep; the measures at each value are cached separately."""
    return Job(_compute_sweep, (spec,))


def _find_shorter_map(job: Job[EscapeMap], cache: ResultCache) -> EscapeMap | None:
    """The cached map that differs by the smallest reduction of t_max and can be resumed."""
    (spec,) = job.arguments
    maps = (key.arguments[0] for key in cache if isinstance(key, Job) and key.function is compute_map)
    # Compare energies first: cheap, and there may be thousands of maps.
    same_energy = (key for key in maps if key.energy == spec.energy)
    shorter = [key for key in same_energy if key.t_max <= spec.t_max and replace(key, t_max=spec.t_max) == spec]
    found: EscapeMap | None = cache.get(map_job(max(shorter, key=lambda key: key.t_max))) if shorter else None
    return found if found is not None and found.batch is not None else None


def _measure_basins(escape_map: EscapeMap, box: Window | None) -> BasinMeasures:
    fate = escape_map.fate[pixels_inside(escape_map, box)]
    entropy = compute_basin_entropy(*exit_labels(fate, bounded=ENTROPY_COUNTS_BOUNDED))
    return BasinMeasures(entropy, compute_wada_test(*exit_labels(fate, bounded=WADA_COUNTS_BOUNDED)))


def _fit_laws(escape_map: EscapeMap, box: Window | None) -> DecayLaws:
    return fit_decay_laws(compute_statistics(escape_map, box))


def _measure_point(point: SweepPoint, frame: EscapeMap, *, execution: Execution) -> xr.Dataset:
    return compute_point(point, frame=frame, execution=execution)


def _compute_sweep(
    spec: SweepSpec,
    *,
    on_frame: Callable[[Sweep], None],
    execution: Execution,
    find_result: Callable[[Job[Any]], Any],
) -> Sweep:
    members = members_job(spec.along)
    if members is not None:
        find_result(members)

    def measure(point: SweepPoint) -> xr.Dataset:
        measured: xr.Dataset = find_result(Job(_measure_point, (point, map_job(point.map_spec))))
        return measured

    return compute_sweep(spec, on_frame=on_frame, execution=execution, measure=measure)
