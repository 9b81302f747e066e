"""Cache the maps and analyses that figures and tables need. Each is computed once, at its first use."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from concurrent.futures import CancelledError
from dataclasses import replace
from typing import Any

from engine import (
    CASES,
    EscapeMap,
    Execution,
    MapSpec,
    Plane,
    Slice,
    SweepSpec,
    Window,
    compute_map,
    compute_regularity,
    compute_sweep,
    compute_uncertainty_exponent,
)
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.measures.compute import compute_point
from engine.results import RegularityMap, Sweep, UncertaintyExponent
from reproduction.paper_ranges import STICKY_CASE, STICKY_ENERGY, curve_energies
from reproduction.quality import Quality
from reproduction.super_sticky import SuperStickySearch, find_super_sticky_orbits


class MapCache:
    """Complete maps of one quality, without the states of their orbits, and analyses of these maps.

    All methods raise `concurrent.futures.CancelledError` when the execution is cancelled.

    Parameters
    ----------
    quality
        Resolution and integration time.
    execution
        How the computations run.
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
        self._values: dict[Hashable, Any] = {}

    def map(self, case: str, plane: Slice, energy: float | tuple[float, float], window: Window | None = None) -> EscapeMap:
        """Return a map of a case of `engine.CASES`. Other parameters are those of `engine.MapSpec`."""
        return self._stored_map(self._spec(case, plane, energy, window))

    def curves(self, case: str, plane: Slice) -> Sweep:
        """Return shares, and the largest energy error, at the energies of `curve_energies`. New maps are not stored."""
        return self._once(("curves", case, plane), lambda: self._sweep(case, plane))

    def regularity(self, frame: EscapeMap) -> RegularityMap:
        """Classify the bounded orbits of a map as regular or chaotic."""
        return self._once(("regularity", frame.spec), lambda: self._classify(frame))

    def super_sticky(self) -> SuperStickySearch:
        """Continue the chaotic bounded orbits of case III at h = 0.26 on (x, px)."""
        return self._search(STICKY_CASE, STICKY_ENERGY, self.quality.search_resolution)

    def late_escapes(self, case: str, energy: float) -> SuperStickySearch:
        """Continue the chaotic bounded orbits of case I or II on (x, px), with fewer starts."""
        return self._search(case, energy, self.quality.classified_resolution)

    def exponent(self, case: str, plane: Slice, energy: float) -> UncertaintyExponent:
        """Return the uncertainty exponent of the basins of a case."""
        spec = self._spec(case, plane, energy)
        work = self.quality.exponent_work
        return self._once(
            ("exponent", spec), lambda: compute_uncertainty_exponent(spec, work=work, execution=self.execution, rng=0)
        )

    def _once[Value](self, key: Hashable, compute: Callable[[], Value]) -> Value:
        """Return the value stored under a key. The first call computes the value."""
        if key not in self._values:
            self._values[key] = compute()
        return self._values[key]

    def _search(self, case: str, energy: float, side: int) -> SuperStickySearch:
        frame = self._stored_map(replace(self._spec(case, Plane.X_PX, energy), resolution=(side, side)))
        t_max = self.quality.search_t_max
        return self._once(
            ("search", frame.spec),
            lambda: find_super_sticky_orbits(frame, self.regularity(frame), t_max, execution=self.execution),
        )

    def _sweep(self, case: str, plane: Slice) -> Sweep:
        """Compute a sweep that uses the stored maps."""
        energies = curve_energies(case, self.quality.curve_points)
        resolution = self.quality.resolution, self.quality.resolution
        spec = SweepSpec(CASES[case], plane, energies, resolution, t_max=self.quality.t_max, measures=("shares", "accuracy"))
        return compute_sweep(
            spec,
            measure=lambda point: compute_point(
                point, escape_map=self._values.get(point.map_spec) or self._compute_map(point.map_spec)
            ),
            execution=self.execution,
        )

    def _classify(self, frame: EscapeMap) -> RegularityMap:
        regularity = compute_regularity(frame, execution=self.execution)
        if not regularity.complete:
            raise CancelledError
        return regularity

    def _spec(self, case: str, plane: Slice, energy: float | tuple[float, float], window: Window | None = None) -> MapSpec:
        resolution = self.quality.resolution, self.quality.resolution
        return MapSpec(CASES[case], plane, energy, resolution, window, self.quality.t_max)

    def _stored_map(self, spec: MapSpec) -> EscapeMap:
        return self._once(spec, lambda: self._compute_map(spec))

    def _compute_map(self, spec: MapSpec) -> EscapeMap:
        frame = compute_map(spec, execution=self.execution)
        if not frame.complete:
            raise CancelledError
        self._on_map(frame)
        # The states of the orbits would take much memory.
        return replace(frame, batch=None)
