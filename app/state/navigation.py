"""Moves and zooms of the window by keys and double clicks."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from engine import Window

PAN_SHARE = 0.25
"""Distance by which an arrow key moves the window, as a share of its side."""

ZOOM_FACTOR = 2.0
"""Factor by which a zoom key enlarges or shrinks the sides of the window."""

DIVE_FACTOR = 4.0
"""Factor by which a double click shrinks the sides of the window."""

DIRECTIONS = {"ArrowLeft": (-1, 0), "ArrowRight": (1, 0), "ArrowDown": (0, -1), "ArrowUp": (0, 1)}
"""Direction of each arrow key in x and in the ordinate."""


def pan(window: Window, key: str) -> Window:
    """Return a window moved by an arrow key."""
    x_direction, ordinate_direction = DIRECTIONS[key]
    dx = PAN_SHARE * x_direction * window.width
    dy = PAN_SHARE * ordinate_direction * window.height
    return Window(window.x_low + dx, window.x_high + dx, window.ordinate_low + dy, window.ordinate_high + dy)


def zoom(window: Window, factor: float, about: tuple[float, float] | None = None) -> Window:
    """Return a window shrunk by `factor`; ValueError if its edges become equal in double precision.

    Parameters
    ----------
    window
        The window.
    factor
        Old length of a side over its new length.
    about
        x and ordinate of the point that does not move; None for the centre.
    """
    x, ordinate = about or (0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high))
    return Window(
        x - (x - window.x_low) / factor,
        x + (window.x_high - x) / factor,
        ordinate - (ordinate - window.ordinate_low) / factor,
        ordinate + (window.ordinate_high - ordinate) / factor,
    )


def window_moves(
    show_window: Callable[[Window | None], None], find_window: Callable[[], Window]
) -> dict[str, Callable[[], None]]:
    """Return the actions of the keys that move the window.

    Parameters
    ----------
    show_window
        Shows another window; None is the whole interior.
    find_window
        Returns the window in view.
    """

    def show(change: Callable[[Window], Window]) -> Callable[[], None]:
        return lambda: show_window(change(find_window()))

    return {
        "+": show(lambda window: zoom(window, ZOOM_FACTOR)),
        "-": show(lambda window: zoom(window, 1.0 / ZOOM_FACTOR)),
        "h": lambda: show_window(None),
        **{arrow: show(partial(_pan_by, arrow)) for arrow in DIRECTIONS},
    }


def _pan_by(arrow: str, window: Window) -> Window:
    return pan(window, arrow)
