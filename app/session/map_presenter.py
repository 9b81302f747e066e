"""The maps of one session: requests, pictures, moves to other windows, clicks and boxes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import panel as pn

from app.job_clients.error_messages import ZOOM_ENDS
from app.job_clients.map_requests import MapRequests
from app.runtime.process_state import process_state
from app.session.context import History, SessionContext
from app.state.navigation import DOUBLE_CLICK_ZOOM_FACTOR, zoom
from app.state.view import Analysis
from app.state.view_state import STARTS_FULL
from app.views.maps.map_plots import MapActions, MapsView, prepare_curves
from app.views.maps.map_toolbar import MapToolbar
from app.views.maps.progress import ProgressView
from app.views.panels.engine_component import BrowserEngine
from engine import EscapeMap, Fate, Window
from engine.propagation.fates import describe_fate
from plots.links.map_view import Start


class MapPresenter:
    """Requests and shows the map of the view state; moves and clicks change the view state.

    Parameters
    ----------
    context
        The session.
    history
        Numbers the entries of the browser's history; the moves of one gesture make one entry.
    alone
        Whether the page shows only one picture, in an iframe of another page.
    """

    def __init__(self, context: SessionContext, history: History, *, alone: bool) -> None:
        state, locked = context.state, context.locked
        self._state, self._results, self._notice = state, context.results, context.notice
        self._history = history
        # Time of the latest request, in seconds; None once its first frame has arrived.
        self._requested_at: float | None = None
        # The start that the last click added; None if the start was in the list already.
        self._added_start: Start | None = None
        self.engine = BrowserEngine(
            state, context.results, context.jobs, locked, self._zoom_to, history.end_gesture, self._sharpen
        )
        self.view = MapsView(
            state,
            MapActions(locked(self.add_start), locked(self._zoom_to_point), locked(self._count_in)),
            self.engine,
            alone=alone,
        )
        self.toolbar = MapToolbar(state, locked(self.view.tools.set_drag))
        self.requests = MapRequests(state, context.jobs, self, context.latest, process_state().is_crowded, prepare_curves)
        self.progress = ProgressView(state, locked(self.requests.stop_map), locked(self.requests.request_map))
        state.param.watch(self._go_to_window, ["system", "plane", "window"])
        state.param.watch(self._remove_box, ["system", "plane", "window", "box"])

    # Windows, starts and boxes.

    def show_window(self, window: Window | None) -> None:
        """Show another window, or, where double precision ends, return the pictures to the present window."""
        try:
            if window is not None:
                replace(self._state.map_spec(), window=window).find_window()
        except ValueError:
            self._notice.show(ZOOM_ENDS)
            if self._state.is_window_known:
                self.engine.go_to(self._state.find_window())
        else:
            self._state.window = window

    def move(self, change: Callable[[Window], Window] | None) -> None:
        """Show the window to which `change` leads from the window in view, or the whole interior for None.

        Raises ValueError if the window in view is needed but not known, or if the new window is too small for double precision.
        """
        self.show_window(None if change is None else change(self._state.find_window()))

    def _zoom_to(self, window: Window | None) -> None:
        """Show the window to which a gesture has moved the pictures; None is the whole interior."""
        self._history.begin_gesture()
        self.show_window(window)

    def _go_to_window(self, *events: Any) -> None:
        """Show the window of the state at once. The map of another system or plane arrives with its own window."""
        if any(event.name != "window" for event in events):
            self.engine.leave_window()
            return
        try:
            self.engine.go_to(self._state.find_window())
        except ValueError:
            # A default window that is not known yet arrives with the map.
            return

    def _zoom_to_point(self, x: float, ordinate: float) -> None:
        """Zoom to a double-clicked point, and remove the start that the first click has added."""
        state = self._state
        if self._added_start in state.starts:
            state.remove_start(state.starts.index(self._added_start))
        self.move(lambda window: zoom(window, DOUBLE_CLICK_ZOOM_FACTOR, (x, ordinate)))

    def add_middle(self) -> None:
        """Add the start in the middle of the window."""
        window = self._state.find_window()
        x, ordinate = 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high)
        self.add_start(*self.view.snapped(x, ordinate))

    def add_start(self, x: float, ordinate: float) -> None:
        """Add a start, or say why it is not added: it is forbidden, or the list is full."""
        state = self._state
        if state.orbit_job((x, ordinate)) is None:
            self._notice.show(describe_fate(Fate.FORBIDDEN))
            return
        before = state.starts
        added = state.add_start((x, ordinate))
        state.analysis = Analysis.ORBIT
        self._added_start = (x, ordinate) if state.starts != before else None
        if not added:
            self._notice.show(STARTS_FULL)

    def _count_in(self, box: Window) -> None:
        """Count the starts in a box, and show the statistics unless the measures are open."""
        shown = self._state.analysis
        self._state.param.update(box=box, analysis=shown if shown == Analysis.MEASURES else Analysis.STATISTICS)

    def _remove_box(self, *events: Any) -> None:
        """Remove the box when another view is shown, unless the view comes with a box."""
        if all(event.name != "box" for event in events):
            self._state.box = None

    # Requests and their results.

    def _sharpen(self, pixels: int) -> None:
        self.requests.sharpen(pixels)

    def map_requested(self, *, compiling: bool = False) -> None:
        """Show that a map is requested."""
        self._requested_at = time.monotonic()
        self.progress.start()
        if compiling:
            # The pictures of the previous system stay, greyed out, until the kernels are compiled.
            self.view.grid.mark_stale(True)
            self.progress.show_compiling()
        self._notice.clear()

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame of a map."""
        if self._requested_at is not None:
            process_state().metrics.first_frame.observe(time.monotonic() - self._requested_at)
            self._requested_at = None
        with pn.io.hold():
            self.view.show(frame, columns)
            self.view.grid.mark_stale(False)
            self.progress.show(frame)
            self._results.param.update(frame=frame, sharper_map=None)

    def map_sharpened(self, sharper_map: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint the complete map with more pixels."""
        with pn.io.hold():
            self.view.sharpen(sharper_map, columns)
            self._results.sharper_map = sharper_map

    def map_stopped(self) -> None:
        """Show that the map is cancelled."""
        self.progress.stop()

    def map_failed(self, sentence: str) -> None:
        """Show why there is no map; the last pictures stay and are greyed out."""
        self.progress.fail()
        self.view.grid.mark_stale(True)
        self._notice.warn(sentence)
