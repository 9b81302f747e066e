"""Moves and zooms of the window by keys and double clicks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from types import MappingProxyType
from typing import NamedTuple

from engine import Window

PAN_SHARE = 0.25
"""Distance by which an arrow key moves the window, as a share of the window's side."""

ZOOM_FACTOR = 2.0
"""Factor by which a zoom key enlarges or shrinks the sides of the window."""

DIVE_FACTOR = 4.0
"""Factor by which a double click shrinks the sides of the window."""


class Move(NamedTuple):
    """A change of the window by a key: its words, and a function of the window in view, or None for the whole interior."""

    words: str
    change: Callable[[Window], Window] | None


def pan(x_direction: int, ordinate_direction: int, window: Window) -> Window:
    """Return a window moved by `PAN_SHARE` in two directions, each -1, 0 or 1."""
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


WINDOW_MOVES: Mapping[str, Move] = MappingProxyType(
    {
        "ArrowLeft": Move("move left", partial(pan, -1, 0)),
        "ArrowRight": Move("move right", partial(pan, 1, 0)),
        "ArrowUp": Move("move up", partial(pan, 0, 1)),
        "ArrowDown": Move("move down", partial(pan, 0, -1)),
        "+": Move("zoom in", lambda window: zoom(window, ZOOM_FACTOR)),
        "-": Move("zoom out", lambda window: zoom(window, 1.0 / ZOOM_FACTOR)),
        "h": Move("whole plane", None),
    }
)
"""The moves of the keys, by the key's name in `KeyboardEvent.key`."""
