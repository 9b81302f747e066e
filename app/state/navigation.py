"""Pan and zoom of the window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from app.state.view_state import ViewState
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


def window_moves(state: ViewState, find_window: Callable[[], Window]) -> dict[str, Callable[[], None]]:
    """Actions of the keys that move the window of a view state; they raise ValueError at the limit of double precision.

    `find_window` returns the window in view, which is not that of the state if that is None.
    """

    def show(change: Callable[[Window], Window | None]) -> Callable[[], None]:
        def act() -> None:
            state.window = change(find_window())

        return act

    return {
        "+": show(lambda window: zoom(window, ZOOM_FACTOR)),
        "-": show(lambda window: zoom(window, 1.0 / ZOOM_FACTOR)),
        "h": lambda: state.param.update(window=None),
        **{arrow: show(partial(_pan_by, arrow)) for arrow in DIRECTIONS},
    }


def _pan_by(arrow: str, window: Window) -> Window:
    return pan(window, arrow)
