"""The player of many orbits. The visitor's browser draws the starts, integrates the orbits and paints them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict, astuple, replace
from typing import Any

import param

from app.browser.components.plain_component import PlainComponent
from app.browser.module_files import WATCH_ADDRESS
from app.job_clients.latest_request import LatestRequest, Locked
from app.job_clients.shown_results import ShownResults
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.state.watched_starts import (
    COUNTS,
    EXPLANATIONS,
    LARGEST_LOG_RADIUS,
    SMALLEST_LOG_RADIUS,
    StartsFrom,
    WatchedStarts,
    places_for,
)
from app.views.components.widgets import LOADED_MODULE
from engine import compute_flux
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.maps.warmup import is_ready_for_maps
from engine.results import EscapeFlux

_STYLE = """
:host { display: block; color: var(--ui-ink) }
.row { display: flex; flex-wrap: wrap; gap: 6px; align-items: center; margin: 6px 0 }
[hidden] { display: none !important }
button.play { min-width: 11.5rem; font-weight: 600 }
.close { display: none }
/* Where the results are below the pictures, this line stays in the window. */
@media (max-width: 74.99em) {
  .line.watched { position: fixed; z-index: 80; inset: auto 0 0 var(--maps-width, 0px); flex-wrap: nowrap; margin: 0;
    padding: 6px 10px; border-top: 1px solid var(--ui-edge); background: var(--ui-surface); box-shadow: var(--ui-shadow-l);
    font-size: min(var(--ui-size), 4vmin) }
  .line.watched > .bk-btn { font-size: inherit }
  .line.watched > .play { min-width: min(6rem, 24vmin) }
  .line.watched > input { min-width: min(3.5rem, 15vmin) }
  .line.watched > output { width: 5.2em }
  .line.watched > .close { display: block; flex: none; width: min(var(--ui-control), 12vmin); padding: 0 }
}
select.bk-input { appearance: none; padding-right: 28px; border: 1px solid var(--ui-edge); border-radius: var(--ui-radius);
  background-color: var(--ui-surface); background-repeat: no-repeat; color: inherit; font: inherit }
label { display: inline-flex; align-items: center; gap: 6px; color: inherit; font-size: inherit }
input[type=range] { flex: 1; min-width: 6rem }
output { flex: none; width: 4.5rem; font-variant-numeric: tabular-nums }
.quiet { color: var(--ui-quiet); margin: 6px 0; min-height: 2lh }
table { border-spacing: 8px 2px; margin: 0 0 0 -8px; font-variant-numeric: tabular-nums }
tr { display: flex; flex-wrap: wrap; gap: 4px 14px }
td { padding-left: 1em; position: relative }
td::before { content: ""; position: absolute; left: 0; top: 0.3em; width: 0.7em; height: 0.7em; border-radius: 2px;
  background: var(--colour, var(--ui-quiet)) }
.survival { display: block; width: 100%; height: 150px; margin-top: 6px }
"""


class EnsemblePlayer(PlainComponent):
    """Controls, counters and a chart. The browser sends {where, count, seed, radius} for each choice of starts, and {closed}.

    Parameters
    ----------
    state
        View state, which the player follows, and which gets each choice.
    results
        The results of the session, whose first map follows the compilation of the kernels.
    jobs, locked
        See `LatestRequest`; the decay rate is requested while the analysis is open.
    """

    address = param.String(default=WATCH_ADDRESS, doc="address of the module")
    counts = param.List(default=list(COUNTS), doc="numbers of orbits to choose from")
    radii = param.List(default=[SMALLEST_LOG_RADIUS, LARGEST_LOG_RADIUS], doc="log10 of the smallest and the largest radius")
    places = param.Dict(default={}, doc="phrase of each place of starts in the system")
    explanations = param.Dict(default={str(place): text for place, text in EXPLANATIONS.items()}, doc="texts about some places")
    where = param.String(doc="see `WatchedStarts`")
    count = param.Integer()
    seed = param.Integer()
    radius = param.Number()
    point = param.List(default=[], doc="abscissa and ordinate of the chosen start; empty without one")
    box = param.List(default=[], doc="the four edges of the box; empty without one")
    presses = param.Integer(default=0, doc="number of presses, by which the player plays or pauses")
    rate = param.Number(default=0.0, doc="decay rate of mixed motion; 0 if it is not known")

    _esm = LOADED_MODULE

    def __init__(self, state: ViewState, results: ShownResults, jobs: JobSubmitter, locked: Locked) -> None:
        super().__init__(sizing_mode="stretch_width", margin=(0, 10), stylesheets=[_STYLE])
        self._state = state
        self._choose = locked(lambda starts: state.param.update(watched=starts))
        self._close = locked(lambda: state.param.update(analysis=Analysis.ORBIT))
        self._flux_request = LatestRequest(jobs, self._show_flux, lambda sentence: None, locked)
        state.follow(lambda *values: self._show_choice(), "system", "watched", "starts", "chosen", "box")
        results.param.watch(lambda event: self._request_rate() if results.whole_map else None, "frame")
        state.follow(lambda *values: self._request_rate(), "system", "plane", "energy", "analysis")

    def press(self) -> None:
        """Play, or pause. A player that is not on the page yet plays as soon as it is."""
        self.presses += 1

    def _show_choice(self) -> None:
        watched, start, box = self._state.watched, self._state.chosen_start, self._state.box
        places = places_for(self._state.potential)
        if watched.where not in places:
            watched = replace(watched, where=StartsFrom.WELL)
        edges = [] if box is None else list(astuple(box))
        choice = {"places": {str(where): words for where, words in places.items()}, **asdict(watched)}
        self.param.update(**choice, point=[] if start is None else list(start), box=edges)

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"where": str(where), "count": int(count), "seed": int(seed), "radius": int() | float() as radius}:
                with suppress(ValueError):
                    self._choose(WatchedStarts(where, count, seed, float(radius)))  # type: ignore[arg-type]
            case {"closed": True}:
                self._close()

    def _request_rate(self) -> None:
        """Request the decay rate of mixed motion while the analysis is open, once the kernels are compiled."""
        state = self._state
        if state.analysis != Analysis.WATCH:
            return
        self.rate = 0.0
        spec = state.map_spec()
        has_one_rate = spec.common_energy is not None and spec.plane.parameter is None
        if has_one_rate and is_ready_for_maps(state.potential):
            self._flux_request.submit(Job(compute_flux, (spec.potential, spec.common_energy)))

    def _show_flux(self, flux: EscapeFlux) -> None:
        # Without this, the request would ignore the same job when the analysis is opened again.
        self._flux_request.cancel()
        self.rate = flux.decay_rate
