"""What can be asked of the background besides maps: frozen and hashable, so that a request is the key its answer is kept under.

Each request knows how it is answered on a `Bench`.
"""

from __future__ import annotations

from concurrent.futures import CancelledError
from dataclasses import dataclass, replace

from engine.bench import Bench
from engine.escape_law_fits import fit_escape_laws
from engine.escape_laws import EscapeLaws
from engine.escape_maps import EscapeMap
from engine.escape_statistics import compute_statistics
from engine.indicators import BirkhoffDigits, compute_birkhoff_digits
from engine.map_specs import MapSpec
from engine.metrics.basin_entropy import BasinEntropy, compute_basin_entropy
from engine.metrics.labels import ENTROPY_COUNTS_BOUNDED, MERGING_COUNTS_BOUNDED, exit_labels
from engine.metrics.merging import MergingTest, compute_merging
from engine.metrics.uncertainty import UncertaintyExponent, compute_uncertainty_exponent
from engine.orbits import Orbit, integrate_orbit
from engine.origin_fates import OriginFateMap, join_origin_fates
from engine.planes import Plane, Window
from engine.potential_review import PotentialReview, review_potential
from engine.potentials import Potential
from engine.preparation import is_ready_for_maps, prepare_for_maps
from engine.previews import compute_preview, preview_spec
from engine.regularity_maps import RegularityMap, judge_bounded_orbits
from engine.separations import Separation, compute_separation
from engine.stable_manifolds import StableManifolds, find_stable_manifolds
from engine.trust_maps import TrustMap, compute_trust
from engine.twins import Twin, find_twin


@dataclass(frozen=True)
class OrbitSpec:
    """The request for one orbit: `integrate_orbit`'s arguments, hashable."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, bench: Bench) -> Orbit:
        """Integrate it."""
        return bench.on_pool(integrate_orbit, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class DigitsSpec:
    """The request for the Birkhoff digits of an orbit: `compute_birkhoff_digits`' arguments, hashable."""

    potential: Potential
    state: tuple[float, float, float, float]
    t_max: float

    def run(self, bench: Bench) -> BirkhoffDigits:
        """Compute them."""
        return bench.on_pool(compute_birkhoff_digits, self.potential, self.state, self.t_max)


@dataclass(frozen=True)
class ReviewAnswer:
    """What a potential is like."""

    review: PotentialReview
    nbytes: int = 8192
    """About what it takes."""


@dataclass(frozen=True)
class ReviewSpec:
    """The request to look a potential over."""

    potential: Potential

    def run(self, bench: Bench) -> ReviewAnswer:
        """Look it over."""
        return ReviewAnswer(bench.executor.submit(review_potential, self.potential).result())


@dataclass(frozen=True)
class MapWish:
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
class Preparation:
    """A map that can be computed now: all is compiled, its window is known."""

    map_spec: MapSpec
    nbytes: int = 1024


@dataclass(frozen=True)
class PreparationSpec:
    """The request to compile what a map needs, and to find its window."""

    wish: MapWish

    def run(self, bench: Bench) -> Preparation:
        """Compile, where that has not been done; ValueError where there can be no such map."""
        if not is_ready_for_maps(self.wish.potential):
            bench.call_executor.submit(prepare_for_maps, self.wish.potential).result()
        return Preparation(self.wish.spec())


@dataclass(frozen=True)
class TwinAnswer:
    """A twin, or the knowledge that there is none."""

    twin: Twin | None
    nbytes: int = 1024
    """About what it takes together with its request."""


@dataclass(frozen=True)
class TwinSpec:
    """The request for the twin of a start: `find_twin`'s arguments, hashable."""

    potential: Potential
    plane: Plane
    energy: float | tuple[float, float]
    x: float
    ordinate: float
    t_max: float

    def run(self, bench: Bench) -> TwinAnswer:
        """Find it."""
        where = (self.potential, self.plane, self.energy, self.x, self.ordinate)
        return TwinAnswer(find_twin(*where, self.t_max, executor=bench.executor, cancel=bench.cancel))


@dataclass(frozen=True)
class SeparationSpec:
    """The request to compare two orbits: `compute_separation`'s arguments, hashable."""

    potential: Potential
    first: tuple[float, float, float, float]
    second: tuple[float, float, float, float]
    t_end: float

    def run(self, bench: Bench) -> Separation:
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
class PreviewSpec:
    """The request for a quick look at a map."""

    wish: MapWish

    def run(self, bench: Bench) -> Preview:
        """Compute it; ValueError where there can be no such map."""
        frame = compute_preview(preview_spec(self.wish.spec()), bench.executor, bench.cancel)
        if bench.cancel.is_set():
            raise CancelledError
        return Preview(frame)


@dataclass(frozen=True)
class RegularitySpec:
    """The request to judge the bounded orbits of a map."""

    map_spec: MapSpec

    def run(self, bench: Bench) -> RegularityMap:
        """Judge them, once the map is there."""
        return judge_bounded_orbits(bench.whole_map(self.map_spec), bench.publish, bench.cancel, bench.executor)


@dataclass(frozen=True)
class TrustSpec:
    """The request to try which pixels of a map are to be trusted."""

    map_spec: MapSpec

    def run(self, bench: Bench) -> TrustMap:
        """Try them, once the map is there."""
        return compute_trust(bench.whole_map(self.map_spec), bench.publish, bench.cancel, bench.executor)


@dataclass(frozen=True)
class OriginSpec:
    """The request to follow the orbits of a map into the past, too; `map_spec` is the one into the future."""

    map_spec: MapSpec

    def run(self, bench: Bench) -> OriginFateMap:
        """Join both maps, once they are there."""
        return join_origin_fates(*(bench.whole_map(replace(self.map_spec, backward=way)) for way in (False, True)))


@dataclass(frozen=True)
class ManifoldsSpec:
    """The request for the stable manifolds of the Lyapunov orbits: `find_stable_manifolds`' arguments, hashable."""

    potential: Potential
    energy: float
    images: int
    window: Window | None = None

    def run(self, bench: Bench) -> StableManifolds:
        """Find them."""
        return find_stable_manifolds(
            self.potential, self.energy, self.images, window=self.window, executor=bench.executor, cancel=bench.cancel
        )


@dataclass(frozen=True)
class BasinMeasures:
    """What is read off the pixels of a map: how mixed its basins are, and whether they share their boundary."""

    entropy: BasinEntropy
    merging: MergingTest

    @property
    def nbytes(self) -> int:
        """Bytes held."""
        return self.merging.shares.nbytes + 1024


@dataclass(frozen=True)
class BasinMeasuresSpec:
    """The request to measure the basins of a map."""

    map_spec: MapSpec

    def run(self, bench: Bench) -> BasinMeasures:
        """Measure them, once the map is there."""
        frame = bench.whole_map(self.map_spec)
        return BasinMeasures(
            compute_basin_entropy(*exit_labels(frame, bounded=ENTROPY_COUNTS_BOUNDED)),
            compute_merging(*exit_labels(frame, bounded=MERGING_COUNTS_BOUNDED)),
        )


@dataclass(frozen=True)
class EscapeLawsSpec:
    """The request to fit laws to the escape times of a map, or of the part of it in a box."""

    map_spec: MapSpec
    box: Window | None = None

    def run(self, bench: Bench) -> EscapeLaws:
        """Fit them, once the map is there."""
        statistics = compute_statistics(bench.whole_map(self.map_spec), self.box)
        return bench.on_pool(fit_escape_laws, statistics, self.map_spec.t_max)


@dataclass(frozen=True)
class UncertaintySpec:
    """The request for the uncertainty exponent of a map's window."""

    map_spec: MapSpec

    def run(self, bench: Bench) -> UncertaintyExponent:
        """Measure it by new pairs of starts."""
        return compute_uncertainty_exponent(self.map_spec, executor=bench.executor, cancel=bench.cancel)
