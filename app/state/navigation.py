"""Where to look next: windows moved and scaled, and the way back through those visited."""

from __future__ import annotations

from collections.abc import Callable

from app.state.system import SYSTEM
from app.state.view_state import ViewState
from app.state.zoom_history import ZoomHistory
from engine import Window

PAN_SHARE = 0.25
"""An arrow key moves the window by this share of its side."""

ZOOM_FACTOR = 2.0
"""A zoom key makes it smaller or larger by this factor."""

DIRECTIONS = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowDown": (0, -1), "ArrowUp": (0, 1)}
"""For each arrow key the way it goes, in x and in the ordinate."""


def panned(window: Window, key: str) -> Window:
    """The window to which an arrow key leads."""
    across, up = DIRECTIONS[key]
    dx = PAN_SHARE * across * (window.x_high - window.x_low)
    dy = PAN_SHARE * up * (window.ordinate_high - window.ordinate_low)
    return Window(window.x_low + dx, window.x_high + dx, window.ordinate_low + dy, window.ordinate_high + dy)


def zoomed(window: Window, factor: float) -> Window:
    """The window about the same centre, smaller by `factor`; ValueError where double precision ends."""
    x, ordinate = 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high)
    half_x = 0.5 * (window.x_high - window.x_low) / factor
    half = 0.5 * (window.ordinate_high - window.ordinate_low) / factor
    return Window(x - half_x, x + half_x, ordinate - half, ordinate + half)


class Navigation:
    """Moves the window of a view, and remembers where it was."""

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self.history = ZoomHistory()
        if state.window is not None:
            self.history.visit(state.window)
        state.param.watch(lambda *events: self.history.clear(), [*SYSTEM, "plane"])

    def visit(self, window: Window | None) -> None:
        """Look at a window; None is the whole plane."""
        self.history.visit(window)
        self._state.window = window

    def back(self) -> None:
        """Look where one looked before."""
        self._state.window = self.history.back()

    def forward(self) -> None:
        """Look where one came back from."""
        self._state.window = self.history.forward()

    def moves(self) -> dict[str, Callable[[], None]]:
        """What each key does that moves the window; ValueError where double precision ends."""
        return {
            "+": lambda: self.visit(zoomed(self._window(), ZOOM_FACTOR)),
            "-": lambda: self.visit(zoomed(self._window(), 1.0 / ZOOM_FACTOR)),
            "h": lambda: self.visit(None),
            "b": self.back,
            "f": self.forward,
            **{arrow: self._pan(arrow) for arrow in DIRECTIONS},
        }

    def _pan(self, arrow: str) -> Callable[[], None]:
        return lambda: self.visit(panned(self._window(), arrow))

    def _window(self) -> Window:
        return self._state.map_spec().window
