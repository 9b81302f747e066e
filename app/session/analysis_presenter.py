"""Analyses of one session: follow-up analyses of each map, measures of its basins, and curves against energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from html import escape
from typing import Any

import numpy as np

from app.job_clients.error_messages import WINDOW_UNKNOWN
from app.job_clients.follow_up_requests import FollowUp
from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from app.state.glossary import with_terms
from app.state.view import IMAGES, Analysis
from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.analysis.curves import REFINED_VALUES, SWEPT_VALUES, CurvesView
from app.views.components.texts import TextPane
from app.views.maps.map_plots import PICTURES_ALONE, PICTURES_COMPARED, MapsView
from engine import (
    EscapeMap,
    MapSpec,
    OriginFateMap,
    ParameterAxis,
    RegularityMap,
    StableManifolds,
    Sweep,
    SweepSpec,
    TrustMap,
    UncertaintyExponent,
    Window,
    compute_uncertainty_exponent,
    find_stable_manifolds,
)
from engine.jobs.job import Job
from engine.jobs.map_jobs import (
    basin_measures_job,
    decay_laws_job,
    flux_job,
    origin_fate_job,
    regularity_job,
    sweep_job,
    trust_job,
)
from engine.slices.section import SECTION
from engine.slices.slice_text import default_range
from engine.sweeps.measures import CURVES
from engine.warmup import is_ready_for_maps
from plots.pictures.manifold_strokes import select_image
from plots.pictures.map_analyses import NO_ANALYSES, MapAnalyses
from plots.pictures.map_images import ON_DEMAND
from plots.pictures.palette import Palette

# Columns and rows of the maps of a sweep.
_SIDES = (112, 112)
# Column of `map_columns` and attribute of `MapAnalyses` that each layer controls.
_COLUMN_OF = {"judge": "character", "origins": "passage"}
_RESULT_OF = {"judge": "regularity", "trust": "trust", "manifolds": "manifolds", "origins": "origins"}


class AnalysisPresenter:
    """Analyses that the view state asks for; `on_analyses(analyses)` receives the results for the current map."""

    def __init__(
        self,
        context: SessionContext,
        maps: MapsView,
        on_analyses: Callable[[MapAnalyses], None],
        on_curves: Callable[[Sweep | None], None],
    ) -> None:
        state, jobs, locked = context.state, context.jobs, context.locked
        self._open_view = context.open_view
        self._state, self._maps, self._on_analyses, self._on_curves = state, maps, on_analyses, on_curves
        self._spec: MapSpec | None = None
        self._swept: SweepSpec | None = None
        self._analyses = NO_ANALYSES
        # All images that are computed.
        self._manifolds: StableManifolds | None = None
        self._notes: dict[str, str] = {}
        self.notes = TextPane("", name="notes", sizing_mode="stretch_width", margin=(0, 10), css_classes=["notes"])
        self.measures = BasinMeasuresView(locked(self._measure), context.copy, locked(lambda: state.param.update(box=None)))
        state.follow(self.measures.show_box, "box")
        self.curves = CurvesView(locked(self._sweep), self._open_value, context.latest)
        self._exponent = LatestRequest(jobs, self._show_exponent, self.measures.say, locked)
        self._sweeping = LatestRequest(jobs, self._show_curves, self._sweep_failed, locked)
        self._connect()

    def follow_ups(self) -> list[FollowUp]:
        """Analyses of each complete map."""
        return [
            self._layer("judge", lambda frame: regularity_job(frame.spec), self._show_regularity),
            self._layer("trust", lambda frame: trust_job(frame.spec), self._show_trust),
            self._layer("origins", lambda frame: origin_fate_job(frame.spec), self._show_origins),
            self._layer("manifolds", _manifolds_job, self._show_manifolds),
            self._measure_of_basins(basin_measures_job, self.measures.show_basins),
            self._measure_of_basins(decay_laws_job, self.measures.show_laws),
            self._measure_of_basins(lambda spec, box: flux_job(spec), self.measures.show_flux),
        ]

    def begin(self, spec: MapSpec) -> None:
        """Prepare for a new map: remove the results of another one."""
        if spec == self._spec:
            return
        self._spec = spec
        self._manifolds = None
        self._exponent.cancel()
        self._maps.overlays.begin(spec)
        self.measures.begin()
        if self._analyses != NO_ANALYSES:
            self._update(**dict.fromkeys(_RESULT_OF.values()))
        self.note(**dict.fromkeys(_RESULT_OF, ""))
        self._explain_manifolds()

    def set_palette(self, palette: Palette) -> None:
        """Change the colours."""
        self._maps.overlays.set_palette(palette)
        self.curves.set_palette(palette)

    def close(self) -> None:
        """Cancel all requests at the end of the session."""
        self._exponent.cancel()
        self._sweeping.cancel()

    def _connect(self) -> None:
        watch, state = self._state.param.watch, self._state
        watch(lambda *events: self._show_pictures(), [*ON_DEMAND.values(), "compared"])
        watch(self._remove_switched_off, list(_RESULT_OF))
        watch(lambda event: self._draw_manifolds(), "images")
        watch(lambda *events: self._explain_manifolds(), ["manifolds", "plane"])
        self._state.follow(self.curves.follow_energy, "energy")
        watch(lambda *events: self._stop_sweep(), ["system", "plane", "t_max"])
        watch(lambda *events: self._follow_system(), "system")
        self._show_pictures()
        self.curves.follow_system(state.system)

    def _layer(
        self, name: str, request: Callable[[EscapeMap], Job[Any] | None], show: Callable[[EscapeMap, Any], None]
    ) -> FollowUp:
        return FollowUp(lambda frame: request(frame) if getattr(self._state, name) else None, show, (name,))

    def _measure_of_basins(
        self, job: Callable[[MapSpec, Window | None], Job[Any] | None], show: Callable[[Any], None]
    ) -> FollowUp:
        """A measure of the whole view or of the box, requested while the tab is open."""
        return FollowUp(
            lambda frame: job(frame.spec, self._state.box) if self._state.analysis is Analysis.MEASURES else None,
            lambda _, result: show(result),
            ("analysis", "box"),
        )

    # Layers.

    def _show_pictures(self) -> None:
        state = self._state
        layers = [picture for picture, toggle in ON_DEMAND.items() if getattr(state, toggle)]
        self._maps.show_pictures([*(PICTURES_ALONE if state.compared is None else PICTURES_COMPARED), *layers])

    def _remove_switched_off(self, *events: Any) -> None:
        for event in events:
            if not event.new:
                self._remove(event.name)

    def _remove(self, name: str) -> None:
        """Remove the results of an analysis."""
        if name in _COLUMN_OF:
            self._maps.remove_layer(_COLUMN_OF[name])
        if name == "trust":
            self._maps.overlays.show_trust(None)
        if name == "manifolds":
            self._manifolds = None
            self._maps.overlays.show_manifolds(None)
        self._update(**{_RESULT_OF[name]: None})
        self.note(**{name: ""})

    # Results of follow-up analyses.

    def _update(self, **results: Any) -> None:
        self._analyses = replace(self._analyses, **results)
        self._maps.describe()
        self._on_analyses(self._analyses)

    def _explain_manifolds(self) -> None:
        if self._state.manifolds and self._state.plane != SECTION.plane:
            self.note(manifolds=f"Stable manifolds are curves in the {SECTION.plane.title} plane and are drawn there only.")

    def note(self, **sentences: str) -> None:
        """Show a sentence for each of some layers; an empty one removes it."""
        self._notes |= sentences
        body = " ".join(escape(sentence) for sentence in self._notes.values() if sentence)
        self.notes.object = with_terms(body)

    def _show_regularity(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        self._maps.show_regularity(frame, regularity)
        if regularity.complete:
            self._update(regularity=regularity)

    def _show_trust(self, frame: EscapeMap, trust: TrustMap) -> None:
        self._maps.overlays.show_trust(trust)
        self.note(trust=trust.describe())
        if trust.complete:
            self._update(trust=trust)

    def _show_origins(self, frame: EscapeMap, origins: OriginFateMap) -> None:
        self._maps.show_origins(origins)
        self.note(origins=origins.describe())
        self._update(origins=origins)

    def _show_manifolds(self, frame: EscapeMap, manifolds: StableManifolds) -> None:
        self._manifolds = manifolds
        self._draw_manifolds()

    def _draw_manifolds(self) -> None:
        """Draw the image of the manifolds that is chosen, or all."""
        if self._manifolds is None:
            return
        image = self._state.images
        chosen = select_image(self._manifolds, image)
        self._maps.overlays.show_manifolds(chosen)
        self.note(manifolds=_describe_manifolds(chosen, image))
        self._update(manifolds=chosen)

    # Measurements started by buttons.

    def _measure(self) -> None:
        if not is_ready_for_maps(self._state.potential):
            self.measures.say(WINDOW_UNKNOWN)
            return
        self.measures.wait_for_exponent()
        self._exponent.submit(Job(compute_uncertainty_exponent, (self._state.map_spec(),)))

    def _show_exponent(self, exponent: UncertaintyExponent) -> None:
        self._exponent.cancel()
        self.measures.show_exponent(exponent)

    def _follow_system(self) -> None:
        self._show_curves(None)
        self.curves.follow_system(self._state.system)

    def _sweep(self) -> None:
        if self.curves.running:
            self._stop_sweep()
            return
        state, energies = self._state, self._state.energies
        plane = state.plane if state.plane.energy_axis is None and state.plane.parameter is None else SECTION.plane
        name, energy, along = self.curves.against.value, None, None
        low, high = energies.low, energies.high
        if name != "h":
            low, high = default_range(state.system, name)
            along, energy = ParameterAxis(name, low, high, state.system), state.energy
        swept = np.round(np.linspace(low, high, SWEPT_VALUES), 4).tolist()
        self._swept = SweepSpec(
            state.potential, plane, swept, _SIDES, t_max=state.t_max, measures=CURVES, along=along, energy=energy,
            refine=REFINED_VALUES,
        )  # fmt: skip
        self.curves.show_running(True)
        self._sweeping.submit(sweep_job(self._swept))

    def _stop_sweep(self) -> None:
        self._sweeping.cancel()
        self.curves.show_running(False)

    def _sweep_failed(self, sentence: str) -> None:
        self.curves.show_running(False)
        self.curves.say(sentence)

    def _show_curves(self, curves: Sweep | None) -> None:
        if curves is not None and curves.complete:
            self._stop_sweep()
        self.curves.show(curves)
        self._on_curves(curves)

    def _open_value(self, value: float) -> None:
        """Show the map of an energy, or of a value of the parameter, on the plane of the curves."""
        spec = self._swept
        if self.curves.shown is None or spec is None:
            return
        if spec.along is None:
            self._state.param.update(energy=value, plane=spec.plane)
        else:
            system = spec.along.system.with_parameter(spec.along.key, value)
            self._open_view(system, {"energy": spec.energy, "plane": spec.plane, "window": None, "starts": (), "chosen": 0})


def _manifolds_job(frame: EscapeMap) -> Job[StableManifolds] | None:
    """The job of the stable manifolds in the plane of a map; None if it is not the section."""
    spec = frame.spec
    if spec.common_energy is None or spec.plane != SECTION.plane:
        return None
    options = ("images", IMAGES), ("window", spec.given_window)
    return Job(find_stable_manifolds, (spec.potential, spec.common_energy), options)


def _describe_manifolds(manifolds: StableManifolds, image: int) -> str:
    points = sum(arc.x.size for arc in manifolds.arcs)
    truncated = " Some spirals are truncated." if manifolds.truncated else ""
    arcs = f"{len(manifolds.arcs)} arcs, {points} points"
    drawn = f"image {image}" if image else f"images 1 to {manifolds.images}"
    return f"Stable manifolds of the Lyapunov orbits, {drawn}: {arcs}.{truncated}"
