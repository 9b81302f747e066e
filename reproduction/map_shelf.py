"""Cache of the maps and analyses that figures and tables need; each is computed once, on first use."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import replace

from engine import (
    CASES,
    EscapeMap,
    Execution,
    MapSpec,
    Plane,
    RegularityMap,
    Slice,
    Sweep,
    SweepSpec,
    UncertaintyExponent,
    Window,
    compute_regularity,
    compute_sweep,
    compute_uncertainty_exponent,
)
from engine.execution import DEFAULT_EXECUTION
from engine.maps.compute import run_map
from engine.sweeps.measures import compute_point
from reproduction.analyses.super_sticky import SuperStickySearch, find_super_sticky_orbits
from reproduction.paper_ranges import STICKY_CASE, STICKY_ENERGY, curve_energies
from reproduction.quality import Quality


class MapShelf:
    """Complete maps of one quality, stored without the state of their orbits, and analyses of them.

    Parameters
    ----------
    quality
        Resolution.
    execution
        How the computations run; when it is cancelled, they raise CancelledError.
    on_map
        Called with each computed map.
    """

    def __init__(
        self,
        quality: Quality,
        execution: Execution = DEFAULT_EXECUTION,
        on_map: Callable[[EscapeMap], None] = lambda frame: None,
    ) -> None:
        self.quality = quality
        self.execution = execution
        self._on_map = on_map
        self._maps: dict[MapSpec, EscapeMap] = {}
        self._curves: dict[tuple[str, Slice], Sweep] = {}
        self._regularities: dict[MapSpec, RegularityMap] = {}
        self._searches: dict[MapSpec, SuperStickySearch] = {}
        self._exponents: dict[MapSpec, UncertaintyExponent] = {}

    def map(self, case: str, plane: Slice, energy: float | tuple[float, float], window: Window | None = None) -> EscapeMap:
        """Map of a case of the paper.

        Parameters
        ----------
        case
            Key of `engine.CASES`.
        plane, energy, window
            As in `engine.MapSpec`.

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        ValueError
            As in `engine.MapSpec`.
        """
        return self._stored(self._spec(case, plane, energy, window))

    def curves(self, case: str, plane: Slice) -> Sweep:
        """Shares at the energies of `curve_energies`, and the largest energy error; new maps are not stored.

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        """
        if (case, plane) not in self._curves:
            energies, side = curve_energies(case, self.quality.curve_points), self.quality.resolution
            spec = SweepSpec(
                CASES[case], plane, energies, (side, side), t_max=self.quality.t_max, measures=("shares", "accuracy")
            )
            self._curves[case, plane] = compute_sweep(
                spec, measure=lambda point: compute_point(point, frame=self._unstored(point.map_spec)), execution=self.execution
            )
        return self._curves[case, plane]

    def regularity(self, frame: EscapeMap) -> RegularityMap:
        """Classification of the bounded orbits of a map as regular or chaotic.

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        """
        if frame.spec not in self._regularities:
            regularity = compute_regularity(frame, execution=self.execution)
            if not regularity.complete:
                raise CancelledError
            self._regularities[frame.spec] = regularity
        return self._regularities[frame.spec]

    def super_sticky(self) -> SuperStickySearch:
        """Continuation of the chaotic bounded orbits of case III at h = 0.26 on (x, px).

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        """
        return self._search(STICKY_CASE, STICKY_ENERGY, self.quality.search_resolution)

    def late_escapes(self, case: str, energy: float) -> SuperStickySearch:
        """Continuation of the chaotic bounded orbits of case I or II on (x, px), from fewer starts.

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        """
        return self._search(case, energy, self.quality.classified_resolution)

    def exponent(self, case: str, plane: Slice, energy: float) -> UncertaintyExponent:
        """Uncertainty exponent of the basins of a case.

        Raises
        ------
        concurrent.futures.CancelledError
            If cancelled.
        """
        spec = self._spec(case, plane, energy)
        if spec not in self._exponents:
            self._exponents[spec] = compute_uncertainty_exponent(spec, work=self.quality.exponent_work, execution=self.execution)
        return self._exponents[spec]

    def _search(self, case: str, energy: float, side: int) -> SuperStickySearch:
        spec = replace(self._spec(case, Plane.X_PX, energy), resolution=(side, side))
        if spec not in self._searches:
            frame = self._stored(spec)
            self._searches[spec] = find_super_sticky_orbits(
                frame, self.regularity(frame), self.quality.search_t_max, execution=self.execution
            )
        return self._searches[spec]

    def _spec(self, case: str, plane: Slice, energy: float | tuple[float, float], window: Window | None = None) -> MapSpec:
        side, t_max = self.quality.resolution, self.quality.t_max
        return MapSpec(CASES[case], plane, energy, (side, side), window, t_max)

    def _unstored(self, spec: MapSpec) -> EscapeMap:
        return self._maps[spec] if spec in self._maps else self._compute(spec)

    def _stored(self, spec: MapSpec) -> EscapeMap:
        self._maps[spec] = self._unstored(spec)
        return self._maps[spec]

    def _compute(self, spec: MapSpec) -> EscapeMap:
        computed = run_map(spec, self.execution)
        if not computed.complete:
            raise CancelledError
        self._on_map(computed)
        return replace(computed, batch=None)
