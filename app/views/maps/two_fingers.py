"""Two fingers on a picture move and zoom it; Bokeh's `WheelZoomTool` zooms in steps and does not move it."""

from __future__ import annotations

from bokeh.events import Pinch, PinchStart
from bokeh.models import CustomJS, Range1d
from bokeh.plotting import figure

# `held` keeps, for each axis, the point of the plane between the fingers and the side of the window when they began.
_FOLLOW = """
const middle = [cb_obj.x, cb_obj.y]
ranges.forEach((range, axis) => {
  const {start, end} = range
  if (cb_obj.event_name === "pinchstart") {
    held[axis] = {point: middle[axis], side: end - start}
    return
  }
  const side = held[axis].side / cb_obj.scale
  const low = held[axis].point - side * (middle[axis] - start) / (end - start)
  range.setv({start: low, end: low + side})
})
"""


class TwoFingers:
    """Changes two ranges so that the point between the fingers stays between them, at the scale of their distance."""

    def __init__(self, x: Range1d, y: Range1d) -> None:
        self._follow = CustomJS(args={"ranges": [x, y], "held": []}, code=_FOLLOW)

    def follow_on(self, plot: figure) -> None:
        """Let a picture with these ranges follow the fingers."""
        for event in (PinchStart, Pinch):
            plot.js_on_event(event, self._follow)
