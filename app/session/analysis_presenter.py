"""Analyses of one session: follow-up analyses of each map, measures of its basins, and curves against energy."""

from __future__ import annotations

import math
from functools import partial
from html import escape
from typing import Any

import numpy as np

from app.job_clients.follow_up_requests import FollowUp, FollowUpRequests
from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from app.state.glossary import with_terms
from app.state.view import Analysis
from app.state.view_state import WINDOW_UNKNOWN
from app.views.analysis.basin_measures import TOLD, BasinMeasuresView
from app.views.analysis.curves import REFINED_VALUES, SWEPT_VALUES, CurvesView
from app.views.components.texts import TextPane
from app.views.maps.map_plots import PICTURES_ALONE, PICTURES_COMPARED, MapsView
from engine import MEASURES, EscapeMap, MapSpec, ParameterAxis, SweepSpec
from engine.jobs.job import Job
from engine.results import Sweep
from engine.slices.planes import SECTION
from engine.slices.slice_text import default_range
from engine.sweeps.map_jobs import measure_job, sweep_job
from engine.sweeps.measures import CURVES
from engine.sweeps.warmup import is_ready_for_maps
from plots.layers.layer import Layer
from plots.layers.map_analyses import NO_ANALYSES
from plots.layers.table import LAYERS

# Columns and rows of the maps of a sweep.
_SIDES = (112, 112)


class AnalysisPresenter:
    """Analyses that the view state asks for; the results are shown over the maps and belong to the results of the session."""

    def __init__(self, context: SessionContext, maps: MapsView) -> None:
        state, jobs, locked = context.state, context.jobs, context.locked
        self._open_view, self._notice = context.open_view, context.notice
        self._state, self._results, self._maps = state, context.results, maps
        self._spec: MapSpec | None = None
        self._swept: SweepSpec | None = None
        # Results of the layers that are on, each with its map and job, before a part is selected.
        self._found: dict[str, tuple[EscapeMap, Any, Job[Any]]] = {}
        self._notes: dict[str, str] = {}
        self.notes = TextPane("", name="notes", sizing_mode="stretch_width", margin=(0, 10), css_classes=["notes"])
        self.measures = BasinMeasuresView(state, self._measure, context.copy)
        self.curves = CurvesView(state, self._sweep, self._open_value, context.latest)
        self._measuring = {
            name: LatestRequest(jobs, partial(self._show_slow, name), partial(self.measures.say, name), locked)
            for name in self.measures.buttons
        }
        state.param.watch(lambda event: self._stop_measuring_box(), "box")
        self._sweeping = LatestRequest(jobs, self._show_curves, self._sweep_failed, locked)
        self._follow_ups = FollowUpRequests(state, jobs, self._list_follow_ups(), self._fail, locked)
        self._connect()

    def _list_follow_ups(self) -> list[FollowUp]:
        """Analyses of each complete map."""
        return [
            *map(self._layer, LAYERS.values()),
            *(self._measure_of_map(measure.name) for measure in TOLD if not measure.slow),
        ]

    def _follow_map(self) -> None:
        """Analyse the map in view, once it is complete."""
        frame = self._results.frame
        if frame is not None:
            self._begin(frame.spec)
        self._follow_ups.follow(self._results.whole_map)
        self._mark_computing()

    def _begin(self, spec: MapSpec) -> None:
        """Prepare for a new map: remove the results of the previous one."""
        if spec == self._spec:
            return
        self._spec = spec
        self._found = {}
        self._stop_measuring()
        self._maps.overlays.begin(spec)
        self.measures.begin()
        if self._results.analyses != NO_ANALYSES:
            self._results.analyses = NO_ANALYSES
        self.note(**dict.fromkeys(LAYERS, ""))
        self._explain_refusals()

    def close(self) -> None:
        """Cancel all requests at the end of the session."""
        self._follow_ups.follow(None)
        self._stop_measuring()
        self._sweeping.cancel()

    def _connect(self) -> None:
        watch = self._state.param.watch
        self._results.param.watch(lambda event: self._follow_map(), "frame")
        watch(lambda *events: self._show_pictures(), ["layers", "compared"])
        watch(self._switch_layers, "layers")
        watch(lambda event: self._select(), "settings")
        watch(lambda *events: self._stop_sweep(), ["system", "plane", "t_max"])
        watch(lambda *events: self._show_curves(None), "system")
        self._show_pictures()

    def _layer(self, layer: Layer) -> FollowUp:
        """Return the analysis of a layer, which is requested while the layer is on."""
        return FollowUp(partial(self._layer_job, layer), partial(self._show_result, layer), ("layers", "settings"))

    def _layer_job(self, layer: Layer, frame: EscapeMap) -> Job[Any] | None:
        is_shown = layer.name in self._state.layers and not layer.refusal(frame.spec)
        return layer.job(frame.spec, self._state.settings) if is_shown else None

    def _measure_of_map(self, name: str) -> FollowUp:
        """Return a measure of the whole view or of the box, which is requested while the tab is open."""
        state = self._state
        return FollowUp(
            lambda frame: measure_job(frame.spec, name, state.box) if state.analysis is Analysis.MEASURES else None,
            lambda _, result: self.measures.show(name, result),
            ("analysis", "box"),
        )

    # Layers.

    def _show_pictures(self) -> None:
        state = self._state
        pictures = [layer.picture.name for layer in self._layers_on() if layer.picture is not None]
        self._maps.show_pictures([*(PICTURES_ALONE if state.compared is None else PICTURES_COMPARED), *pictures])

    def _layers_on(self) -> list[Layer]:
        return [layer for name, layer in LAYERS.items() if name in self._state.layers]

    def _switch_layers(self, event: Any) -> None:
        for name in event.old - event.new:
            self._remove(name)
        self._explain_refusals()
        self._mark_computing()

    def _mark_computing(self) -> None:
        """Say in the pictures which layers of a complete map have no complete result yet."""
        whole = self._results.whole_map
        wanted = {layer.name for layer in self._layers_on() if whole is not None and not layer.refusal(whole.spec)}
        done = {name for name, (_, result, _) in self._found.items() if getattr(result, "complete", True)}
        self._maps.mark_computing(frozenset(wanted - done))

    def _fail(self, sentence: str) -> None:
        """Show why an analysis has no result; no other analysis is known to be running."""
        self._maps.mark_computing(frozenset())
        self._notice.warn(sentence)

    def _remove(self, name: str) -> None:
        """Remove the result of a layer."""
        self._found.pop(name, None)
        self._maps.remove_layer(name)
        self._results.analyses = self._results.analyses.with_result(name, None)
        self.note(**{name: ""})

    def _explain_refusals(self) -> None:
        if self._spec is not None:
            spec = self._spec
            self.note(**{layer.name: sentence for layer in self._layers_on() if (sentence := layer.refusal(spec))})

    def note(self, **sentences: str) -> None:
        """Show notes by name, of a layer or of the comparison; an empty sentence removes a note."""
        self._notes |= sentences
        body = " ".join(escape(sentence) for sentence in self._notes.values() if sentence)
        self.notes.object = with_terms(body)

    def _show_result(self, layer: Layer, frame: EscapeMap, result: Any) -> None:
        self._found[layer.name] = frame, result, layer.job(frame.spec, self._state.settings)
        self._show_selected(layer)
        self._mark_computing()

    def _select(self) -> None:
        """Select parts of the results by the settings, and remove results that were computed with other settings."""
        for name, (frame, _, job) in list(self._found.items()):
            if LAYERS[name].job(frame.spec, self._state.settings) == job:
                self._show_selected(LAYERS[name])
            else:
                self._remove(name)
        self._mark_computing()

    def _show_selected(self, layer: Layer) -> None:
        """Show the part of the result of a layer that the settings select."""
        frame, result, _ = self._found[layer.name]
        selected = layer.select(result, self._state.settings)
        self._maps.show_layer(layer.name, frame, selected)
        self.note(**{layer.name: selected.describe()})
        if getattr(result, "complete", True):
            self._results.analyses = self._results.analyses.with_result(layer.name, selected)

    # Measurements started by buttons.

    def _measure(self, name: str) -> None:
        if not is_ready_for_maps(self._state.potential):
            self.measures.say(name, WINDOW_UNKNOWN)
            return
        self.measures.wait_for(name)
        self._measuring[name].submit(measure_job(self._state.map_spec(), name, self._state.box))

    def _show_slow(self, name: str, result: Any) -> None:
        self._measuring[name].cancel()
        self.measures.show(name, result)

    def _stop_measuring(self) -> None:
        for request in self._measuring.values():
            request.cancel()

    def _stop_measuring_box(self) -> None:
        """Stop slow measures of the starts in the box."""
        for name, request in self._measuring.items():
            if not MEASURES[name].place:
                request.cancel()

    def _sweep(self) -> None:
        if self.curves.running:
            self._stop_sweep()
            return
        state, energies = self._state, self._state.energies
        plane = state.plane if state.plane.energy_axis is None and state.plane.parameter is None else SECTION
        name, energy, along = self.curves.against.value, None, None
        low, high = energies.low, energies.high
        if name != "h":
            low, high = default_range(state.system, name)
            along, energy = ParameterAxis(name, low, high, state.system), state.energy
        self._swept = SweepSpec(
            state.potential, plane, _swept_values(low, high), _SIDES, t_max=state.t_max, measures=CURVES, along=along,
            energy=energy, refine=REFINED_VALUES,
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
        self._results.curves = curves

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


def _swept_values(low: float, high: float) -> list[float]:
    """Return evenly spaced values from `low` to `high`, with few digits."""
    spacing = (high - low) / (SWEPT_VALUES - 1)
    decimals = max(4, 2 - math.floor(math.log10(spacing)))
    values: list[float] = np.round(np.linspace(low, high, SWEPT_VALUES), decimals).tolist()
    return values
