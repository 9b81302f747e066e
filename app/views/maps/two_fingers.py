"""Moves and zooms of the maps by two fingers."""

from __future__ import annotations

from pathlib import Path

from bokeh.events import Pinch, PinchStart
from bokeh.models import CustomJS, Range1d
from bokeh.plotting import figure

from plots.browser.javascript import callback_code

_FOLLOW_CODE = callback_code(Path(__file__).with_name("two_fingers.js"), "followFingers(cb_obj, ranges, held)")


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
