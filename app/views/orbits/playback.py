"""The time that all pictures of orbits show. The user drags or plays this time."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn

from app.browser.components.orbit_player import OrbitPlayer


class Playback:
    """Plays the duration of the chosen orbit, or an interval of time.

    Parameters
    ----------
    on_time
        Shows the time of the player; None at the start, and without an orbit.
    """

    def __init__(self, on_time: Callable[[float | None], None]) -> None:
        self._on_time = on_time
        self.player = OrbitPlayer(self._report, sizing_mode="stretch_width", margin=(4, 10), css_classes=["player"])

    def layout(self) -> pn.viewable.Viewable:
        """Return the player."""
        return self.player

    def follow(self, interval: tuple[float, float] | None) -> None:
        """Set the interval of time to play; None without an orbit."""
        begin, end = interval or (0.0, 0.0)
        if (begin, end) != (self.player.begin, self.player.end):
            self.player.param.update(begin=begin, end=end)
            # At the beginning, no moving point is shown: a cross marks the start.
            self._on_time(None)

    def _report(self, step: int) -> None:
        player = self.player
        self._on_time(player.begin + (player.end - player.begin) * step / player.steps if step else None)
