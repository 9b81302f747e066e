"""Requests for the map of the view state, whose frames go to a listener."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

from app.job_clients.latest_request import SKIPPED, LatestRequest, Locked
from app.state.view_state import ViewState
from engine import EscapeMap, MapSpec
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.sweeps.map_jobs import map_job, members_job
from engine.sweeps.warmup import is_ready_for_maps, prepare_for_maps
from plots.layers.map_images import layer_columns
from plots.pictures.image_columns import draw_over, map_columns

Columns = dict[str, list[Any]]
"""Columns of a data source of maps."""


def jobs_of_map(spec: MapSpec) -> list[Job[Any]]:
    """Return the jobs of a map in order; the last computes the map.

    Before it, the kernels are compiled if they are not, and along a parameter of a typed formula the potentials are found.
    """
    potential, members = spec.potential, members_job(spec.plane.parameter)
    compilation = [] if is_ready_for_maps(potential) else [Job(prepare_for_maps, (potential,), queue=Queue.COMPILATION)]
    return [*compilation, *([] if members is None else [members]), map_job(spec)]


class MapListener(Protocol):
    """Receives the progress of a map."""

    def map_requested(self, *, compiling: bool = False) -> None:
        """Take note of a request of the map, or with `compiling` of the compilation of its kernels."""

    def map_arrived(self, frame: EscapeMap, columns: Columns) -> None:
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
        self._state, self._listener, self._is_crowded, self._prepare = state, listener, is_crowded, prepare
        self._has_complete_map = False
        # The map of the last delivered frame, and its image columns.
        self._delivered_columns: tuple[MapSpec, Columns] | None = None
        self._request = LatestRequest(
            jobs, self._show, listener.map_failed, locked, convert=self._with_columns, begin=self._begin
        )
        state.param.watch(lambda *events: self.request_map(), ["system", "plane", "energy", "t_max", "resolution", "window"])

    def request_map(self) -> None:
        """Cancel the current map, and request the map of the view state."""
        self._cancel()
        self._request.submit(*jobs_of_map(self._state.map_spec()))

    def stop_map(self) -> None:
        """Cancel an incomplete map for the user."""
        if not self._has_complete_map:
            self._cancel()
            self._listener.map_stopped()

    def _cancel(self) -> None:
        self._has_complete_map = False
        self._request.cancel()

    def _begin(self, job: Job[Any]) -> None:
        self._listener.map_requested(compiling=job.queue is Queue.COMPILATION)

    def _with_columns(self, frame: EscapeMap) -> Any:
        """Return a frame with its columns; ValueError if the interior is empty. A crowded server skips the frames in between."""
        # The ranges of the maps need this window. Finding it is slow, so it is found here and cached.
        replace(frame.spec, window=None).find_window()
        self._prepare(frame.spec)
        before = self._delivered_columns
        if before is not None and before[0] == frame.spec and not frame.complete and self._is_crowded():
            return SKIPPED
        columns = map_columns(frame) | layer_columns(frame, self._state.layers)
        if before is not None and _has_same_starts(before[0], frame.spec):
            columns = draw_over(columns, before[1], frame.spec.resolution)
        self._delivered_columns = frame.spec, columns
        return frame, columns

    def _show(self, shown: tuple[EscapeMap, Columns]) -> None:
        frame, columns = shown
        self._listener.map_arrived(frame, columns)
        self._has_complete_map = frame.complete


def _has_same_starts(one: MapSpec, other: MapSpec) -> bool:
    """Whether two maps show the same plane at the same energy; window, resolution and t_max may differ."""
    return (one.potential, one.plane, one.energy) == (other.potential, other.plane, other.energy)
