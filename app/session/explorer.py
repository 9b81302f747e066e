"""The explorer of one session: connects view state, requests and views."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import panel as pn

from app.browser.browser_system import make_browser_system
from app.browser.engine_component import BrowserEngine
from app.browser.views import describe_view
from app.job_clients.error_messages import WINDOW_UNKNOWN, ZOOM_ENDS
from app.job_clients.latest_request import LatestRequest
from app.job_clients.map_requests import MapRequests
from app.job_clients.orbit_requests import ChosenOrbit
from app.runtime.disconnects import on_disconnect
from app.runtime.process_state import process_state
from app.runtime.session_callbacks import SessionCallbacks
from app.runtime.visitors import account_of
from app.session.analysis_presenter import AnalysisPresenter
from app.session.comparison_presenter import ComparisonPresenter
from app.session.context import SessionContext
from app.session.link_presenter import LinkPresenter
from app.session.orbit_presenter import OrbitPresenter
from app.session.potential_presenter import PotentialPresenter
from app.session.watch_presenter import WatchPresenter
from app.state.glossary import glossary_list
from app.state.navigation import DIVE_FACTOR, window_moves, zoom
from app.state.presets import Preset
from app.state.view import Analysis, Start
from app.views.analysis.statistics import StatisticsView
from app.views.components.analysis_choice import AnalysisTabs
from app.views.components.collapsible_section import Drawers, Fold, Stack
from app.views.components.notice import Notice
from app.views.components.progress import ProgressView
from app.views.components.texts import TextPane
from app.views.maps.map_plots import MapActions, MapsView
from app.views.maps.map_toolbar import MapToolbar
from app.views.orbits.path_picture import path_picture
from app.views.panels.accessible_table import AccessibleTable
from app.views.panels.browser_events import KEYS, PICTURE_KEYS, WINDOW_KEYS, BrowserActions, BrowserEvents, key_legend
from app.views.panels.controls import ControlActions, Controls
from app.views.panels.downloads import Downloads
from app.views.panels.embedding import embed_code, page_address
from app.views.panels.equations import equations_pane
from app.views.panels.gallery import Gallery
from app.views.panels.slice_panel import SlicePanel
from engine import EscapeMap, Fate, Potential, Slice, System, Window
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.maps.warmup import is_ready_for_maps, seconds_until_ready_for_maps
from engine.propagation.fates import describe_fate
from engine.slices.planes import checked_slice
from plots.pictures.palette import MOST_ORBITS, PALETTES


class Explorer:
    """The explorer of one session: its state, requests and views."""

    def __init__(self) -> None:
        document = pn.state.curdoc
        assert document is not None, "an Explorer belongs to a session: start it with 'panel serve app'"
        parameters = _parameters()
        self.links = LinkPresenter(document, parameters)
        self.state = self.links.state
        self._document = document
        self._by_touch = False
        self._countdown: Any = None
        # The start of the last click; None if it was chosen before.
        self._just_added: Start | None = None
        # The same until its orbit has been told of.
        self._tapped: Start | None = None
        callbacks = SessionCallbacks(document)
        # Panel runs widget callbacks without the session's lock, which changes of bare Bokeh models need.
        self._locked, self._latest = callbacks.every, callbacks.latest
        self._make_views()
        process = process_state()
        jobs = self._client = JobClient(process.jobs, account=account_of(document))
        on_disconnect(document, self._client.close)
        context = SessionContext(self.state, jobs, self._locked, self._latest, self._copy_text, self._open_view)
        self.potential = PotentialPresenter(context, self.links.history)
        self.analyses = AnalysisPresenter(context, self.maps, self.downloads.show_analyses, self.downloads.show_curves)
        self.comparison = ComparisonPresenter(
            context, self.maps, lambda sentence: self.analyses.note(compared=sentence), self.links.refuse_comparison
        )
        self.map_requests = MapRequests(self.state, jobs, self, self._latest, self.analyses.follow_ups(), process.is_overloaded)
        self._browser_systems = LatestRequest(jobs, self.engine.show_system, lambda sentence: None, self._locked)
        self.orbits = OrbitPresenter(context, self.maps.marks, self.maps.well, self._add_start, self._show_orbits)
        self.watch = WatchPresenter(context)
        self.analysis = Stack(
            {
                Analysis.ORBIT: lambda: [self.orbits.inspector.layout(), self.gallery.invitation()],
                Analysis.STATISTICS: self.statistics.build,
                Analysis.MEASURES: self.analyses.measures.build,
                Analysis.ENERGIES: self.analyses.curves.build,
                Analysis.WATCH: self.watch.build,
            },
            "analysis",
            head=[AnalysisTabs(self.state).tabs],
        )
        self.progress = ProgressView(
            self._locked(self.map_requests.stop_map),
            self._locked(self.map_requests.request_map),
            self._locked(lambda name: self.state.switch_layer(name, on=True)),
        )
        self._requested_at: float | None = None
        self._connect()
        pn.state.on_session_destroyed(self.close)
        pn.state.onload(lambda: self.links.begin(self._begin_view))

    def _make_views(self) -> None:
        state, locked = self.state, self._locked
        self.maps = MapsView(
            MapActions(
                tap=locked(self._add_start),
                dive=locked(self._dive),
                zoom=locked(self._zoom_to),
                rest=locked(self.links.history.end_gesture),
                box=locked(self._count_in),
                choose=locked(lambda name: state.param.update(focus=name)),
            ),
            alone=self.links.embedded,
        )
        self.toolbar = MapToolbar(locked(lambda: state.param.update(window=None)), locked(self.maps.set_drag))
        self.statistics = StatisticsView(locked(lambda: self._count_in(None)), self._copy_text)
        self.accessible_table = AccessibleTable(state)
        self.browser = BrowserEvents(
            BrowserActions(
                key=locked(self._press),
                navigate=locked(self.links.navigate),
                dark=locked(self.set_dark),
                touch=locked(self._begin_touch),
                narrow=locked(self.maps.grid.offer_choice),
                copied=locked(self._copied),
                enlarge=locked(self._enlarge),
            ),
            WINDOW_KEYS if self.links.embedded else KEYS,
        )
        self.engine = BrowserEngine(locked(self._end_animation))
        self.downloads: Downloads = Downloads(state, self._copy_link, self._copy_embed_code, locked(self._copied))
        self.notice = Notice()
        self.gallery = Gallery(locked(self._show_preset))
        actions = ControlActions(
            play=locked(self._play),
            choose_potential=locked(lambda: self.drawers.toggle("potential")),
            choose_slice=locked(lambda: self.drawers.toggle("slice")),
            compare=locked(self._compare),
            swap=locked(self._swap_views),
            lock_times=locked(lambda on: state.param.update(lock_times=self.maps.times if on else None)),
        )
        self.controls = Controls(state, actions)
        self.drawers = Drawers(
            {
                "potential": ("", "Potential", lambda: self.potential.panel.build()),
                "slice": ("", "Slice", lambda: SlicePanel(state, locked(self._show_slice)).build()),
                "gallery": ("Gallery", "Gallery", self.gallery.build),
                "share": ("Share", "Share and download", self.downloads.build),
                "help": ("Help", "Help", self._build_help),
            },
            self.browser.focus_drawer,
        )

    def _connect(self) -> None:
        follow, watch = self.state.follow, self.state.param.watch
        follow(self._set_palette, "palette")
        follow(self.maps.lock_times, "lock_times")
        follow(lambda window: self.toolbar.follow(zoomed=window is not None), "window")
        watch(self._go_to_window, ["system", "plane", "window"])
        follow(lambda starts: self.gallery.invite(on=not starts), "starts")
        watch(self._remove_box, ["system", "plane", "window", "box"])
        follow(self._show_box, "box")
        follow(self._show_analysis, "analysis")
        follow(self.maps.grid.enlarge, "focus")
        self.links.connect(self.potential, self.browser, self.progress, self.notice)

    def close(self, *_: Any) -> None:
        """Cancel all requests at the end of the session."""
        for requests in (self.map_requests, self.orbits, self.analyses, self.comparison, self.watch, self.potential):
            requests.close()
        self._browser_systems.cancel()
        self._client.close()

    def set_dark(self, dark: bool) -> None:
        """Use the line colours of the dark or the light theme."""
        with pn.io.hold():
            self.maps.set_dark(dark)

    def _begin_view(self) -> None:
        """Request the map and the orbits of the state, which later follow its changes."""
        self.map_requests.request_map()
        self.orbits.begin()

    def _set_palette(self, name: str) -> None:
        with pn.io.hold():
            for view in (self.maps, self.orbits, self.statistics, self.analyses, self.progress):
                view.set_palette(PALETTES[name])

    def _add_middle(self) -> None:
        """Add the start in the middle of the window."""
        window = self._window()
        x, ordinate = 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high)
        self._add_start(*self.maps.snapped(x, ordinate))

    def _begin_touch(self) -> None:
        self._by_touch = True
        self.toolbar.begin_touch()
        self.maps.begin_touch()
        self.controls.begin_touch()
        self.orbits.begin_touch()

    def _build_help(self) -> list[pn.viewable.Viewable]:
        return [
            TextPane(f"<h3>Keys</h3>{key_legend()}", sizing_mode="stretch_width", margin=(0, 10)),
            equations_pane(self.state),
            *Fold("Terms", lambda: [TextPane(glossary_list(), sizing_mode="stretch_width", margin=(0, 10))]).parts(),
            *self.accessible_table.fold.parts(),
        ]

    def _show_analysis(self, analysis: Analysis) -> None:
        self.analysis.show(analysis)
        self.statistics.activate(analysis is Analysis.STATISTICS)

    # Callbacks of the views.

    def _zoom_to(self, window: Window | None) -> None:
        self.links.history.begin_gesture()
        try:
            self._show_window(window)
        finally:
            self.maps.ranges.finish_report()

    def _go_to_window(self, *events: Any) -> None:
        """Show the window of the state before its map is there, as a late report of an earlier move would count as a new one."""
        if any(event.name != "window" for event in events):
            # Another picture brings its window with it.
            return
        try:
            self.maps.ranges.go_to(self._window())
        except ValueError:
            # The map brings a window that is not known yet.
            return

    def _show_window(self, window: Window | None) -> None:
        """Show another window; where double precision ends, the last one stays."""
        try:
            if window is not None:
                replace(self.state.map_spec(), window=window).find_window()
        except ValueError:
            self.notice.show(ZOOM_ENDS)
            self.maps.ranges.follow(self._window())
        else:
            self.state.window = window

    def _dive(self, x: float, ordinate: float) -> None:
        """Zoom to a point that is clicked twice; the first click is no choice of an orbit."""
        state = self.state
        if self._just_added in state.starts:
            state.remove_start(state.starts.index(self._just_added))
        self._show_window(zoom(self._window(), DIVE_FACTOR, (x, ordinate)))

    def _enlarge(self, name: str) -> None:
        """Show a picture large, or all side by side if it is large already."""
        self.state.focus = "" if name == self.state.focus else name

    def _add_start(self, x: float, ordinate: float) -> None:
        """Add a start, or say why not; a forbidden start takes no place."""
        state = self.state
        if state.orbit_job((x, ordinate)) is None:
            self.notice.show(describe_fate(Fate.FORBIDDEN))
            return
        # The first orbits add figures and buttons: Bokeh searches the models of the page once for all of them.
        before = state.starts
        with self._document.models.freeze():
            added = state.add_start((x, ordinate))
            state.analysis = Analysis.ORBIT
        self._just_added = self._tapped = (x, ordinate) if state.starts != before else None
        if not added:
            self.notice.show(f"{MOST_ORBITS} orbits are shown already. Remove one first.")

    def _count_in(self, box: Window | None) -> None:
        """Count in a box, and show the statistics unless the measures are in view; None removes the box."""
        shown = self.state.analysis
        self.state.param.update(box=box, analysis=shown if box is None or shown is Analysis.MEASURES else Analysis.STATISTICS)

    def _remove_box(self, *events: Any) -> None:
        """Remove the box of another view, unless a link gives a new one."""
        if all(event.name != "box" for event in events):
            self._count_in(None)

    def _show_box(self, box: Window | None) -> None:
        self.maps.marks.show_box(box)
        self.statistics.show_box(box)

    def _compare(self, on: bool) -> None:
        """Compare later views with the present one in the same window, or end the comparison."""
        state = self.state
        if not on:
            state.compared = None
            return
        window = self._window() if is_ready_for_maps(state.potential) else state.window
        state.param.update(compared=state.view, window=window)

    def _swap_views(self) -> None:
        """Exchange the view of the controls and the one that it is compared with."""
        state, other = self.state, self.state.compared
        if other is None:
            return
        energy = {} if other.energy is None else {"energy": other.energy}
        self._open_view(other.system, {"plane": other.plane, **energy, "window": state.window, "compared": state.view})

    def _show_slice(self, plane: Slice) -> None:
        self.state.show_slice(checked_slice(plane))

    def _open_view(self, system: System, values: dict[str, Any]) -> None:
        """Show a system, once it is reviewed, with other values of the state."""
        self.links.open(system, partial(self.state.show, **values))

    def _show_preset(self, preset: Preset) -> None:
        self.engine.stop()
        # On a narrow screen the drawer covers the maps.
        if self._by_touch:
            self.drawers.show(None)
        self._open_view(preset.view.system, preset.view.within_limits().values())

    def _copied(self, success: bool) -> None:
        self.notice.show("Copied." if success else "The browser does not allow copying.")

    def _copy_text(self, text: str) -> None:
        self.browser.copy(text)

    def _copy_link(self) -> None:
        self.browser.copy(None)

    def _copy_embed_code(self) -> None:
        self.browser.copy(embed_code(page_address(self._document.session_context.request), self.state))

    def _press(self, key: str) -> None:
        """Handle a key of `KEYS`."""
        moves: dict[str, Callable[[], Any]] = {
            **window_moves(self._show_window, self._window),
            "b": self.browser.go_back,
            "f": self.browser.go_forward,
            "p": self._play,
            "Enter": self._add_middle,
            "Escape": self._escape,
            "?": lambda: self.drawers.toggle("help"),
            **{key: partial(self._enlarge, name) for key, name in PICTURE_KEYS.items()},
        }
        try:
            moves[key]()
        except ValueError as error:
            self.notice.warn(str(error))

    def _window(self) -> Window:
        """The window in view; ValueError while it is not known, as the event loop must not compile the kernels that find it."""
        if self.state.window is None and not is_ready_for_maps(self.state.potential):
            raise ValueError(WINDOW_UNKNOWN)
        return self.state.map_spec().find_window()

    def _escape(self) -> None:
        """Close the open drawer, or stop the animation, or show all pictures, or else stop the map."""
        if self.drawers.shown is not None:
            self.drawers.show(None)
        elif self.engine.playing:
            self.engine.stop()
        elif self.state.focus:
            self.state.focus = ""
        else:
            self.map_requests.stop_map()

    def _play(self) -> None:
        if self.engine.playing:
            self.engine.stop()
        elif self.state.plane.energy_axis is None:
            energies = self.state.energies
            self.engine.play(self.state.energy, energies.low, energies.high)
            self.controls.show_playing(True)

    def _end_animation(self, energy: float) -> None:
        self.controls.show_playing(False)
        self.state.energy = round(energy, self.state.energies.decimals)

    # Results of requests.

    def map_requested(self, *, compiling: bool = False) -> None:
        """A map is requested."""
        self.engine.show_view(describe_view(self.state))
        if compiling:
            # The pictures of the former system stay for some seconds.
            self.maps.grid.mark_stale(True)
        self._requested_at = time.monotonic()
        self.progress.start()
        self._count_down(compiling)
        self.notice.clear()

    def _count_down(self, compiling: bool) -> None:
        """Show each second how long the compilation will take, while it is under way."""
        if self._countdown is not None:
            self._document.remove_periodic_callback(self._countdown)
            self._countdown = None
        if compiling:
            self._countdown = self._document.add_periodic_callback(self._show_compiling, 1000)
            self._show_compiling()

    def _show_compiling(self) -> None:
        self.progress.show_compiling(seconds_until_ready_for_maps(self.state.potential))

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame of a map."""
        if self._requested_at is not None:
            process_state().metrics.first_frame.observe(time.monotonic() - self._requested_at)
            self._requested_at = None
        with pn.io.hold():
            self.analyses.begin(frame.spec)
            self.maps.ranges.set_home(replace(frame.spec, window=None))
            self.maps.show(frame, columns)
            self.maps.grid.mark_stale(False)
            self.progress.show(frame)
            self._request_browser_system(frame.spec.potential)
            if frame.stride == 1:
                self.statistics.show(frame)
            self.downloads.show_map(frame)
            if frame.complete:
                self.accessible_table.show_map(frame)
                self.comparison.follow(frame)
                self.watch.request_rate()

    def _request_browser_system(self, potential: Potential) -> None:
        """Request the system of the maps for the engine in the browser, which needs the compiled kernels, once."""
        if potential == self.state.potential:
            arguments = potential, self.state.energies.low, self.state.energies.high
            self._browser_systems.submit(Job(make_browser_system, arguments, queue=Queue.LONG_CALL))

    def map_stopped(self) -> None:
        """The map is cancelled."""
        self._count_down(False)
        self.progress.stop()
        self.analyses.end_computing()

    def map_failed(self, sentence: str) -> None:
        """Show why there is no map; the last pictures stay, greyed out."""
        self._count_down(False)
        self.progress.fail()
        self.analyses.end_computing()
        self.maps.grid.mark_stale(True)
        self.notice.warn(sentence)

    def _show_orbits(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Offer the orbits to download and to screen readers."""
        self.downloads.show_orbits(orbits)
        self.accessible_table.show_orbits(orbits)
        if self._by_touch:
            self._tell_tapped(orbits)

    def _tell_tapped(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Show the verdict and the path of an orbit that has been tapped: on a phone both are out of view."""
        for one, colour in zip(orbits, PALETTES[self.state.palette].orbits, strict=False):
            if one.start == self._tapped and one.drawing is not None:
                self._tapped = None
                self.notice.show(one.headline(), path_picture(one.drawing, colour))


def _parameters() -> dict[str, str]:
    """The parameters in the page's address."""
    return {name: texts[0].decode(errors="replace") for name, texts in dict(pn.state.session_args or {}).items()}
