"""The explorer of one session: view state, requests and views, put together; frames and orbits go to the views."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict
from functools import partial
from typing import Any

import panel as pn

from app.job_clients.energy_animation import EnergyAnimation
from app.job_clients.indicators_requests import IndicatorsRequests
from app.job_clients.map_requests import MapRequests
from app.job_clients.orbit_requests import ChosenOrbit, OrbitRequests
from app.job_clients.preview_requests import LoadPolicy
from app.job_clients.separation_requests import SeparationRequests
from app.job_clients.twin_requests import TwinRequests
from app.runtime.disconnects import when_left
from app.runtime.job_pool import is_pressed, shared_jobs
from app.runtime.metrics import observe_first_frame
from app.runtime.settings import current_settings
from app.session.analysis_presenter import AnalysisPresenter
from app.session.potential_presenter import PotentialPresenter
from app.state.navigation import Navigation
from app.state.permalink import LINKED, read_link, write_link
from app.state.presets import Preset
from app.state.system import SYSTEM, System
from app.state.view_state import ViewState
from app.views.analysis.statistics import StatisticsView
from app.views.components.progress import ProgressView
from app.views.maps.map_plots import MapsView
from app.views.maps.markers import NO_POINTS
from app.views.maps.zoom_buttons import ZoomButtons
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from app.views.orbits.orbit_layout import OrbitLayout
from app.views.orbits.orbit_plots import OrbitPlots
from app.views.orbits.playback import Playback
from app.views.orbits.separation_plot import SeparationPlot
from app.views.panels.accessible_table import AccessibleTable
from app.views.panels.controls import ControlActions, Controls
from app.views.panels.downloads import Downloads
from app.views.panels.gallery import Gallery
from app.views.panels.keyboard import Keyboard
from app.views.panels.tour import Tour
from engine import EscapeMap, JobClient, Plane, Window

# Between two questions whether there is time for a quick look again.
_PATIENCE_MS = 300


class Explorer:
    """The explorer of escapes; one for each visitor."""

    def __init__(self) -> None:
        document = pn.state.curdoc
        assert document is not None, "an Explorer belongs to a session: start it with 'panel serve app'"
        values, self._problems = read_link(_parameters())
        self.state = ViewState(**values)
        self._latest = partial(document.locked_callback, policy="latest")
        # Clicks come without the session's lock, which bare Bokeh models need.
        self._locked: Callable[..., Any] = document.locked_callback
        self._make_views()
        jobs = self._visitor = JobClient(shared_jobs(), current_settings().jobs_per_session)
        when_left(document, self._visitor.close)
        self.potential = PotentialPresenter(self.state, jobs, self._locked)
        self.why = AnalysisPresenter(self.state, jobs, self.maps, self.take_along.show_findings, self._locked)
        patience = LoadPolicy(is_pressed, lambda call: document.add_timeout_callback(call, _PATIENCE_MS))
        self.controller = MapRequests(self.state, jobs, self, self._latest, self.why.looks(), patience)
        self.orbits = OrbitRequests(self.state, jobs, self._show_orbits, self._locked)
        self.twin = TwinRequests(self.state, jobs, self.desk.say, self._locked)
        self.separation = SeparationRequests(self.state, jobs, self.separation_pane.show, self.desk.say, self._locked)
        self.indicators = IndicatorsRequests(self.state, jobs, self.desk.show_indicators, self.desk.say, self._locked)
        self.progress = ProgressView(self._locked(self.controller.stop_map), self._locked(self.controller.request_map))
        self.sweep = EnergyAnimation(document, lambda: self.controller.previews.under_way, self._pass_by, self._end_sweep)
        self._known: tuple[ChosenOrbit, ...] = ()
        self._asked_at: float | None = None
        self._connect()
        pn.state.on_session_destroyed(self.close)
        pn.state.onload(self._begin)

    def _make_views(self) -> None:
        state, locked = self.state, self._locked
        self.navigation = Navigation(state)
        self.maps = MapsView(self._add_start, self.navigation.visit, self._count_in)
        self.zoom_buttons = ZoomButtons(
            locked(self.navigation.back), locked(self.navigation.forward), locked(lambda: self.navigation.visit(None))
        )
        self.desk: OrbitControls = OrbitControls(
            OrbitActions(
                add=locked(self._add_start),
                choose=lambda place: state.param.update(chosen=place),
                remove=locked(lambda: state.remove_start(state.chosen)),
                clear=locked(lambda: state.param.update(starts=(), chosen=0)),
                find_twin=locked(lambda: self.twin.search()),
                open_plane=locked(self._open_plane),
            )
        )
        self.panes = OrbitPlots()
        self.separation_pane: SeparationPlot = SeparationPlot()
        self.orbit_row = OrbitLayout(self.panes, self.separation_pane)
        self.time_bar = Playback(self.panes.set_time)
        self.numbers = StatisticsView(locked(lambda: self._count_in(None)))
        self.words = AccessibleTable(state)
        self.keyboard = Keyboard(locked(self._press), locked(lambda: self.tour.start()), locked(self._copied))
        self.take_along: Downloads = Downloads(state, self.keyboard.copy_link)
        self.gallery = Gallery(locked(self._show_preset))
        self.tour: Tour = Tour()
        actions = ControlActions(
            look=lambda energy: self.controller.request_preview(energy),
            settle=lambda: self.controller.request_map(),
            play=locked(self._play),
            choose_potential=locked(lambda: self.potential.open()),
        )
        self.controls = Controls(state, actions)

    def _connect(self) -> None:
        watch, state = self.state.param.watch, self.state
        watch(lambda *events: self.zoom_buttons.follow(self.navigation.history), ["window", *SYSTEM, "plane"])
        watch(lambda event: self.desk.follow_plane(event.new), "plane")
        watch(lambda event: self._show_orbits(self._known), "chosen")
        watch(lambda event: self._set_palette(), "palette")
        watch(lambda *events: self._count_in(None), [*SYSTEM, "plane", "window"])
        watch(lambda event: self._show_box(event.new), "box")
        watch(lambda *events: self._write_link(), list(LINKED))
        self.desk.follow_plane(state.plane)
        self._set_palette()
        self.zoom_buttons.follow(self.navigation.history)

    def close(self, *_: Any) -> None:
        """The session is over."""
        for requests in (self.controller, self.orbits, self.twin, self.separation, self.indicators, self.why, self.potential):
            requests.close()
        self._visitor.close()

    def set_dark(self, dark: bool) -> None:
        """Another theme."""
        self.maps.set_dark(dark)
        self.panes.outlines.set_dark(dark)
        self.orbit_row.set_dark(dark)
        self.why.set_dark(dark)

    def _begin(self) -> None:
        """The page is there: show what the link, or nobody, asked for."""
        self.controller.request_map()
        self.orbits.follow()
        if self._problems:
            self.progress.warn(" ".join(self._problems))

    def _write_link(self) -> None:
        if pn.state.location is not None:
            pn.state.location.search = write_link(self.state)

    def _set_palette(self) -> None:
        palette = self.state.colours
        with pn.io.hold():
            for view in (self.maps, self.panes, self.desk, self.numbers, self.separation_pane, self.why):
                view.set_palette(palette)
            self._show_orbits(self._known)

    # What visitors do.

    def _add_start(self, x: float, ordinate: float) -> None:
        self.state.add_start((x, ordinate))

    def _count_in(self, box: Window | None) -> None:
        self.state.box = box

    def _show_box(self, box: Window | None) -> None:
        self.maps.marks.show_box(box)
        self.numbers.show_box(box)

    def _open_plane(self) -> None:
        """From (x, h) to the (x, px) plane of the chosen orbit's energy, with that orbit."""
        start = self.state.chosen_start
        if start is not None and self.state.plane is Plane.X_H:
            self.state.param.update(plane=Plane.X_PX, energy=start[1], window=None, starts=((start[0], 0.0),), chosen=0)

    def _show_preset(self, preset: Preset) -> None:
        self.sweep.stop()
        self.state.param.update(chosen=0, **(asdict(System(preset.case)) | preset.values()))
        self.navigation.visit(preset.window)

    def _copied(self, success: bool) -> None:
        said = "The link is in the clipboard." if success else "The browser refused: copy the page's address instead."
        pn.state.notifications.info(said, duration=4000)

    def _press(self, key: str) -> None:
        """A key of `KEYS`."""
        moves = {**self.navigation.moves(), "p": self._play, "Escape": self._escape, "?": self.tour.start}
        try:
            moves[key]()
        except ValueError as error:
            self.progress.warn(str(error))

    def _escape(self) -> None:
        """What moves stops first: the map where a sweep ends is wanted."""
        if self.sweep.playing:
            self.sweep.stop()
        else:
            self.controller.stop_map()

    def _play(self) -> None:
        if self.sweep.playing:
            self.sweep.stop()
        elif self.state.plane is not Plane.X_H:
            energies = self.state.system.energies
            self.sweep.start(self.state.energy, energies.low, energies.high)
            self.controls.show_playing(True)

    def _pass_by(self, energy: float) -> None:
        self.controls.show_passing(energy)
        self.controller.request_preview(energy)

    def _end_sweep(self, energy: float) -> None:
        self.controls.show_playing(False)
        self.state.energy = round(energy, self.state.system.energies.decimals)

    # What the engine answers.

    def map_requested(self, *, compiling: bool = False) -> None:
        """Show that work has begun."""
        self._asked_at = time.monotonic()
        self.progress.start(compiling=compiling)

    def preview_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a quick look."""
        with pn.io.hold():
            self.why.begin(frame.spec)
            self.maps.show(frame, columns, quickly=True)
            self.progress.look()

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame."""
        if self._asked_at is not None:
            observe_first_frame(time.monotonic() - self._asked_at)
            self._asked_at = None
        with pn.io.hold():
            self.why.begin(frame.spec)
            self.maps.show(frame, columns)
            if self.state.window is None:
                self.maps.set_home(frame.spec.window)
            self.progress.show(frame)
            if frame.stride == 1:
                self.numbers.show(frame)
            self.take_along.show_map(frame)
            if frame.complete:
                self.words.show_map(frame)

    def map_stopped(self) -> None:
        """Show that the map has been cancelled."""
        self.progress.stop()

    def map_failed(self, sentence: str) -> None:
        """Say why there is no map; the last picture stays."""
        self.progress.fail(sentence)

    def _show_orbits(self, orbits: Sequence[ChosenOrbit]) -> None:
        """Draw what is known of the chosen orbits."""
        self._known, chosen = tuple(orbits), self.state.chosen
        if chosen >= len(orbits) and orbits:
            return
        there = [one.drawing for one in orbits]
        with pn.io.hold():
            self.maps.marks.show_starts([one.start for one in orbits])
            on_section = self.state.plane is Plane.X_PX
            self.maps.marks.show_sections([one.section if one is not None and on_section else NO_POINTS for one in there])
            self.desk.show(orbits, chosen)
            self.panes.show(self.state.potential, there, chosen)
            looked_at = there[chosen] if orbits else None
            self.time_bar.follow(float(looked_at.orbit.t[-1]) if looked_at is not None else None)
            # Those on their way, too: panes that went and came at each energy would cost four times what the orbits do.
            self.orbit_row.follow(sum(not one.problem for one in orbits))
            self.separation.follow(orbits)
            self.indicators.follow(orbits)
            self.take_along.show_orbits(orbits)
            self.words.show_orbits(orbits)


def _parameters() -> dict[str, str]:
    """The parameters in the page's address."""
    return {name: texts[0].decode(errors="replace") for name, texts in dict(pn.state.session_args or {}).items()}
