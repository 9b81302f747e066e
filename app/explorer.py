"""The page of one session: view state, controller and views, put together."""

from __future__ import annotations

from functools import cache, partial
from typing import Any

import panel as pn
import panel_material_ui as pmui
from panel.util import edit_readonly

from app.controller import Controller
from app.link import LINKED, read_link, write_link
from app.view_state import ViewState
from app.views.controls import Controls
from app.views.maps import MapsView
from app.views.orbit_panes import OrbitPanes
from app.views.progress import ProgressView
from app.views.verdict import VerdictView
from app.views.zoom_buttons import ZoomButtons
from app.zoom_history import ZoomHistory
from engine import EscapeMap, Jobs, Orbit, Potential, RegularityMap, Window


def _arguments() -> dict[str, list[bytes]]:
    """The parameters in the page's address."""
    return dict(pn.state.session_args or {})


@cache
def shared_jobs() -> Jobs:
    """The background work of this process, shared by all sessions."""
    return Jobs()


class Explorer:
    """The explorer of escapes; one for each visitor."""

    def __init__(self) -> None:
        document = pn.state.curdoc
        assert document is not None, "an Explorer belongs to a session: start it with 'panel serve app'"
        values, self._problems = read_link({name: texts[0].decode(errors="replace") for name, texts in _arguments().items()})
        self.state = ViewState(**values)
        self.maps = MapsView(self._choose_start, self._zoom)
        self.history = ZoomHistory()
        self.zoom_buttons = ZoomButtons(self.history, self._go_to)
        self.panes = OrbitPanes()
        self.verdict = VerdictView(self._choose_start)
        self.controls = Controls(self.state)
        locked = partial(document.locked_callback, policy="latest")
        # A button's click comes without the session's lock, which the marks, being bare Bokeh, need.
        self._mark_start = locked(self.maps.mark_start)
        self.controller = Controller(self.state, shared_jobs(), self, locked)
        self.progress = ProgressView(self.controller.stop_map, self.controller.request_map)
        self.state.param.watch(lambda *events: self.history.clear(), ["case", "plane"])
        self.state.param.watch(lambda *events: self.zoom_buttons.follow(self.state.window), ["window", "case", "plane"])
        self.state.param.watch(lambda event: self.verdict.follow_plane(event.new), "plane")
        self.state.param.watch(lambda event: self._mark_start(event.new), "start")
        self.state.param.watch(lambda event: self.maps.show_characters(event.new), "judge")
        self.state.param.watch(lambda *events: self._write_link(), list(LINKED))
        self.verdict.follow_plane(self.state.plane)
        self.maps.show_characters(self.state.judge)
        if self.state.window is not None:
            self.history.visit(self.state.window)
            self.zoom_buttons.follow(self.state.window)
        pn.state.on_session_destroyed(self.controller.close)
        pn.state.onload(self._begin)

    def layout(self) -> pn.viewable.Viewable:
        """The whole page."""
        orbit = pn.FlexBox(
            self.verdict.layout(), self.panes.path, self.panes.sali, self.panes.r2, justify_content="center", gap="4px"
        )
        main = pn.Column(
            self.controls.layout(),
            self.progress.layout(),
            self.zoom_buttons.layout(),
            self.maps.layout(),
            orbit,
            sizing_mode="stretch_width",
            margin=(0, 10),
        )
        page = pmui.Page(title="Escape Explorer", main=[main], theme_toggle=False, busy_indicator=None)
        # A page that shows how busy it is looks through all its models at the begin and end of every callback: 50 ms each.
        with edit_readonly(page):
            page.busy = False
        return page

    def _begin(self) -> None:
        """The page is there: show what the link, or nobody, asked for."""
        self.controller.request_map()
        if self.state.start is not None:
            self._mark_start(self.state.start)
            self.controller.request_orbit()
        if self._problems:
            self.progress.warn(" ".join(self._problems))

    def _write_link(self) -> None:
        if pn.state.location is not None:
            pn.state.location.search = write_link(self.state)

    def _choose_start(self, x: float, ordinate: float) -> None:
        self.state.start = (x, ordinate)

    def _zoom(self, window: Window | None) -> None:
        """The ranges have come to rest somewhere else."""
        self.history.visit(window)
        self._go_to(window)

    def _go_to(self, window: Window | None) -> None:
        self.state.window = window

    def map_requested(self) -> None:
        """Show that work has begun."""
        self.progress.start()

    def map_arrived(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame."""
        with pn.io.hold():
            self.maps.show(frame, columns)
            if self.state.window is None:
                self.maps.set_home(frame.spec.window)
            self.progress.show(frame)

    def regularity_arrived(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        """Paint what is judged."""
        with pn.io.hold():
            self.maps.show_regularity(frame, regularity)

    def map_stopped(self) -> None:
        """Show that the map has been cancelled."""
        self.progress.stop()

    def map_failed(self, sentence: str) -> None:
        """Say why there is no map; the last picture stays."""
        self.progress.fail(sentence)

    def orbit_requested(self, start: tuple[float, float]) -> None:
        """Show which orbit is on its way."""
        self.verdict.expect(start)

    def orbit_arrived(self, potential: Potential, orbit: Orbit) -> None:
        """Draw an orbit and its verdict."""
        with pn.io.hold():
            self.verdict.show(orbit)
            self.panes.show(potential, orbit)

    def orbit_refused(self, sentence: str) -> None:
        """Say why there is no orbit."""
        self.verdict.say(sentence)
