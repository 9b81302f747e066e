"""The ranges of the maps. They follow the displayed map and two fingers, and report the window to which the user moves them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from functools import partial
from itertools import count
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
"""Longest pause between drags or steps of the wheel that share an entry of the browser's history, in milliseconds."""

REST_MS = 90
"""Time without change after which the ranges report their window, in milliseconds. Steps of the wheel are closer together."""

_FOLLOW_CODE = callback_code(Path(__file__).with_name("two_fingers.js"), "followFingers(cb_obj, ranges, held)")

Edges = tuple[float, float, float, float]
"""Ends of the ranges: x_low, x_high, ordinate_low, ordinate_high."""


class MapRanges:
    """The ranges of x and of the ordinate, which all maps share.

    The browser and the server both move the ranges. Of simultaneous moves, the server's counts: the browser answers each move
    of the server, and until the answer, moves of the browser start from an outdated window.

    Parameters
    ----------
    on_zoom
        Shows the window to which the ranges were moved; None is the whole interior. It must lead to a call of `finish_report`.
        Until that call, the ranges follow no other window, because the user may have moved the ranges again.
    on_rest
        Handles the end of a gesture, `GESTURE_PAUSE_MS` after the last drag or step of the wheel.
    """

    def __init__(self, on_zoom: Callable[[Window | None], None], on_rest: Callable[[], None]) -> None:
        self.x, self.ordinate = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._on_zoom = on_zoom
        self._window: Window | None = None
        self._home_window: Window | None = None
        self._rest_pause = _Pause(REST_MS, self._report)
        self._gesture_pause = _Pause(GESTURE_PAUSE_MS, on_rest)
        self._is_following = False
        self._move_numbers = count(1)
        # Number of reports whose window is neither shown nor refused yet.
        self._open_report_count = 0
        # The server numbers its moves in the tags of x. The browser answers by copying the tags to the ordinate.
        self.answer = CustomJS(args={"x": self.x, "ordinate": self.ordinate}, code="ordinate.tags = x.tags")
        self.x.js_on_change("tags", self.answer)
        self.ordinate.on_change("tags", self._note_answer)
        for axis_range in (self.x, self.ordinate):
            axis_range.on_change("start", self._note_move)
            axis_range.on_change("end", self._note_move)

    def follow(self, window: Window) -> None:
        """Go to the window of a new map, unless the user is moving the ranges."""
        self._window = window
        if self._rest_pause.is_waiting or self._open_report_count:
            return
        # Setting a range would undo a simultaneous move in the browser, so rounding differences alone set nothing.
        if _is_near(self._edges, window):
            return
        self._is_following = True
        self.x.update(start=window.x_low, end=window.x_high, tags=[next(self._move_numbers)])
        self.ordinate.update(start=window.ordinate_low, end=window.ordinate_high)
        self._is_following = False

    def go_to(self, window: Window) -> None:
        """Go to a window that was chosen elsewhere, and drop a move that is not reported yet."""
        if not self._open_report_count:
            self._rest_pause.cancel()
        self.follow(window)

    def finish_report(self) -> None:
        """End a report after its window is shown or refused, and go to the window of the map."""
        self._open_report_count -= 1
        if self._window is not None:
            self.follow(self._window)

    def set_home(self, home: MapSpec) -> None:
        """Set the map of the whole interior, which also determines the smallest window."""
        self._home_window = home.find_window()
        pixels = zip(finest_pixel(home, self._home_window), home.resolution, strict=True)
        # Pixels of twice the smallest size, because the edges are rounded too.
        self.x.min_interval, self.ordinate.min_interval = (2.0 * finest * number for finest, number in pixels)

    @property
    def magnification(self) -> float:
        """Width of the whole interior over the width of the window; 1 without a map."""
        if self._home_window is None or self._window is None:
            return 1.0
        return self._home_window.width / self._window.width

    def end_gesture(self) -> None:
        """Report the window after a drag or a step of the wheel, and wait for the end of the gesture."""
        self._report()
        document = self.x.document
        if document is not None and not self._gesture_pause.is_waiting:
            self._gesture_pause.start(document)

    def _note_move(self, _name: str, _old: float, _new: float) -> None:
        """Wait until the ranges stop changing."""
        document = self.x.document
        if not self._is_following and not self._awaits_answer and document is not None:
            self._gesture_pause.cancel()
            self._rest_pause.start(document)

    @property
    def _awaits_answer(self) -> bool:
        """Whether the browser has not answered the last move of the server. A page that is not open yet answers nothing."""
        answered = self.ordinate.tags
        return bool(answered) and answered != self.x.tags

    def _note_answer(self, _name: str, _old: list[int], _new: list[int]) -> None:
        """Undo moves of the browser from an outdated window."""
        if not self._awaits_answer and self._window is not None:
            self.follow(self._window)

    def _report(self) -> None:
        """Report the window to which the ranges were moved, if it is new."""
        self._rest_pause.cancel()
        if self._awaits_answer:
            return
        edges = self._edges
        x_low, x_high, ordinate_low, ordinate_high = edges
        # The server and the browser may change a range at the same time.
        if not (x_low < x_high and ordinate_low < ordinate_high) or self._window is None or _is_near(edges, self._window):
            return
        self._open_report_count += 1
        self._on_zoom(None if self._home_window is not None and _is_near(edges, self._home_window) else Window(*edges))

    @property
    def _edges(self) -> Edges:
        return self.x.start, self.x.end, self.ordinate.start, self.ordinate.end


class _Pause:
    """Calls a function some time after the last start.

    Bokeh runs a due callback even if the callback is removed while it waits for the lock of the document. Such a callback belongs
    to an earlier start, and does nothing.
    """

    def __init__(self, length_ms: int, on_end: Callable[[], None]) -> None:
        self._length_ms, self._on_end = length_ms, on_end
        self._cancel: Callable[[], None] | None = None
        self._start_count = 0

    @property
    def is_waiting(self) -> bool:
        return self._cancel is not None

    def start(self, document: Document) -> None:
        self.cancel()
        self._start_count += 1
        timer: Any = document.add_timeout_callback(partial(self._end, self._start_count), self._length_ms)
        self._cancel = partial(document.remove_timeout_callback, timer)

    def cancel(self) -> None:
        cancel, self._cancel = self._cancel, None
        if cancel is not None:
            cancel()

    def _end(self, start_number: int) -> None:
        if self.is_waiting and start_number == self._start_count:
            # Bokeh has removed the running callback.
            self._cancel = None
            self._on_end()


def _is_near(edges: Edges, window: Window) -> bool:
    """Whether the ends of the ranges are the edges of a window. Rounding in the browser changes far less than 1e-6 of a side."""
    width, height = window.width, window.height
    distances = np.abs(np.subtract(edges, astuple(window)))
    return bool(np.all(distances <= 1e-6 * np.array([width, width, height, height])))


class TwoFingers:
    """Changes two ranges in the browser: the point between two fingers stays between them, and the scale follows their distance.

    Bokeh's `WheelZoomTool` zooms in steps and does not move the picture.
    """

    def __init__(self, x: Range1d, y: Range1d) -> None:
        self._follow = CustomJS(args={"ranges": [x, y], "held": []}, code=_FOLLOW_CODE)

    def follow_on(self, plot: figure) -> None:
        """Make a picture with these ranges follow the fingers."""
        for event in (PinchStart, Pinch):
            plot.js_on_event(event, self._follow)
