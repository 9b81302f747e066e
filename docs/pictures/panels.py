"""Define style and parts of the drawings of the documents."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, Orbit, Window
from plots.printed.figure_axes import new_figure
from plots.printed.figure_style import FigureStyle

STYLE = FigureStyle(width=24.0, dpi=100.0, font_size=12.0, titles=False)
"""Style of figures that are as wide as the text of a document, with letters of the size of the text."""

SIDE = 250
"""Number of pixels along a side of a map."""

CASE, ENERGY = CASES["I"], 0.19
"""The view with which the page opens."""


def new_panels(count: int, height: float, *, width: float = STYLE.width, sharey: bool = False) -> tuple[Figure, list[Axes]]:
    """Return a figure, `width` × `height` cm, and its panels, which are side by side."""
    figure = new_figure(replace(STYLE, width=width), height, "")
    return figure, list(figure.subplots(1, count, squeeze=False, sharey=sharey)[0])


def mark_section(axes: Axes, orbit: Orbit, window: Window, colour: str) -> None:
    """Mark the upward crossings of y = 0 of an orbit, in axes that show a window of (x, px)."""
    axes.scatter(*window_shares(orbit.find_section_crossings(), window), s=2.0, color=colour, linewidths=0.0)


def window_shares(points: np.ndarray, window: Window) -> np.ndarray:
    """Convert points of shape (n, 2) to shares of a window, of shape (2, n)."""
    low = [window.x_low, window.ordinate_low]
    shares: np.ndarray = (points - low) / ([window.x_high - window.x_low, window.ordinate_high - window.ordinate_low])
    return shares.T
