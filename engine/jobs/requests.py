"""Requests of `Jobs` other than maps: frozen and hashable, so that each is the key of its result in the cache."""

from __future__ import annotations

from dataclasses import dataclass, replace

from engine.basins.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.basins.uncertainty_exponent import UncertaintyExponent, compute_uncertainty_exponent
from engine.basins.wada import WadaTest, compute_wada_test
from engine.invariant_sets.stable_manifolds import StableManifolds, find_stable_manifolds
from engine.jobs.context import JobContext
from engine.maps.origin_fates import OriginFateMap, join_origin_fates
from engine.maps.regularity import RegularityMap, compute_regularity
from engine.maps.spec import MapSpec
from engine.maps.trust import TrustMap, compute_trust
from engine.potentials.potential import Potential
from engine.slices.slice import Energy, Slice
from engine.slices.window import Window
from engine.statistics.decay_law_fits import fit_decay_laws
from engine.statistics.decay_laws import DecayLaws
from engine.statistics.escape_statistics import compute_statistics
from engine.sweeps.energy_curves import (
    EnergyCurves,
    EnergyCurvesSpec,
    EnergyPoint,
    EnergyPointSpec,
    compute_energy_curves,
    compute_energy_point,
)
from engine.trajectories.chaos_indicators import BirkhoffDigits, compute_birkhoff_digits
from engine.trajectories.nearest_divergent_start import DivergentStart, find_divergent_start
from engine.trajectories.separation import Separation, compute_separation
from engine.trajectories.trajectory import Orbit, integrate_orbit
from engine.warmup import is_ready_for_maps, prepare_for_maps


@dataclass(frozen=True)
class Answer[T]:
    """A final result that has no `nbytes` of its own, or is None.

    Attributes
    ----------
    value
        The result.
    nbytes
        Approximate size in bytes, including the request.
    """

    value: T
    nbytes: int = 1024


@dataclass(frozen=True)
class OrbitRequest:
    """Request for one orbit: the arguments of `integrate_orbit`."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, context: JobContext) -> Orbit:
        """Integrate the orbit."""
        return context.run_long_call(integrate_orbit, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class BirkhoffDigitsRequest:
    """Request for the convergence of Birkhoff averages: the arguments of `compute_birkhoff_digits`."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, context: JobContext) -> BirkhoffDigits:
        """Compute the digits."""
        return context.run_long_call(compute_birkhoff_digits, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class SeparationRequest:
    """Request for the distance of two orbits against time: the arguments of `compute_separation`."""

    potential: Potential
    first: tuple[float, float, float, float]
    second: tuple[float, float, float, float]
    t_end: float

    def run(self, context: JobContext) -> Separation:
        """Integrate both orbits."""
        return context.run_long_call(compute_separation, self.potential, self.first, self.second, self.t_end)


@dataclass(frozen=True)
class DivergentStartRequest:
    """Request for the nearest start with another fate: the arguments of `find_divergent_start`."""

    potential: Potential
    plane: Slice
    energy: Energy
    x: float
    ordinate: float
    t_max: float

    def run(self, context: JobContext) -> Answer[DivergentStart | None]:
        """Search for it; the value is None if there is none."""
        start = (self.potential, self.plane, self.energy, self.x, self.ordinate)
        return Answer(find_divergent_start(*start, self.t_max, executor=context.executor, cancel=context.cancel))


@dataclass(frozen=True)
class WarmupRequest:
    """Request to compile the kernels of a map and find its window."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> Answer[MapSpec]:
        """Compile what is not compiled yet. Raises ValueError if the spec is not valid."""
        if not is_ready_for_maps(self.map_spec.potential):
            context.compilation_executor.submit(prepare_for_maps, self.map_spec.potential).result()
        self.map_spec.find_window()
        return Answer(self.map_spec)


@dataclass(frozen=True)
class RegularityRequest:
    """Request for the regularity of the bounded orbits of a map: `compute_regularity`."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> RegularityMap:
        """Classify the bounded orbits of the complete map."""
        return compute_regularity(
            context.complete_map(self.map_spec), on_frame=context.publish, cancel=context.cancel, executor=context.executor
        )


@dataclass(frozen=True)
class TrustRequest:
    """Request for the trust in each pixel of a map: `compute_trust`."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> TrustMap:
        """Test the pixels of the complete map."""
        return compute_trust(
            context.complete_map(self.map_spec), on_frame=context.publish, cancel=context.cancel, executor=context.executor
        )


@dataclass(frozen=True)
class OriginFateRequest:
    """Request for the exits of orbits in the past and the future; `map_spec` is the map forward in time."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> OriginFateMap:
        """Join the maps of both directions of time."""
        forward, backward = (context.complete_map(replace(self.map_spec, backward=backward)) for backward in (False, True))
        return join_origin_fates(forward, backward)


@dataclass(frozen=True)
class StableManifoldsRequest:
    """Request for the stable manifolds of the Lyapunov orbits: the arguments of `find_stable_manifolds`."""

    potential: Potential
    energy: float
    images: int
    window: Window | None = None

    def run(self, context: JobContext) -> StableManifolds:
        """Compute the manifolds."""
        return find_stable_manifolds(
            self.potential, self.energy, images=self.images, window=self.window, executor=context.executor, cancel=context.cancel
        )


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


@dataclass(frozen=True)
class BasinMeasuresRequest:
    """Request for the basin entropy and the Wada test of a map."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> BasinMeasures:
        """Evaluate the complete map."""
        escape_map = context.complete_map(self.map_spec)
        return BasinMeasures(
            compute_basin_entropy(escape_map),
            compute_wada_test(escape_map),
        )


@dataclass(frozen=True)
class DecayLawsRequest:
    """Request for the decay laws of the escape times of a map, or of the part of it in a box: `fit_decay_laws`."""

    map_spec: MapSpec
    box: Window | None = None

    def run(self, context: JobContext) -> DecayLaws:
        """Fit the laws to the complete map."""
        statistics = compute_statistics(context.complete_map(self.map_spec), self.box)
        return context.run_long_call(fit_decay_laws, statistics, self.map_spec.t_max)


@dataclass(frozen=True)
class UncertaintyExponentRequest:
    """Request for the uncertainty exponent in the window of a map: `compute_uncertainty_exponent`."""

    map_spec: MapSpec

    def run(self, context: JobContext) -> UncertaintyExponent:
        """Measure it with new pairs of starts."""
        return compute_uncertainty_exponent(self.map_spec, executor=context.executor, cancel=context.cancel)


@dataclass(frozen=True)
class EnergyPointRequest:
    """Request for the measures at one energy: `compute_energy_point`."""

    point_spec: EnergyPointSpec

    def run(self, context: JobContext) -> EnergyPoint:
        """Evaluate the complete map."""
        frame = context.complete_map(self.point_spec.map_spec)
        return compute_energy_point(self.point_spec, cancel=context.cancel, executor=context.executor, frame=frame)


@dataclass(frozen=True)
class EnergyCurvesRequest:
    """Request for measures against energy: `compute_energy_curves`. The result at each energy is cached separately."""

    curves_spec: EnergyCurvesSpec

    def run(self, context: JobContext) -> EnergyCurves:
        """Evaluate all energies."""
        return compute_energy_curves(
            self.curves_spec, on_frame=context.publish, cancel=context.cancel, executor=context.executor,
            measure=lambda point_spec: context.result(EnergyPointRequest(point_spec)),
        )  # fmt: skip
