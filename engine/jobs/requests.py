"""What can be asked of the background besides maps: frozen and hashable, so that a request is the key its answer is kept under.

Each request knows how it is answered on a `JobContext`.
"""

from __future__ import annotations

from concurrent.futures import CancelledError
from dataclasses import dataclass, replace

from engine.basins.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.basins.labels import ENTROPY_COUNTS_BOUNDED, WADA_COUNTS_BOUNDED, exit_labels
from engine.basins.uncertainty_exponent import UncertaintyExponent, compute_uncertainty_exponent
from engine.basins.wada import WadaTest, compute_wada_test
from engine.dynamics.planes import Plane, Window
from engine.invariant_sets.stable_manifolds import StableManifolds, find_stable_manifolds
from engine.jobs.context import JobContext
from engine.maps.origin_fates import OriginFateMap, join_origin_fates
from engine.maps.preview import compute_preview, preview_spec
from engine.maps.regularity import RegularityMap, compute_regularity
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.maps.trust import TrustMap, compute_trust
from engine.potentials.potential import Potential
from engine.potentials.validation_report import PotentialReview, review_potential
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
from engine.trajectories.nearest_divergent_start import Twin, find_twin
from engine.trajectories.separation import Separation, compute_separation
from engine.trajectories.trajectory import Orbit, integrate_orbit
from engine.warmup import is_ready_for_maps, prepare_for_maps


@dataclass(frozen=True)
class OrbitRequest:
    """The request for one orbit: `integrate_orbit`'s arguments, hashable."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, bench: JobContext) -> Orbit:
        """Integrate it."""
        return bench.on_pool(integrate_orbit, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class BirkhoffDigitsRequest:
    """The request for the Birkhoff digits of an orbit: `compute_birkhoff_digits`' arguments, hashable."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, bench: JobContext) -> BirkhoffDigits:
        """Compute them."""
        return bench.on_pool(compute_birkhoff_digits, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class PotentialReviewAnswer:
    """What a potential is like."""

    review: PotentialReview
    nbytes: int = 8192
    """About what it takes."""


@dataclass(frozen=True)
class PotentialReviewRequest:
    """The request to look a potential over."""

    potential: Potential

    def run(self, bench: JobContext) -> PotentialReviewAnswer:
        """Look it over."""
        return PotentialReviewAnswer(bench.executor.submit(review_potential, self.potential).result())


@dataclass(frozen=True)
class UnresolvedMapSpec:
    """A map as it is wished for: `MapSpec`'s arguments, hashable, before a window is found and anything is checked."""

    potential: Potential
    plane: Plane
    energy: float | tuple[float, float]
    resolution: tuple[int, int]
    window: Window | None
    t_max: float

    def spec(self) -> MapSpec:
        """The request for it: to find the whole interior takes Lyapunov orbits, thus milliseconds and a compiled integrator."""
        where = (self.potential, self.plane, self.energy, self.resolution)
        return MapSpec(*where, self.window, self.t_max)  # type: ignore[arg-type]  # None is replaced


@dataclass(frozen=True)
class WarmupAnswer:
    """A map that can be computed now: all is compiled, its window is known."""

    map_spec: MapSpec
    nbytes: int = 1024


@dataclass(frozen=True)
class WarmupRequest:
    """The request to compile what a map needs, and to find its window."""

    wish: UnresolvedMapSpec

    def run(self, bench: JobContext) -> WarmupAnswer:
        """Compile, where that has not been done; ValueError where there can be no such map."""
        if not is_ready_for_maps(self.wish.potential):
            bench.call_executor.submit(prepare_for_maps, self.wish.potential).result()
        return WarmupAnswer(self.wish.spec())


@dataclass(frozen=True)
class DivergentStartAnswer:
    """A twin, or the knowledge that there is none."""

    twin: Twin | None
    nbytes: int = 1024
    """About what it takes together with its request."""


@dataclass(frozen=True)
class DivergentStartRequest:
    """The request for the twin of a start: `find_twin`'s arguments, hashable."""

    potential: Potential
    plane: Plane
    energy: float | tuple[float, float]
    x: float
    ordinate: float
    t_max: float

    def run(self, bench: JobContext) -> DivergentStartAnswer:
        """Find it."""
        where = (self.potential, self.plane, self.energy, self.x, self.ordinate)
        return DivergentStartAnswer(find_twin(*where, self.t_max, executor=bench.executor, cancel=bench.cancel))


@dataclass(frozen=True)
class SeparationRequest:
    """The request to compare two orbits: `compute_separation`'s arguments, hashable."""

    potential: Potential
    first: tuple[float, float, float, float]
    second: tuple[float, float, float, float]
    t_end: float

    def run(self, bench: JobContext) -> Separation:
        """Follow both."""
        return bench.on_pool(compute_separation, self.potential, self.first, self.second, self.t_end)


@dataclass(frozen=True, eq=False)
class Preview:
    """A quick look at a map, as it is kept: whole, for what it is."""

    frame: EscapeMap

    @property
    def nbytes(self) -> int:
        """Bytes held."""
        return self.frame.nbytes


@dataclass(frozen=True)
class PreviewRequest:
    """The request for a quick look at a map."""

    wish: UnresolvedMapSpec

    def run(self, bench: JobContext) -> Preview:
        """Compute it; ValueError where there can be no such map."""
        frame = compute_preview(preview_spec(self.wish.spec()), bench.executor, bench.cancel)
        if bench.cancel.is_set():
            raise CancelledError
        return Preview(frame)


@dataclass(frozen=True)
class RegularityRequest:
    """The request to judge the bounded orbits of a map."""

    map_spec: MapSpec

    def run(self, bench: JobContext) -> RegularityMap:
        """Judge them, once the map is there."""
        return compute_regularity(bench.whole_map(self.map_spec), bench.publish, bench.cancel, bench.executor)


@dataclass(frozen=True)
class TrustRequest:
    """The request to try which pixels of a map are to be trusted."""

    map_spec: MapSpec

    def run(self, bench: JobContext) -> TrustMap:
        """Try them, once the map is there."""
        return compute_trust(bench.whole_map(self.map_spec), bench.publish, bench.cancel, bench.executor)


@dataclass(frozen=True)
class OriginFateRequest:
    """The request to follow the orbits of a map into the past, too; `map_spec` is the one into the future."""

    map_spec: MapSpec

    def run(self, bench: JobContext) -> OriginFateMap:
        """Join both maps, once they are there."""
        return join_origin_fates(*(bench.whole_map(replace(self.map_spec, backward=way)) for way in (False, True)))


@dataclass(frozen=True)
class StableManifoldsRequest:
    """The request for the stable manifolds of the Lyapunov orbits: `find_stable_manifolds`' arguments, hashable."""

    potential: Potential
    energy: float
    images: int
    window: Window | None = None

    def run(self, bench: JobContext) -> StableManifolds:
        """Find them."""
        return find_stable_manifolds(
            self.potential, self.energy, self.images, window=self.window, executor=bench.executor, cancel=bench.cancel
        )


@dataclass(frozen=True)
class BasinMeasures:
    """What is read off the pixels of a map: how mixed its basins are, and whether they share their boundary."""

    entropy: BasinEntropy
    merging: WadaTest

    @property
    def nbytes(self) -> int:
        """Bytes held."""
        return self.merging.shares.nbytes + 1024


@dataclass(frozen=True)
class BasinMeasuresRequest:
    """The request to measure the basins of a map."""

    map_spec: MapSpec

    def run(self, bench: JobContext) -> BasinMeasures:
        """Measure them, once the map is there."""
        frame = bench.whole_map(self.map_spec)
        return BasinMeasures(
            compute_basin_entropy(*exit_labels(frame.fate, bounded=ENTROPY_COUNTS_BOUNDED)),
            compute_wada_test(*exit_labels(frame.fate, bounded=WADA_COUNTS_BOUNDED)),
        )


@dataclass(frozen=True)
class DecayLawsRequest:
    """The request to fit laws to the escape times of a map, or of the part of it in a box."""

    map_spec: MapSpec
    box: Window | None = None

    def run(self, bench: JobContext) -> DecayLaws:
        """Fit them, once the map is there."""
        statistics = compute_statistics(bench.whole_map(self.map_spec), self.box)
        return bench.on_pool(fit_decay_laws, statistics, self.map_spec.t_max)


@dataclass(frozen=True)
class UncertaintyExponentRequest:
    """The request for the uncertainty exponent of a map's window."""

    map_spec: MapSpec

    def run(self, bench: JobContext) -> UncertaintyExponent:
        """Measure it by new pairs of starts."""
        return compute_uncertainty_exponent(self.map_spec, executor=bench.executor, cancel=bench.cancel)


@dataclass(frozen=True)
class EnergyPointRequest:
    """The request to measure the exits at one energy."""

    point_spec: EnergyPointSpec

    def run(self, bench: JobContext) -> EnergyPoint:
        """Measure them, once the map is there."""
        whole_map = bench.whole_map(self.point_spec.map_spec)
        return compute_energy_point(self.point_spec, bench.cancel, bench.executor, whole_map=whole_map)


@dataclass(frozen=True)
class EnergyCurvesRequest:
    """The request for curves against energy; each energy is cached for other requests."""

    curves_spec: EnergyCurvesSpec

    def run(self, bench: JobContext) -> EnergyCurves:
        """Measure all energies."""

        def measure(point_spec: EnergyPointSpec) -> EnergyPoint:
            point: EnergyPoint = bench.answer(EnergyPointRequest(point_spec))
            return point

        return compute_energy_curves(self.curves_spec, bench.publish, bench.cancel, bench.executor, measure=measure)
