"""Pan and zoom of the window, with history."""

from __future__ import annotations

from collections.abc import Callable

from app.state.system import SYSTEM
from app.state.view_state import ViewState
from app.state.zoom_history import ZoomHistory
from engine import Window

PAN_SHARE = 0.25
"""Share of the side of the window by which an arrow key moves it."""

ZOOM_FACTOR = 2.0
"""Factor of a zoom key."""

DIRECTIONS = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowDown": (0, -1), "ArrowUp": (0, 1)}
"""Direction of each arrow key in x and in the ordinate."""


def pan(window: Window, key: str) -> Window:
    """Move a window by an arrow key."""
    across, up = DIRECTIONS[key]
    dx = PAN_SHARE * across * (window.x_high - window.x_low)
    dy = PAN_SHARE * up * (window.ordinate_high - window.ordinate_low)
    return Window(window.x_low + dx, window.x_high + dx, window.ordinate_low + dy, window.ordinate_high + dy)


def zoom(window: Window, factor: float) -> Window:
    """Shrink a window about its centre by `factor`; ValueError if its edges become equal in double precision."""
    x, ordinate = 0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high)
    half_x = 0.5 * (window.x_high - window.x_low) / factor
    half = 0.5 * (window.ordinate_high - window.ordinate_low) / factor
    return Window(x - half_x, x + half_x, ordinate - half, ordinate + half)


class Navigation:
    """Moves the window of a view state and keeps its history."""

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self.history = ZoomHistory()
        if state.window is not None:
            self.history.visit(state.window)
        state.param.watch(lambda *events: self.history.clear(), [*SYSTEM, "plane"])

    def visit(self, window: Window | None) -> None:
        """Show a window; None is the whole interior."""
        self.history.visit(window)
        self._state.window = window

    def back(self) -> None:
        """Show the previous window."""
        self._state.window = self.history.back()

    def forward(self) -> None:
        """Show the next window of the history."""
        self._state.window = self.history.forward()

    def moves(self) -> dict[str, Callable[[], None]]:
        """Actions of the keys that move the window; they raise ValueError at the limit of double precision."""
        return {
            "+": lambda: self.visit(zoom(self._window(), ZOOM_FACTOR)),
            "-": lambda: self.visit(zoom(self._window(), 1.0 / ZOOM_FACTOR)),
            "h": lambda: self.visit(None),
            "b": self.back,
            "f": self.forward,
            **{arrow: self._pan(arrow) for arrow in DIRECTIONS},
        }

    def _pan(self, arrow: str) -> Callable[[], None]:
        return lambda: self.visit(pan(self._window(), arrow))

    def _window(self) -> Window:
        return self._state.map_spec().window
