"""One time for all orbit plots, dragged or played."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn

from app.views.components.widgets import NamedPlayer

STEPS = 600
FRAME_MS = 50


class Playback:
    """A player over the duration of the chosen orbit, or over an interval of it.

    Parameters
    ----------
    on_time
        Called with the time that the player shows; None at the start, and without an orbit.
    """

    def __init__(self, on_time: Callable[[float | None], None]) -> None:
        self._on_time = on_time
        self._interval = 0.0, 0.0
        self.player = NamedPlayer(
            label="Time along the orbits", start=0, end=STEPS, value=0, interval=FRAME_MS, loop_policy="loop",
            show_loop_controls=False, visible_buttons=["previous", "play", "pause", "next"], disabled=True,
            width=280, height=40, margin=(8, 0),
        )  # fmt: skip
        self.text = pn.pane.HTML("", name="time", width=80, margin=(18, 0, 0, 8))
        self._row = pn.Row(self.player, self.text, margin=0, visible=False)
        self.player.param.watch(lambda event: self._report(), "value")

    def layout(self) -> pn.viewable.Viewable:
        """The player and its time."""
        return self._row

    def follow(self, interval: tuple[float, float] | None) -> None:
        """Set the interval of time to play; None without an orbit."""
        begin, end = interval or (0.0, 0.0)
        self.player.disabled = end == begin
        self._row.visible = interval is not None
        if end == begin:
            self.player.direction = 0
        if (begin, end) == self._interval:
            return
        self._interval = begin, end
        # At the beginning the start is marked by its cross; the moving point appears after that.
        self.player.value = 0
        self._report()

    def _report(self) -> None:
        (begin, end), step = self._interval, self.player.value
        t = begin + (end - begin) * step / STEPS
        self.text.object = f"t = {t:.5g}" if step else ""
        self._on_time(t if step else None)
