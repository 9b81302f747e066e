"""Two fingers on a picture move and zoom it; Bokeh's `WheelZoomTool` zooms in steps and does not move it."""

from __future__ import annotations

from bokeh.events import Pinch, PinchStart
from bokeh.models import CustomJS, Range1d
from bokeh.plotting import figure

from app.browser.callbacks import callback_code

_FOLLOW = callback_code("two_fingers.js", "followFingers(cb_obj, ranges, held)")


class TwoFingers:
    """Changes two ranges so that the point between the fingers stays between them, at the scale of their distance."""

    def __init__(self, x: Range1d, y: Range1d) -> None:
        self._follow = CustomJS(args={"ranges": [x, y], "held": []}, code=_FOLLOW)

    def follow_on(self, plot: figure) -> None:
        """Let a picture with these ranges follow the fingers."""
        for event in (PinchStart, Pinch):
            plot.js_on_event(event, self._follow)
