"""Energy and window of the page, which the browser and the server both change, and the ranges of the maps."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any

import numpy as np
import panel as pn
import param
from bokeh.models import Range1d

from app.browser.components.plain_component import PlainComponent
from app.job_clients.latest_request import Locked
from app.state.view_state import ViewState
from engine import MapSpec, Window
from engine.maps.spec import finest_pixel
from plots.browser.browser_system import WINDOW_EDGES, window_in_browser


class ViewStore(PlainComponent):
    """A component whose values all parts of the page in the browser share, see modules/view_store.js. `BrowserEngine` extends it.

    Both values are counted as those of `CountedInput`. The server also counts each window that is chosen elsewhere than in the
    pictures. Of simultaneous moves, the server's counts: the browser drops moves that it has not sent, and the server ignores
    windows with a number that is not larger than its own.

    The ranges are those of all maps. Only the browser moves them.

    Parameters
    ----------
    state
        View state, whose energy the store follows, and which receives the energies that the visitor chooses.
    locked
        Wraps a function to run under the session's lock.
    on_zoom
        Shows the window to which the visitor has moved the pictures; None is the whole interior.
    on_rest
        Handles the end of a gesture, some time after the last drag or step of the wheel.
    """

    energy = param.Dict(default={}, doc="see `CountedInput.shown`")
    window = param.Dict(default={"value": None, "count": 0}, doc="likewise; the value is None while the server does not know it")

    def __init__(
        self, state: ViewState, locked: Locked, on_zoom: Callable[[Window | None], None], on_rest: Callable[[], None]
    ) -> None:
        super().__init__(width=0, height=0, margin=0, styles={"position": "absolute"}, css_classes=["engine"])
        self.energy = {"value": state.energy, "count": 0}
        self.x, self.ordinate = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._state, self._on_zoom = state, on_zoom
        self._shown_window: Window | None = None
        self._home_window: Window | None = None
        self._take_window, self._end_gesture = locked(self._zoom), locked(on_rest)
        state.param.watch(lambda event: self.param.update(energy=self.energy | {"value": event.new}), "energy")

    def follow(self, window: Window) -> None:
        """Show the window of a map, unless the user is moving the pictures."""
        self._show(window, self.window["count"])

    def go_to(self, window: Window) -> None:
        """Show a window that was chosen elsewhere, and drop a move that the browser has not sent yet.

        A window that is shown already, apart from rounding, changes nothing.
        """
        self._show(window, self.window["count"] + 1)

    def leave_window(self) -> None:
        """Leave the window to the browser until the map of another view arrives, and drop a move that is not sent yet."""
        self._shown_window = self._home_window = None
        self.window = {"value": None, "count": self.window["count"] + 1}

    def _show(self, window: Window, count: int) -> None:
        # Rounding differences alone show nothing.
        if self._shown_window is None or not _is_near(window, self._shown_window):
            self._shown_window = window
            self.window = {"value": window_in_browser(window), "count": count}

    def set_home(self, home: MapSpec) -> None:
        """Set the map of the whole interior, which also determines the smallest window."""
        self._home_window = home.find_window()
        pixels = zip(finest_pixel(home, self._home_window), home.resolution, strict=True)
        # Pixels of twice the smallest size, because the edges are rounded too.
        self.x.min_interval, self.ordinate.min_interval = (2.0 * finest * number for finest, number in pixels)

    @property
    def magnification(self) -> float:
        """Width of the whole interior over the width of the window; 1 without a map."""
        if self._home_window is None or self._shown_window is None:
            return 1.0
        return self._home_window.width / self._shown_window.width

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"name": "energy", "value": value, "count": int(count)}:
                # At once, because a later message may choose another system. `hold` provides the session's lock.
                with pn.io.hold():
                    self._take_energy(value, count)
            case {"name": "window", "value": value, "count": int(count)}:
                self._take_window(value, count)
            case {"gesture": "end"}:
                self._end_gesture()

    def _take_energy(self, value: Any, count: int) -> None:
        self.energy = self.energy | {"count": count}
        if isinstance(value, int | float) and isfinite(value) and self._state.plane.energy_axis is None:
            self._state.energy = float(value)

    def _zoom(self, value: Any, count: int) -> None:
        """Show the window to which the visitor has moved the pictures, unless another has been chosen since."""
        if count <= self.window["count"]:
            return
        window = _read_window(value)
        if window is None or (self._shown_window is not None and _is_near(window, self._shown_window)):
            self.window = self.window | {"count": count}
            return
        self._shown_window, self.window = window, {"value": window_in_browser(window), "count": count}
        self._on_zoom(None if self._home_window is not None and _is_near(window, self._home_window) else window)


def _read_window(value: Any) -> Window | None:
    """Return the window of a message; None for anything else."""
    try:
        return Window(*(float(value[name]) for name in WINDOW_EDGES))
    except (TypeError, ValueError, KeyError):
        return None


def _is_near(one: Window, other: Window) -> bool:
    """Whether two windows are equal except for rounding, which in the browser changes far less than 1e-6 of a side."""
    width, height = other.width, other.height
    distances = np.abs(np.subtract(one.edges, other.edges))
    return bool(np.all(distances <= 1e-6 * np.array([width, width, height, height])))
