"""From the view state to jobs, and from their frames to the views. Callbacks submit and return; nothing is computed here."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any, Protocol

from app.job_clients.error_messages import sentence
from app.job_clients.follow_up_requests import FollowUp, FollowUpRequests
from app.job_clients.locking import Locked
from app.job_clients.preview_requests import UNHURRIED, LoadPolicy, PreviewRequests
from app.rendering.image_columns import map_columns
from app.state.system import SYSTEM
from app.state.view_state import ViewState
from engine import EscapeMap, MapSpec, Requests, Subscription, WarmupRequest, is_ready_for_maps


class MapListener(Protocol):
    """What shows a map on its way."""

    def map_requested(self, *, compiling: bool = False) -> None:
        """A map has been asked for; `compiling`: its integrator is not there yet."""

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """A frame of it is here; the last one is complete."""

    def map_stopped(self) -> None:
        """The user has cancelled it."""

    def map_failed(self, sentence: str) -> None:
        """It cannot be had, for the reason given."""

    def preview_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """A quick look at an energy that the user passes by is here."""


class MapRequests:
    """One session's requests.

    While many wait there are no quick looks, and no frames between the first and the last. `locked` turns a function into one
    that any thread may call, that returns at once and runs under the session's lock (Bokeh's ``Document.locked_callback``).
    """

    def __init__(
        self,
        state: ViewState,
        jobs: Requests,
        listener: MapListener,
        locked: Locked,
        looks: Sequence[FollowUp] = (),
        patience: LoadPolicy = UNHURRIED,
    ) -> None:
        self._state, self._jobs, self._listener = state, jobs, listener
        self._map_ticket: Subscription | None = None
        self._go_on = locked(self._prepared)
        self._whole_map: EscapeMap | None = None
        self._generation = 0
        self._handing_over = threading.RLock()
        self._compiling = False
        # Of the request of which something has been sent to the page.
        self._sent = -1
        self._patience = patience
        self._show_map = locked(self._map_arrived)
        self._show_map_problem = locked(self._map_failed)
        self.previews = PreviewRequests(state, jobs, listener.preview_arrived, locked, patience)
        self._second_looks = FollowUpRequests(state, jobs, looks, listener.map_failed, locked)
        state.param.watch(lambda *events: self.request_map(), [*SYSTEM, "plane", "energy", "t_max", "resolution", "window"])

    def request_map(self) -> None:
        """Ask for the map in view; whatever was on its way for this session is cancelled."""
        self.previews.cancel()
        self.cancel_map()
        generation = self._want_another()
        self._compiling = not is_ready_for_maps(self._state.potential)
        self._listener.map_requested(compiling=self._compiling)
        # In the background, as even a map's window hangs on the exits, which it takes an integrator to find.
        self._map_ticket = self._jobs.request(
            WarmupRequest(self._state.unresolved_map_spec()),
            lambda prepared: self._hand_over(self._go_on, generation, prepared.map_spec),
            lambda error: self._hand_over(self._show_map_problem, generation, error),
        )

    def _prepared(self, generation: int, spec: MapSpec) -> None:
        if generation != self._generation:
            return
        if self._compiling:
            self._listener.map_requested()
        self._map_ticket = self._jobs.request_map(
            spec,
            lambda frame: self._send(generation, frame),
            lambda error: self._hand_over(self._show_map_problem, generation, error),
        )

    def _send(self, generation: int, frame: EscapeMap) -> None:
        """Hand a frame on; only the first and the last one where many wait for theirs."""
        if self._sent == generation and not frame.complete and self._patience.is_pressed():
            return
        columns = map_columns(frame, characters=self._state.judge)
        self._hand_over(self._show_map, generation, frame, columns)
        self._sent = generation

    def _want_another(self) -> int:
        """From now on nothing is shown of what has been asked for before."""
        with self._handing_over:
            self._generation += 1
            return self._generation

    def _hand_over(self, receive: Callable[..., None], generation: int, *what: Any) -> None:
        """To the session, which keeps the latest only: what is late must not take the place of what is wanted now."""
        with self._handing_over:
            if generation == self._generation:
                receive(generation, *what)

    def request_preview(self, energy: float) -> None:
        """Look quickly at another energy; the map on its way is cancelled, as its energy is not looked at any more."""
        if not is_ready_for_maps(self._state.potential):
            return
        self.cancel_map()
        self._want_another()
        self.previews.request(energy)

    def cancel_map(self) -> None:
        """Stop the map on its way, if any, and all second looks."""
        self._whole_map = None
        self._second_looks.follow(None)
        if self._map_ticket is not None:
            self._map_ticket.cancel()
            self._map_ticket = None

    def stop_map(self) -> None:
        """The user's cancel: stop, and paint no late frame; nothing, when the map is whole."""
        if self._whole_map is not None:
            return
        self.cancel_map()
        self._want_another()
        self._listener.map_stopped()

    def close(self, *_: Any) -> None:
        """The session is over: nobody waits for its jobs any more."""
        self._want_another()
        self.cancel_map()
        self.previews.cancel()

    def _map_arrived(self, generation: int, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        if generation == self._generation:
            self._listener.map_arrived(frame, columns)
            if frame.complete:
                self._whole_map = frame
                self._second_looks.follow(frame)

    def _map_failed(self, generation: int, error: Exception) -> None:
        if generation == self._generation:
            self._listener.map_failed(sentence(error))
