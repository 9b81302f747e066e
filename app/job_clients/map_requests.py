"""Requests for the map of the view state. A listener gets the frames of the map: partial results, then the complete map.

While the view does not change, the map is also computed with the pixels of its picture on the screen.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Protocol

from app.job_clients.latest_request import SKIPPED, LatestRequest, Locked
from app.state.view import sharper_resolution
from app.state.view_state import ViewState
from engine import EscapeMap, MapSpec
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.maps.map_jobs import map_job, members_job
from engine.maps.warmup import is_ready_for_maps, prepare_for_maps
from plots.layers.map_images import layer_columns
from plots.layers.table import LAYERS
from plots.pictures.image_columns import draw_over, map_columns

Columns = dict[str, list[Any]]
"""Columns of a data source of maps."""


def jobs_of_map(spec: MapSpec) -> list[Job[Any]]:
    """Return the jobs of a map in order. The last job computes the map.

    Earlier jobs compile the kernels if necessary, and find the potentials along a parameter of a typed formula.
    """
    jobs: list[Job[Any]] = []
    if not is_ready_for_maps(spec.potential):
        jobs.append(Job(prepare_for_maps, (spec.potential,), queue=Queue.COMPILATION))
    members = members_job(spec.plane.parameter)
    if members is not None:
        jobs.append(members)
    return [*jobs, map_job(spec)]


class MapListener(Protocol):
    """Shows the progress of a map."""

    def map_requested(self, *, compiling: bool = False) -> None:
        """Show that the map is requested, or with `compiling`, that its kernels are compiled."""

    def map_arrived(self, frame: EscapeMap, columns: Columns) -> None:
        """Show a frame of the map. The last frame is complete."""

    def map_sharpened(self, sharper_map: EscapeMap, columns: Columns) -> None:
        """Show the complete map with more pixels."""

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
        Called with frames and errors, under the session's lock.
    locked
        Wraps callbacks to run under the session's lock. Of several waiting calls, the latest alone may run.
    is_crowded
        Whether the server is crowded. Then only the first and the last frame of a map are shown.
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
        self._has_frame = False
        # The complete map of the view, and the same with the most pixels so far; None until they have arrived.
        self._complete_map: EscapeMap | None = None
        self._sharpest_map: EscapeMap | None = None
        # The job that was requested last for the current map.
        self._last_job: Job[Any] | None = None
        # The map of the last delivered frame, and its image columns.
        self._delivered_columns: tuple[MapSpec, Columns] | None = None
        self._request = LatestRequest(
            jobs, self._show, listener.map_failed, locked, convert=self._with_columns, begin=self._begin
        )
        state.param.watch(lambda *events: self._follow_layers(), ["layers", "compared"])
        self._sharper_request = LatestRequest(
            jobs, self._show_sharper, lambda sentence: None, locked, convert=self._sharper_columns
        )
        state.param.watch(
            lambda *events: self.request_map(), ["system", "plane", "section", "energy", "t_max", "resolution", "window"]
        )

    def request_map(self) -> None:
        """Cancel the current map, and request the map of the view state."""
        self._cancel()
        self._request.submit(*jobs_of_map(self._state.map_spec()))

    def stop_map(self) -> None:
        """Cancel an incomplete map for the user."""
        if self._complete_map is None:
            self._cancel()
            self._listener.map_stopped()

    def sharpen(self, pixels: int) -> None:
        """Request the complete map in view with more pixels, for a picture with this number of pixels along a side on the screen.

        All other computations go first, and only pictures change: numbers and data are those of the map of the view state.
        With 0 pixels, or if the map has enough, a request under way is cancelled. Pixels of layers and of a comparison belong to
        the map of the view, which is then not computed with more.
        """
        present = self._sharpest_map or self._complete_map
        side = None if present is None else sharper_resolution(present.spec.resolution[0], pixels)
        if present is None or side is None or self._has_more_pixels or self._is_crowded():
            self._sharper_request.cancel()
        else:
            self._sharper_request.submit(map_job(replace(present.spec, resolution=(side, side)), Queue.SPARE))

    def _cancel(self) -> None:
        self._has_frame, self._complete_map, self._sharpest_map = False, None, None
        self._last_job = None
        self._request.cancel()
        self._sharper_request.cancel()

    def _begin(self, job: Job[Any]) -> None:
        """Tell the listener about the first job of a map, and about the job after the compilation."""
        previous, self._last_job = self._last_job, job
        if previous is None or previous.queue is Queue.COMPILATION:
            self._listener.map_requested(compiling=job.queue is Queue.COMPILATION)

    def _with_columns(self, frame: EscapeMap) -> Any:
        """Return a frame with its columns, or `SKIPPED`; ValueError if the interior is empty."""
        # The ranges of the maps need the default window. Find and cache it here, because finding it is slow.
        replace(frame.spec, window=None).find_window()
        self._prepare(frame.spec)
        if self._has_frame and not frame.complete and self._is_crowded():
            return SKIPPED
        last_spec, last_columns = self._delivered_columns or (None, {})
        columns = map_columns(frame) | layer_columns(frame, self._state.layers)
        if last_spec is not None and _show_same_plane(last_spec, frame.spec):
            columns = draw_over(columns, last_columns, frame.spec.resolution)
        self._delivered_columns = frame.spec, columns
        return frame, columns

    def _show(self, result: tuple[EscapeMap, Columns]) -> None:
        frame, columns = result
        self._state.found_axis = frame.spec.plane.parameter
        self._listener.map_arrived(frame, columns)
        self._has_frame, self._complete_map = True, frame if frame.complete else None

    def _sharper_columns(self, frame: EscapeMap) -> Any:
        """Return a complete map with its columns; `SKIPPED` for a frame, which may be coarser than the map in view."""
        return (frame, map_columns(frame)) if frame.complete else SKIPPED

    def _show_sharper(self, result: tuple[EscapeMap, Columns]) -> None:
        self._sharpest_map = result[0]
        self._listener.map_sharpened(*result)

    @property
    def _has_more_pixels(self) -> bool:
        """Whether layers or a comparison have pixels beside those of the map."""
        layers = [LAYERS[name] for name in self._state.layers]
        return self._state.compared is not None or any(layer.pixels is not None for layer in layers)

    def _follow_layers(self) -> None:
        """Show the map of the view again when layers or a comparison get pixels."""
        complete_map = self._complete_map
        if complete_map is None or not self._has_more_pixels:
            return
        self._sharper_request.cancel()
        if self._sharpest_map is not None and self._delivered_columns is not None:
            self._sharpest_map = None
            _, columns = self._delivered_columns
            self._listener.map_arrived(complete_map, columns | layer_columns(complete_map, self._state.layers))


def _show_same_plane(one: MapSpec, other: MapSpec) -> bool:
    """Whether two maps show the same plane at the same energy; window, resolution and t_max may differ."""
    return (one.potential, one.plane, one.energy) == (other.potential, other.plane, other.energy)
