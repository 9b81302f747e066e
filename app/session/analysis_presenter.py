"""Analyses of the maps of one session: the layers that are on, and the measures of the basins."""

from __future__ import annotations

from functools import partial
from html import escape
from typing import Any, NamedTuple

from app.job_clients.follow_up_requests import FollowUp, FollowUpRequests
from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from app.state.glossary import with_terms
from app.state.view import Analysis
from app.state.view_state import WINDOW_UNKNOWN
from app.views.analysis.basin_measures import DESCRIBED_MEASURES, BasinMeasuresView, counts_in_box
from app.views.components.texts import TextPane
from app.views.maps.map_plots import MapsView
from engine import MEASURES, EscapeMap, MapSpec
from engine.jobs.job import Job
from engine.measures.compute import measure_job
from plots.layers.layer import NO_ANALYSES, Layer
from plots.layers.table import LAYERS


class _LayerResult(NamedTuple):
    """The whole result of a layer, with its map and its job. The settings select the part that is shown."""

    frame: EscapeMap
    result: Any
    job: Job[Any]


class AnalysisPresenter:
    """Requests the analyses that the view state asks for, shows them over the maps, and stores them in the session's results.

    Parameters
    ----------
    context
        The session.
    maps
        Shows the results of layers.
    """

    def __init__(self, context: SessionContext, maps: MapsView) -> None:
        state, jobs, locked = context.state, context.jobs, context.locked
        self._notice = context.notice
        self._state, self._results, self._maps = state, context.results, maps
        self._map_spec: MapSpec | None = None
        self._results_by_layer: dict[str, _LayerResult] = {}
        self._sentences_by_name: dict[str, str] = {}
        self.notes = TextPane("", name="notes", sizing_mode="stretch_width", margin=(0, 10), css_classes=["notes"])
        self.measures = BasinMeasuresView(state, self._request_measure, context.copy)
        self._measure_requests = {
            name: LatestRequest(jobs, partial(self._show_slow_measure, name), partial(self.measures.say, name), locked)
            for name in self.measures.buttons
        }
        state.param.watch(lambda event: self._cancel_box_measures(), "box")
        self._follow_ups = FollowUpRequests(state, jobs, self._list_follow_ups(), self._fail, locked)
        self._results.param.watch(lambda event: self._follow_map(), "frame")
        state.param.watch(self._switch_layers, "layers")
        state.param.watch(lambda event: self._apply_settings(), "settings")

    def _list_follow_ups(self) -> list[FollowUp]:
        """Return the analyses of each complete map."""
        return [
            *map(self._layer_follow_up, LAYERS.values()),
            *(self._measure_follow_up(measure.name) for measure in DESCRIBED_MEASURES if not measure.slow),
        ]

    def _follow_map(self) -> None:
        """Analyse the map in view once it is complete."""
        frame = self._results.frame
        if frame is not None:
            self._begin_map(frame.spec)
        self._follow_ups.follow(self._results.whole_map)
        self._mark_computing()

    def _begin_map(self, spec: MapSpec) -> None:
        """Prepare for a new map: remove the results of the previous map."""
        if spec == self._map_spec:
            return
        self._map_spec = spec
        self._results_by_layer = {}
        for request in self._measure_requests.values():
            request.cancel()
        self._maps.overlays.begin(spec)
        self.measures.begin()
        if self._results.analyses != NO_ANALYSES:
            self._results.analyses = NO_ANALYSES
        self.show_notes(**dict.fromkeys(LAYERS, ""))
        self._explain_refusals()

    def _layer_follow_up(self, layer: Layer[Any]) -> FollowUp:
        """Return the analysis of a layer, which is requested while the layer is on."""
        return FollowUp(partial(self._layer_job, layer), partial(self._show_layer_result, layer), ("layers", "settings"))

    def _layer_job(self, layer: Layer[Any], frame: EscapeMap) -> Job[Any] | None:
        is_shown = layer.name in self._state.layers and not layer.refusal(frame.spec)
        return layer.job(frame.spec, self._state.settings) if is_shown else None

    def _measure_follow_up(self, name: str) -> FollowUp:
        """Return a measure of the whole view or of the box, which is requested while the measures are open."""
        state = self._state
        return FollowUp(
            lambda frame: measure_job(frame.spec, name, state.box) if state.analysis == Analysis.MEASURES else None,
            lambda _, result: self.measures.show(name, result),
            ("analysis", "box"),
        )

    # Layers.

    def _layers_on(self) -> list[Layer[Any]]:
        return [layer for name, layer in LAYERS.items() if name in self._state.layers]

    def _switch_layers(self, event: Any) -> None:
        for name in event.old - event.new:
            self._remove_layer_result(name)
        self._explain_refusals()
        self._mark_computing()

    def _mark_computing(self) -> None:
        """Mark the layers of a complete map that have no complete result yet."""
        whole_map = self._results.whole_map
        requested = {layer.name for layer in self._layers_on() if whole_map is not None and not layer.refusal(whole_map.spec)}
        complete = {name for name, known in self._results_by_layer.items() if _is_complete(known.result)}
        self._maps.mark_computing(frozenset(requested - complete))

    def _fail(self, sentence: str) -> None:
        """Say why an analysis has no result. All marks are removed, because the sentence does not name the analysis."""
        self._maps.mark_computing(frozenset())
        self._notice.warn(sentence)

    def _remove_layer_result(self, name: str) -> None:
        self._results_by_layer.pop(name, None)
        self._maps.remove_layer(name)
        self._store(name, None)
        self.show_notes(**{name: ""})

    def _explain_refusals(self) -> None:
        """Say why layers cannot be computed for the map in view."""
        if self._map_spec is not None:
            spec = self._map_spec
            self.show_notes(**{layer.name: sentence for layer in self._layers_on() if (sentence := layer.refusal(spec))})

    def show_notes(self, **sentences: str) -> None:
        """Replace notes, by the name of a layer or of the comparison; an empty sentence removes a note."""
        self._sentences_by_name |= sentences
        body = " ".join(escape(sentence) for sentence in self._sentences_by_name.values() if sentence)
        self.notes.object = with_terms(body)

    def _show_layer_result(self, layer: Layer[Any], frame: EscapeMap, result: Any) -> None:
        self._results_by_layer[layer.name] = _LayerResult(frame, result, layer.job(frame.spec, self._state.settings))
        self._show_selection(layer)
        self._mark_computing()

    def _apply_settings(self) -> None:
        """Select parts of the results anew, and remove results that were computed with other settings."""
        for name, known in list(self._results_by_layer.items()):
            if LAYERS[name].job(known.frame.spec, self._state.settings) == known.job:
                self._show_selection(LAYERS[name])
            else:
                self._remove_layer_result(name)
        self._mark_computing()

    def _show_selection(self, layer: Layer[Any]) -> None:
        """Show the part of a layer's result that the settings select."""
        frame, result, _ = self._results_by_layer[layer.name]
        selection = layer.select(result, self._state.settings)
        self._maps.show_layer(layer.name, frame, selection)
        self.show_notes(**{layer.name: selection.describe()})
        if _is_complete(result):
            self._store(layer.name, selection)

    def _store(self, name: str, result: Any) -> None:
        """Store the complete result of a layer for files and figures; None removes the result."""
        analyses = {**self._results.analyses, name: result}
        self._results.analyses = {each: analyses[each] for each in LAYERS if analyses.get(each) is not None}

    # Slow measures, started by buttons.

    def _request_measure(self, name: str) -> None:
        if not self._state.is_ready:
            self.measures.say(name, WINDOW_UNKNOWN)
            return
        self.measures.wait_for(name)
        self._measure_requests[name].submit(measure_job(self._state.map_spec(), name, self._state.box))

    def _show_slow_measure(self, name: str, result: Any) -> None:
        # Without this, the request would ignore another click for the same map.
        self._measure_requests[name].cancel()
        self.measures.show(name, result)

    def _cancel_box_measures(self) -> None:
        """Cancel the slow measures that depend on the box."""
        for name, request in self._measure_requests.items():
            if counts_in_box(MEASURES[name]):
                request.cancel()


def _is_complete(result: Any) -> bool:
    """Whether no further part of a result follows; results that always arrive whole have no attribute `complete`."""
    return bool(getattr(result, "complete", True))
