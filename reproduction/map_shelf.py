"""The maps that figures and tables are made of: each computed once, at first need, however many ask for it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor
from dataclasses import replace

import xarray as xr

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    RegularityMap,
    SuperStickySearch,
    Window,
    compute_map,
    compute_regularity,
    find_super_sticky_orbits,
    tabulate_crossing_statistics,
)
from reproduction.paper_ranges import STICKY_CASE, STICKY_ENERGY, curve_energies
from reproduction.quality import Quality


class MapShelf:
    """Finished maps of one quality, kept without what is needed to go on from them; and what is found in them.

    Parameters
    ----------
    quality
        How finely.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        Set to stop; what is under way then raises CancelledError.
    on_map
        Told of each map that has been computed.
    """

    def __init__(
        self,
        quality: Quality,
        executor: Executor | None = None,
        cancel: threading.Event | None = None,
        on_map: Callable[[EscapeMap], None] = lambda made: None,
    ) -> None:
        self.quality = quality
        self.executor = executor
        self.cancel = cancel
        self._on_map = on_map
        self._maps: dict[MapSpec, EscapeMap] = {}
        self._curves: dict[tuple[str, Plane], xr.Dataset] = {}
        self._judged: dict[MapSpec, RegularityMap] = {}
        self._hunt: SuperStickySearch | None = None

    def map(self, case: str, plane: Plane, energy: float | tuple[float, float], window: Window | None = None) -> EscapeMap:
        """The map of a case of the paper.

        Parameters
        ----------
        case
            Of `engine.CASES`.
        plane, energy, window
            As of `engine.MapSpec`.

        Raises
        ------
        concurrent.futures.CancelledError
            When stopped.
        ValueError
            As of `engine.MapSpec`.
        """
        return self._kept(self._spec(case, plane, energy, window))

    def curves(self, case: str, plane: Plane) -> xr.Dataset:
        """Shares at the energies of `curve_energies`, as from `engine.tabulate_crossing_statistics`, with crossings to n = 0.

        Of these many maps only those are kept that were there before.

        Raises
        ------
        concurrent.futures.CancelledError
            When stopped.
        """
        if (case, plane) not in self._curves:
            self._curves[case, plane] = tabulate_crossing_statistics(self._passing(case, plane), most_crossings=0)
        return self._curves[case, plane]

    def judged(self, frame: EscapeMap) -> RegularityMap:
        """Which bounded orbits of a map are regular, and which chaotic.

        Raises
        ------
        concurrent.futures.CancelledError
            When stopped.
        """
        if frame.spec not in self._judged:
            regularity = compute_regularity(frame, cancel=self.cancel, executor=self.executor)
            if not regularity.complete:
                raise CancelledError
            self._judged[frame.spec] = regularity
        return self._judged[frame.spec]

    def hunt(self) -> SuperStickySearch:
        """The chaotic bounded orbits of case III at h = 0.26 on (x, px), followed on.

        Raises
        ------
        concurrent.futures.CancelledError
            When stopped.
        """
        if self._hunt is None:
            side = self.quality.hunt_resolution
            frame = self._kept(replace(self._spec(STICKY_CASE, Plane.X_PX, STICKY_ENERGY, None), resolution=(side, side)))
            self._hunt = find_super_sticky_orbits(
                frame, self.judged(frame), self.quality.hunt_t_max, executor=self.executor, cancel=self.cancel
            )
        return self._hunt

    def _spec(self, case: str, plane: Plane, energy: float | tuple[float, float], window: Window | None) -> MapSpec:
        side, t_max = self.quality.resolution, self.quality.t_max
        return MapSpec(CASES[case], plane, energy, (side, side), window, t_max)  # type: ignore[arg-type]  # None is the whole interior

    def _passing(self, case: str, plane: Plane) -> Iterator[EscapeMap]:
        for energy in curve_energies(case, self.quality.curve_points):
            spec = self._spec(case, plane, energy, None)
            yield self._maps[spec] if spec in self._maps else self._computed(spec)

    def _kept(self, spec: MapSpec) -> EscapeMap:
        if spec not in self._maps:
            self._maps[spec] = self._computed(spec)
        return self._maps[spec]

    def _computed(self, spec: MapSpec) -> EscapeMap:
        made = compute_map(spec, cancel=self.cancel, executor=self.executor)
        if not made.complete:
            raise CancelledError
        self._on_map(made)
        return replace(made, batch=None)
