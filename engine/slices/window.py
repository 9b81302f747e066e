"""A rectangle of a slice, and the centres of its pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.foundations.validation import checked_number, short_repr
from engine.integrator.kernels.slice_starts import interval_centre


@dataclass(frozen=True)
class Window:
    """A rectangle of a slice, including its edges.

    Parameters
    ----------
    x_low, x_high
        Edges along the abscissa, which may be another coordinate than x: from -1e9 to 1e9, dimensionless, ``x_low < x_high``.
    ordinate_low, ordinate_high
        The same along the ordinate.

    Raises
    ------
    ValueError
        If an edge is not finite or lies beyond ±1e9, or a lower edge is not below the upper edge.
    """

    x_low: float
    x_high: float
    ordinate_low: float
    ordinate_high: float

    def __post_init__(self) -> None:
        for name, (low, high) in zip(("x", "ordinate"), self.ranges, strict=True):
            low_edge, high_edge = (checked_number(f"window {name} edge", edge) for edge in (low, high))
            if not low_edge < high_edge:
                raise ValueError(f"window {name} range {low_edge} … {high_edge}: the lower edge must be below the upper edge")
            object.__setattr__(self, f"{name}_low", low_edge)
            object.__setattr__(self, f"{name}_high", high_edge)

    @property
    def edges(self) -> tuple[float, float, float, float]:
        """The four edges: x_low, x_high, ordinate_low, ordinate_high."""
        return self.x_low, self.x_high, self.ordinate_low, self.ordinate_high

    @property
    def ranges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The edges along each axis: (x_low, x_high) and (ordinate_low, ordinate_high)."""
        return (self.x_low, self.x_high), (self.ordinate_low, self.ordinate_high)

    @property
    def width(self) -> float:
        """The length along the abscissa."""
        return self.x_high - self.x_low

    @property
    def height(self) -> float:
        """The length along the ordinate."""
        return self.ordinate_high - self.ordinate_low

    def scaled(self, x_factor: float, ordinate_factor: float) -> Window:
        """Return the window with its edges multiplied by a positive factor along each axis."""
        x, ordinate = self.ranges
        return Window(*(x_factor * edge for edge in x), *(ordinate_factor * edge for edge in ordinate))

    def pixel_centres(self, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the pixel centres along the abscissa, of shape (columns,), and along the ordinate, of shape (rows,).

        The centres are exactly symmetric if the window is symmetric. There is at least one column and one row.
        """
        x = interval_centre(self.x_low, self.x_high, np.arange(columns), columns)
        return x, interval_centre(self.ordinate_low, self.ordinate_high, np.arange(rows), rows)


type GivenWindow = Window | tuple[float, float, float, float]
"""A window as functions accept it: a `Window`, or (x_low, x_high, ordinate_low, ordinate_high)."""


def checked_window(window: Any) -> Window:
    """Return a `GivenWindow` as a `Window`; ValueError for anything else, and for illegal edges."""
    if isinstance(window, Window):
        return window
    try:
        x_low, x_high, ordinate_low, ordinate_high = window
    except (TypeError, ValueError):
        raise ValueError(f"window={short_repr(window)}: must be (x_low, x_high, ordinate_low, ordinate_high)") from None
    return Window(x_low, x_high, ordinate_low, ordinate_high)
