"""One time for all panes of the orbits: dragged, or played."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn
import panel_material_ui as pmui

STEPS = 600
FRAME_MS = 50


class Playback:
    """A player over the life of the chosen orbit; `on_time(t)` is told where it stands, None when there is no orbit."""

    def __init__(self, on_time: Callable[[float | None], None]) -> None:
        self._on_time = on_time
        self._duration = 0.0
        self.player = pmui.Player(
            label="Time along the orbits", start=0, end=STEPS, value=0, step=1, interval=FRAME_MS, loop_policy="loop",
            show_loop_controls=False, show_value=False, disabled=True, size="small", width=300,
        )  # fmt: skip
        self.text = pn.pane.HTML("", name="time", width=110, margin=(24, 0))
        self.player.param.watch(lambda event: self._tell(), "value")

    def layout(self) -> pn.viewable.Viewable:
        """The player, and the time that it shows."""
        return pn.Row(self.player, self.text, margin=0)

    def follow(self, duration: float | None) -> None:
        """Another orbit is looked at, of this duration; None for none."""
        self.player.disabled = not duration
        if duration == self._duration:
            return
        self._duration = duration or 0.0
        # Zero is the start, where the cross is; the point appears with the first move.
        self.player.param.update(value=0, disabled=not duration)
        self._tell()

    def _tell(self) -> None:
        t = self._duration * self.player.value / STEPS
        moving = self._duration > 0.0 and self.player.value > 0
        self.text.object = f"t = {t:.5g}" if moving else ""
        self._on_time(t if moving else None)
