"""The list of orbits, and the player of the time along the orbits."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import param

from app.browser.components.plain_component import PlainComponent
from plots.browser.javascript import component_code


class OrbitList(PlainComponent):
    """Radio buttons in a line, in the colours of the orbits. The CSS variables --orbit-1, --orbit-2, … define these colours.

    Bokeh's radio buttons fail if the choice changes while their view is being built, for example when a click opens the tab.

    Parameters
    ----------
    on_choose
        Called with the index of the orbit that the visitor chooses. The call does not hold the session's lock.
    **options
        Parameters of the component.
    """

    label = param.String(default="Orbits", doc="name of the list for screen readers")
    rows = param.List(item_type=str, doc="text that describes each orbit, as a tooltip and for screen readers")
    chosen = param.Integer(default=0, bounds=(0, None), doc="index of the chosen orbit")

    _esm = Path(__file__).with_name("orbit_list.js")

    def __init__(self, on_choose: Callable[[int], None], **options: Any) -> None:
        super().__init__(margin=0, css_classes=["orbit-list"], **options)
        self._on_choose = on_choose

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages are ignored.
        match message:
            case {"chosen": int(index)} if not isinstance(index, bool) and 0 <= index < len(self.rows):
                self._on_choose(index)


class OrbitPlayer(PlainComponent):
    """A button to play and pause, and a slider. Both change the time in steps, and the browser sends each step.

    Parameters
    ----------
    on_time
        Called with each time that the player shows; None at the start, and without an interval. The call does not hold the
        session's lock.
    **options
        Parameters of the component.
    """

    label = param.String(default="Time along the orbits", doc="name of the slider for screen readers")
    steps = param.Integer(default=600, doc="number of steps of the interval")
    pause = param.Integer(default=50, doc="time between two steps, in ms")
    begin = param.Number(default=0.0, doc="start of the interval of time")
    end = param.Number(default=0.0, doc="end of the interval of time; an empty interval disables the player")

    _esm = component_code(Path(__file__).with_name("orbit_player.js"))

    def __init__(self, on_time: Callable[[float | None], None], **options: Any) -> None:
        super().__init__(**options)
        self._on_time = on_time

    def follow(self, interval: tuple[float, float] | None) -> None:
        """Set the interval of time to play; None without an orbit."""
        begin, end = interval or (0.0, 0.0)
        if (begin, end) != (self.begin, self.end):
            self.param.update(begin=begin, end=end)
            # At the beginning, a cross marks the start. The moving point appears later.
            self._on_time(None)

    def _handle_msg(self, message: Any) -> None:
        # A browser can send anything: unexpected messages, and steps of an earlier interval, are ignored.
        match message:
            case {"step": int(step), "begin": self.begin, "end": self.end} if 0 <= step <= self.steps and self.begin < self.end:
                self._on_time(self.begin + (self.end - self.begin) * step / self.steps if step else None)
