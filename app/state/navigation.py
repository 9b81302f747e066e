"""Moves and zooms of the window by keys and double clicks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from engine import Window

PAN_SHARE = 0.25
"""Distance by which an arrow key moves the window, as a share of the window's side."""

ZOOM_FACTOR = 2.0
"""Factor by which a zoom key enlarges or shrinks the sides of the window."""

DOUBLE_CLICK_ZOOM_FACTOR = 4.0
"""Factor by which a double click shrinks the sides of the window."""


class Move(NamedTuple):
    """A change of the window by a key.

    Attributes
    ----------
    label
        What the key does.
    change
        Returns the new window for the window in view; None shows the whole plane.
    """

    label: str
    change: Callable[[Window], Window] | None


def pan(window: Window, x_direction: int, ordinate_direction: int) -> Window:
    """Return a window moved by `PAN_SHARE` in two directions, each -1, 0 or 1; ValueError if an edge is beyond ±1e9."""
    right = PAN_SHARE * x_direction * window.width
    up = PAN_SHARE * ordinate_direction * window.height
    return Window(window.x_low + right, window.x_high + right, window.ordinate_low + up, window.ordinate_high + up)


def zoom(window: Window, factor: float, about: tuple[float, float] | None = None) -> Window:
    """Return a window whose sides are divided by `factor`.

    Parameters
    ----------
    window
        The window.
    factor
        Old length of a side over its new length, above 0; a factor below 1 enlarges the window.
    about
        x and ordinate of the point that does not move; None for the centre.

    Raises
    ------
    ValueError
        If new edges are equal in double precision, or beyond ±1e9.
    """
    x, ordinate = about or (0.5 * (window.x_low + window.x_high), 0.5 * (window.ordinate_low + window.ordinate_high))
    return Window(
        x - (x - window.x_low) / factor,
        x + (window.x_high - x) / factor,
        ordinate - (ordinate - window.ordinate_low) / factor,
        ordinate + (window.ordinate_high - ordinate) / factor,
    )


WINDOW_MOVES: Mapping[str, Move] = MappingProxyType(
    {
        "ArrowLeft": Move("move left", lambda window: pan(window, -1, 0)),
        "ArrowRight": Move("move right", lambda window: pan(window, 1, 0)),
        "ArrowUp": Move("move up", lambda window: pan(window, 0, 1)),
        "ArrowDown": Move("move down", lambda window: pan(window, 0, -1)),
        "+": Move("zoom in", lambda window: zoom(window, ZOOM_FACTOR)),
        "-": Move("zoom out", lambda window: zoom(window, 1.0 / ZOOM_FACTOR)),
        "h": Move("show the whole plane", None),
    }
)
"""The moves of the keys, by the key's name in `KeyboardEvent.key`."""
