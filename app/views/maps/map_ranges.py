"""The ranges of the maps: they follow the displayed map and two fingers, and report the window to which the user moves them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from bokeh.document import Document
from bokeh.events import Pinch, PinchStart
from bokeh.models import CustomJS, Range1d
from bokeh.plotting import figure

from app.browser.javascript import callback_code
from engine import MapSpec, Window
from engine.maps.spec import finest_pixel

GESTURE_PAUSE_MS = 500
"""Drags and steps of the wheel that follow each other within this time make one entry of the browser's history."""

REST_MS = 90
"""A window is computed when the ranges have not changed for this time, which is longer than the time between two wheel steps."""

_FOLLOW = callback_code(Path(__file__).with_name("two_fingers.js"), "followFingers(cb_obj, ranges, held)")

Edges = tuple[float, float, float, float]
"""Ends of the ranges of x and of the ordinate: low, high, low, high."""


class MapRanges:
    """The ranges of x and of the ordinate, which all maps share.

    Parameters
    ----------
    on_zoom
        Called with the window when the ranges have stopped changing; None is the whole interior. It must call `finish_report`, at
        once or later; until then the ranges follow no other window, because the user may have moved them again.
    on_rest
        Called `GESTURE_PAUSE_MS` after the end of the last drag or step of the wheel.
    """

    def __init__(self, on_zoom: Callable[[Window | None], None], on_rest: Callable[[], None]) -> None:
        self.x, self.ordinate = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._on_zoom = on_zoom
        self._shown: Window | None = None
        self._home: Window | None = None
        self._rest, self._gesture = _Pause(REST_MS, self._rested), _Pause(GESTURE_PAUSE_MS, on_rest)
        self._following, self._reports = False, 0
        for edges in (self.x, self.ordinate):
            edges.on_change("start", self._moved)
            edges.on_change("end", self._moved)

    def follow(self, window: Window) -> None:
        """Go to the window of a new map, unless the ranges are being moved."""
        self._shown = window
        if self._rest.waits or self._reports:
            return
        # A range that is written while the user moves it in the browser would undo the move, so rounding differences are not
        # written.
        if is_near(self._edges, window):
            return
        self._following = True
        self.x.update(start=window.x_low, end=window.x_high)
        self.ordinate.update(start=window.ordinate_low, end=window.ordinate_high)
        self._following = False

    def go_to(self, window: Window) -> None:
        """Go to a window that does not come from a move; a move that is not reported yet is dropped."""
        if not self._reports:
            self._rest.cancel()
        self.follow(window)

    def finish_report(self) -> None:
        """End a report: its window is shown, or refused."""
        self._reports -= 1
        if self._shown is not None:
            self.follow(self._shown)

    def set_home(self, home: MapSpec) -> None:
        """Set the map of the whole interior, and with it the smallest window, at which zooming ends."""
        self._home = home.find_window()
        pixels = zip(finest_pixel(home, self._home), home.resolution, strict=True)
        # Twice the least distance of pixels, because the edges are rounded as well.
        self.x.min_interval, self.ordinate.min_interval = (2.0 * finest * count for finest, count in pixels)

    @property
    def magnification(self) -> float:
        """Width of the whole interior in units of the width of the window shown."""
        if self._home is None or self._shown is None:
            return 1.0
        return (self._home.x_high - self._home.x_low) / (self._shown.x_high - self._shown.x_low)

    def end_gesture(self) -> None:
        """Handle the end of a drag, or a step of the wheel; another step may follow."""
        self._rested()
        document = self.x.document
        if document is not None and not self._gesture.waits:
            self._gesture.start(document)

    def _moved(self, _name: str, _old: float, _new: float) -> None:
        """The ranges change: wait until they stop."""
        document = self.x.document
        if not self._following and document is not None:
            self._gesture.cancel()
            self._rest.start(document)

    def _rested(self) -> None:
        """The ranges have stopped: report the window."""
        self._rest.cancel()
        x_low, x_high, low, high = edges = self._edges
        # The server and the browser may change a range at the same time.
        if not (x_low < x_high and low < high) or self._shown is None or is_near(edges, self._shown):
            return
        self._reports += 1
        self._on_zoom(None if self._home is not None and is_near(edges, self._home) else Window(*edges))

    @property
    def _edges(self) -> Edges:
        return self.x.start, self.x.end, self.ordinate.start, self.ordinate.end


class _Pause:
    """Calls a function when some time has passed since the last start.

    Bokeh runs a timeout callback that is due even if it is removed while it waits for the lock of the document. Such a callback
    is no longer the latest one, and does nothing.
    """

    def __init__(self, length_ms: int, on_end: Callable[[], None]) -> None:
        self._length_ms, self._on_end = length_ms, on_end
        self._cancel: Callable[[], None] | None = None
        self._starts = 0

    @property
    def waits(self) -> bool:
        return self._cancel is not None

    def start(self, document: Document) -> None:
        self.cancel()
        self._starts += 1
        timer: Any = document.add_timeout_callback(partial(self._end, self._starts), self._length_ms)
        self._cancel = partial(document.remove_timeout_callback, timer)

    def cancel(self) -> None:
        cancel, self._cancel = self._cancel, None
        if cancel is not None:
            cancel()

    def _end(self, start: int) -> None:
        if self.waits and start == self._starts:
            # A callback that runs is already removed.
            self._cancel = None
            self._on_end()


def is_near(edges: Edges, window: Window) -> bool:
    """Whether the ends of two ranges are those of a window up to rounding in the browser."""
    width, height = window.x_high - window.x_low, window.ordinate_high - window.ordinate_low
    apart = np.abs(np.subtract(edges, astuple(window)))
    return bool(np.all(apart <= 1e-6 * np.array([width, width, height, height])))


class TwoFingers:
    """Changes two ranges so that the point between the fingers stays between them, at the scale of their distance.

    Bokeh's `WheelZoomTool` zooms in steps and does not move the picture.
    """

    def __init__(self, x: Range1d, y: Range1d) -> None:
        self._follow = CustomJS(args={"ranges": [x, y], "held": []}, code=_FOLLOW)

    def follow_on(self, plot: figure) -> None:
        """Let a picture with these ranges follow the fingers."""
        for event in (PinchStart, Pinch):
            plot.js_on_event(event, self._follow)
