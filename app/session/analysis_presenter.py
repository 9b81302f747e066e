"""Why the picture is as it is: second looks at each whole map, measures of its basins, curves against energy; for one session."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from html import escape
from typing import Any

import numpy as np
import panel as pn

from app.job_clients.follow_up_requests import FollowUp
from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.rendering.map_analyses import NO_ANALYSES, MapAnalyses
from app.rendering.map_images import ON_DEMAND
from app.rendering.palette import Palette
from app.state.system import SYSTEM
from app.state.view_state import ViewState
from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.analysis.energy_curves import EnergyCurvesView
from app.views.components.analysis_toggles import AnalysisToggles
from app.views.maps.map_plots import MapsView
from engine import (
    BasinMeasuresRequest,
    DecayLawsRequest,
    EnergyCurves,
    EnergyCurvesRequest,
    EnergyCurvesSpec,
    EscapeMap,
    JobRequest,
    MapSpec,
    OriginFateMap,
    OriginFateRequest,
    Plane,
    RegularityMap,
    RegularityRequest,
    Requests,
    StableManifolds,
    StableManifoldsRequest,
    TrustMap,
    TrustRequest,
    UncertaintyExponent,
    UncertaintyExponentRequest,
    default_window,
)

IMAGES = 3
"""Of the stable manifolds: later ones lie as close as pixels."""

SWEPT_ENERGIES = 33

# By its switch, what a second look adds to the findings.
_FINDING_OF = {"judge": "regularity", "trust": "trust", "manifolds": "manifolds", "origins": "origins"}


class AnalysisPresenter:
    """The switches and what they switch; `on_findings(findings)` is told what is known of the map in view."""

    def __init__(
        self, state: ViewState, jobs: Requests, maps: MapsView, on_findings: Callable[[MapAnalyses], None], locked: Locked
    ) -> None:
        self._state, self._maps, self._on_findings = state, maps, on_findings
        self._spec: MapSpec | None = None
        self._findings = NO_ANALYSES
        self._notes: dict[str, str] = {}
        self.switches = AnalysisToggles(state)
        self.notes = pn.pane.HTML("", name="notes", sizing_mode="stretch_width", margin=(0, 10))
        self.measures = BasinMeasuresView(locked(self._measure))
        self.curves = EnergyCurvesView(locked(self._sweep), self._open_energy)
        self._exponent = LatestRequest(jobs, self._show_exponent, self.measures.say, locked)
        self._sweeping = LatestRequest(jobs, self._show_curves, self._sweep_failed, locked)
        self._connect()

    def looks(self) -> list[FollowUp]:
        """What is asked about each whole map."""
        return [
            self._look("judge", lambda frame: RegularityRequest(frame.spec), self._show_regularity),
            self._look("trust", lambda frame: TrustRequest(frame.spec), self._show_trust),
            self._look("origins", lambda frame: OriginFateRequest(frame.spec), self._show_origins),
            self._look("manifolds", _manifolds_of, self._show_manifolds),
            self._look(
                "measures", lambda frame: BasinMeasuresRequest(frame.spec), lambda _, found: self.measures.show_basins(found)
            ),
            self._look(
                "measures",
                lambda frame: DecayLawsRequest(frame.spec, self._state.box),
                lambda _, found: self.measures.show_laws(found),
                "box",
            ),
        ]

    def begin(self, spec: MapSpec) -> None:
        """A picture of this map comes: what was found of another one goes."""
        if spec == self._spec:
            return
        self._spec = spec
        self._exponent.cancel()
        self._maps.overlays.begin(spec)
        if self._state.measures:
            self.measures.begin()
        if self._findings != NO_ANALYSES:
            self._find(**dict.fromkeys(_FINDING_OF.values()))
        self._note(**dict.fromkeys(_FINDING_OF, ""))

    def set_palette(self, palette: Palette) -> None:
        """Draw in other colours."""
        self._maps.overlays.set_palette(palette)
        self.curves.set_palette(palette)

    def set_dark(self, dark: bool) -> None:
        """Dress for a dark page, or for a light one."""
        for view in (self.measures, self.curves):
            view.section.set_dark(dark)

    def close(self) -> None:
        """The session is over."""
        self._exponent.cancel()
        self._sweeping.cancel()

    def _connect(self) -> None:
        watch, state = self._state.param.watch, self._state
        watch(lambda *events: self._show_pictures(), list(ON_DEMAND.values()))
        watch(lambda event: self._open_sections(), ["measures", "energies"])
        watch(lambda event: None if event.new else self._forget(event.name), list(_FINDING_OF))
        watch(lambda event: self.curves.follow_energy(event.new), "energy")
        watch(lambda *events: self._stop_sweep(), [*SYSTEM, "plane", "t_max"])
        watch(lambda *events: self.curves.show(None), list(SYSTEM))
        self._show_pictures()
        self._open_sections()
        self.curves.follow_energy(state.energy)

    def _look(
        self,
        switch: str,
        ask: Callable[[EscapeMap], JobRequest[Any] | None],
        show: Callable[[EscapeMap, Any], None],
        *watched: str,
    ) -> FollowUp:
        return FollowUp(lambda frame: ask(frame) if getattr(self._state, switch) else None, show, (switch, *watched))

    # What is switched.

    def _show_pictures(self) -> None:
        shown = [picture for picture, switch in ON_DEMAND.items() if getattr(self._state, switch)]
        self._maps.show_pictures(frozenset(shown))

    def _open_sections(self) -> None:
        self.measures.section.open(self._state.measures)
        self.curves.section.open(self._state.energies)

    def _forget(self, name: str) -> None:
        """Nobody wants to see it any more."""
        if name == "trust":
            self._maps.overlays.show_trust(None)
        if name == "manifolds":
            self._maps.overlays.show_manifolds(None)
        self._find(**{_FINDING_OF[name]: None})
        self._note(**{name: ""})

    # What second looks answer.

    def _find(self, **found: Any) -> None:
        self._findings = replace(self._findings, **found)
        self._maps.describe()
        self._on_findings(self._findings)

    def _note(self, **sentences: str) -> None:
        self._notes |= sentences
        body = " ".join(escape(said) for said in self._notes.values() if said)
        self.notes.object = f"<span style='font-size:14px'>{body}</span>" if body else ""

    def _show_regularity(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        self._maps.show_regularity(frame, regularity)
        if regularity.complete:
            self._find(regularity=regularity)

    def _show_trust(self, frame: EscapeMap, trust: TrustMap) -> None:
        self._maps.overlays.show_trust(trust)
        self._note(trust=trust.describe())
        if trust.complete:
            self._find(trust=trust)

    def _show_origins(self, frame: EscapeMap, origins: OriginFateMap) -> None:
        self._maps.show_origins(origins)
        self._note(origins=origins.describe())
        self._find(origins=origins)

    def _show_manifolds(self, frame: EscapeMap, manifolds: StableManifolds) -> None:
        self._maps.overlays.show_manifolds(manifolds)
        self._note(manifolds=_described(manifolds))
        self._find(manifolds=manifolds)

    # What is measured when somebody presses a button.

    def _measure(self) -> None:
        try:
            spec = UncertaintyExponentRequest(self._state.map_spec())
        except ValueError as error:
            self.measures.say(str(error))
            return
        self.measures.wait_for_exponent()
        self._exponent.ask(spec)

    def _show_exponent(self, found: UncertaintyExponent) -> None:
        self._exponent.cancel()
        self.measures.show_exponent(found)

    def _sweep(self) -> None:
        if self.curves.running:
            self._stop_sweep()
            return
        state, energies = self._state, self._state.system.energies
        plane = Plane.X_PX if state.plane is Plane.X_H else state.plane
        swept = np.round(np.linspace(energies.low, energies.high, SWEPT_ENERGIES), 4).tolist()
        self.curves.show_running(True)
        self._sweeping.ask(EnergyCurvesRequest(EnergyCurvesSpec(state.potential, plane, tuple(swept), t_max=state.t_max)))

    def _stop_sweep(self) -> None:
        self._sweeping.cancel()
        self.curves.show_running(False)

    def _sweep_failed(self, sentence: str) -> None:
        self.curves.show_running(False)
        self.curves.say(sentence)

    def _show_curves(self, curves: EnergyCurves) -> None:
        if curves.complete:
            self._stop_sweep()
        self.curves.show(curves)

    def _open_energy(self, energy: float) -> None:
        """The map of this energy, on the plane that was swept."""
        curves = self.curves.shown
        if curves is not None:
            self._state.param.update(energy=energy, plane=curves.spec.plane)


def _manifolds_of(frame: EscapeMap) -> StableManifoldsRequest | None:
    """The stable manifolds that a map's plane shows."""
    spec = frame.spec
    if isinstance(spec.energy, tuple) or spec.plane is not Plane.X_PX:
        return None
    whole = spec.window == default_window(spec.potential, spec.plane, spec.energy)
    return StableManifoldsRequest(spec.potential, spec.energy, IMAGES, None if whole else spec.window)


def _described(manifolds: StableManifolds) -> str:
    points = sum(arc.x.size for arc in manifolds.arcs)
    left_out = " Some spirals are cut short." if manifolds.truncated else ""
    arcs = f"{len(manifolds.arcs)} arcs, {points} points"
    return f"Stable manifolds of the Lyapunov orbits, images 1 to {manifolds.images}: {arcs}.{left_out}"
