"""Requests for the map of the view state, whose frames go to a listener."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, Protocol

from app.job_clients.error_messages import sentence
from app.job_clients.latest_request import Locked
from app.state.view_state import ViewState
from engine import EscapeMap, MapSpec
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.jobs.subscription import Subscription
from engine.sweeps.map_jobs import map_job, members_job
from engine.sweeps.warmup import is_ready_for_maps, prepare_for_maps
from plots.layers.map_images import layer_columns
from plots.pictures.image_columns import draw_over, map_columns


class MapListener(Protocol):
    """Receives the progress of a map."""

    def map_requested(self, *, compiling: bool = False) -> None:
        """Take note of a request. `compiling` says whether the integrator of the map must be compiled first."""

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Show a frame; the last frame is complete."""

    def map_stopped(self) -> None:
        """Show that the user has cancelled the map."""

    def map_failed(self, sentence: str) -> None:
        """Show why the map has failed."""


class MapRequests:
    """Requests the maps of one session, one at a time.

    Parameters
    ----------
    state
        View state. A change of what the map shows requests a new map.
    jobs
        Computes the maps.
    listener
        Receives frames and errors, under the session's lock.
    locked
        Wraps callbacks to run under the session's lock; it may run only the latest of several waiting calls.
    is_crowded
        Whether the server is crowded. It then skips the frames between the first and the last.
    prepare
        Computes what the listener needs for a map, on the thread of the job, before a frame of the map is delivered.
    """

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        listener: MapListener,
        locked: Locked,
        is_crowded: Callable[[], bool] = lambda: False,
        prepare: Callable[[MapSpec], object] = lambda spec: None,
    ) -> None:
        self._state, self._jobs, self._listener = state, jobs, listener
        self._subscription: Subscription | None = None
        self._has_complete_map = False
        # Each request begins a generation; results of earlier generations are dropped.
        self._generation = 0
        self._generation_lock = threading.RLock()
        # The latest generation that has delivered a frame.
        self._generation_with_frame = -1
        # The map of the last delivered frame, and its image columns.
        self._delivered_columns: tuple[MapSpec, dict[str, list[Any]]] | None = None
        self._is_crowded, self._prepare = is_crowded, prepare
        self._continue = locked(self._on_compiled)
        self._show_members = locked(self._on_members)
        self._show_frame = locked(self._on_frame)
        self._show_error = locked(self._on_error)
        state.param.watch(lambda *events: self.request_map(), ["system", "plane", "energy", "t_max", "resolution", "window"])

    def request_map(self) -> None:
        """Cancel the current map, and request the map of the view state."""
        self.cancel_map()
        generation = self._start_generation()
        potential, spec = self._state.potential, self._state.map_spec()
        compiling = not is_ready_for_maps(potential)
        self._listener.map_requested(compiling=compiling)
        if compiling:
            compilation = Job(prepare_for_maps, (potential,), queue=Queue.COMPILATION)
            self._request(compilation, generation, lambda _: self._deliver(self._continue, generation, spec))
        else:
            self._request_compiled(generation, spec)

    def _on_compiled(self, generation: int, spec: MapSpec) -> None:
        if generation == self._generation:
            self._listener.map_requested()
            self._request_compiled(generation, spec)

    def _request_compiled(self, generation: int, spec: MapSpec) -> None:
        """Request the frames. Along a parameter of a typed formula, first request the potentials, whose review takes time."""
        members = members_job(spec.plane.parameter)
        if members is None:
            self._request_frames(generation, spec)
        else:
            self._request(members, generation, lambda _: self._deliver(self._show_members, generation, spec))

    def _on_members(self, generation: int, spec: MapSpec) -> None:
        if generation == self._generation:
            self._request_frames(generation, spec)

    def _request_frames(self, generation: int, spec: MapSpec) -> None:
        self._request(map_job(spec), generation, lambda frame: self._deliver_frame(generation, frame))

    def _request(self, job: Job[Any], generation: int, on_result: Callable[[Any], None]) -> None:
        on_error = partial(self._deliver, self._show_error, generation)
        self._subscription = self._jobs.request(job, on_result, on_error)

    def _deliver_frame(self, generation: int, frame: EscapeMap) -> None:
        """Deliver a frame, or an error if the interior is empty. A crowded server skips the frames between first and last."""
        try:
            # The ranges of the maps need this window. Finding it is slow, so it is found here and cached.
            replace(frame.spec, window=None).find_window()
            self._prepare(frame.spec)
        except ValueError as error:
            self._deliver(self._show_error, generation, error)
            return
        if self._generation_with_frame == generation and not frame.complete and self._is_crowded():
            return
        columns = map_columns(frame) | layer_columns(frame, self._state.layers)
        if self._delivered_columns is not None and _has_same_starts(self._delivered_columns[0], frame.spec):
            columns = draw_over(columns, self._delivered_columns[1], frame.spec.resolution)
        self._delivered_columns = frame.spec, columns
        self._deliver(self._show_frame, generation, frame, columns)
        self._generation_with_frame = generation

    def _start_generation(self) -> int:
        """Invalidate the results of all earlier requests."""
        with self._generation_lock:
            self._generation += 1
            return self._generation

    def _deliver(self, callback: Callable[..., None], generation: int, *arguments: Any) -> None:
        """Pass on a result of the current generation. An outdated call would replace the only waiting call of the session."""
        with self._generation_lock:
            if generation == self._generation:
                callback(generation, *arguments)

    def cancel_map(self) -> None:
        """Cancel the map."""
        self._has_complete_map = False
        if self._subscription is not None:
            self._subscription.cancel()
            self._subscription = None

    def stop_map(self) -> None:
        """Cancel an incomplete map for the user, and drop its late frames."""
        if self._has_complete_map:
            return
        self.cancel_map()
        self._start_generation()
        self._listener.map_stopped()

    def close(self, *_: Any) -> None:
        """Cancel everything at the end of the session."""
        self._start_generation()
        self.cancel_map()

    def _on_frame(self, generation: int, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        if generation == self._generation:
            self._listener.map_arrived(frame, columns)
            self._has_complete_map = frame.complete

    def _on_error(self, generation: int, error: Exception) -> None:
        if generation == self._generation:
            self.cancel_map()
            self._listener.map_failed(sentence(error))


def _has_same_starts(one: MapSpec, other: MapSpec) -> bool:
    """Whether two maps show the same plane at the same energy; window, resolution and t_max may differ."""
    return (one.potential, one.plane, one.energy) == (other.potential, other.plane, other.energy)
