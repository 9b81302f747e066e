"""Many orbits at once, watched while they leave, in a player in the browser that reads and writes the view state."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Any

import panel as pn

from app.browser.components.ensemble_player import EnsemblePlayer
from app.job_clients.latest_request import LatestRequest
from app.session.context import SessionContext
from app.state.help_texts import title_with_help
from app.state.view import Analysis
from app.state.watched_starts import StartsFrom, WatchedStarts, places_for
from app.views.components.texts import TextPane
from engine import compute_flux
from engine.jobs.job import Job
from engine.results import EscapeFlux
from engine.sweeps.warmup import is_ready_for_maps


class WatchPresenter:
    """Makes the player when its tab is first opened, and requests the decay rate of mixed motion for its chart."""

    def __init__(self, context: SessionContext) -> None:
        self._state = context.state
        self._take = context.locked(self._choose)
        self._player: EnsemblePlayer | None = None
        self._flux = LatestRequest(context.jobs, self._show_flux, lambda sentence: None, context.locked)
        watch = self._state.param.watch
        context.results.param.watch(lambda event: self._request_rate() if context.results.whole_map else None, "frame")
        watch(lambda *events: self._follow(), ["system", "watched", "starts", "chosen", "box"])
        watch(lambda *events: self._request_rate(), ["system", "plane", "energy", "analysis"])

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the content of the tab."""
        self._player = EnsemblePlayer(self._take)
        self._follow()
        self._request_rate()
        title = TextPane(title_with_help("Many orbits at once", "watch"), margin=(0, 10))
        return [title, self._player]

    def _request_rate(self) -> None:
        """Request the decay rate while the tab is open, once the kernels are compiled."""
        state = self._state
        if self._player is None or state.analysis is not Analysis.WATCH:
            return
        self._player.rate = 0.0
        spec = state.map_spec()
        has_one_rate = spec.common_energy is not None and spec.plane.parameter is None
        if has_one_rate and is_ready_for_maps(state.potential):
            self._flux.submit(Job(compute_flux, (spec.potential, spec.common_energy)))

    def _follow(self) -> None:
        if self._player is not None:
            watched, start, box = self._state.watched, self._state.chosen_start, self._state.box
            places = places_for(self._state.potential)
            if watched.where not in places:
                watched = replace(watched, where=StartsFrom.WELL)
            edges = [] if box is None else list(vars(box).values())
            shown = {"places": {str(where): words for where, words in places.items()}, **asdict(watched)}
            self._player.param.update(**shown, point=[] if start is None else list(start), box=edges)

    def _choose(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"where": str(where), "count": int(count), "seed": int(seed), "radius": int() | float() as radius}:
                try:
                    self._state.watched = WatchedStarts(where, count, seed, float(radius))  # type: ignore[arg-type]
                except ValueError:
                    return

    def _show_flux(self, flux: EscapeFlux) -> None:
        self._flux.cancel()
        if self._player is not None:
            self._player.rate = flux.decay_rate
