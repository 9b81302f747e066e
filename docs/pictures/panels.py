"""Style and parts of the drawings of the documents."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, Orbit, Window
from plots.printed.figure_axes import new_figure
from plots.printed.figure_style import FigureStyle

STYLE = FigureStyle(width=24.0, dpi=100.0, font_size=12.0, titles=False)
"""Letters of a document, where a figure is as wide as the text."""

SIDE = 250
"""Pixels of a map."""

CASE, ENERGY = CASES["I"], 0.19
"""The view with which the page opens."""


def new_panels(count: int, height: float, *, width: float = STYLE.width, sharey: bool = False) -> tuple[Figure, list[Axes]]:
    """A figure, `width` × `height` cm, with panels side by side."""
    figure = new_figure(replace(STYLE, width=width), height, "")
    return figure, list(figure.subplots(1, count, squeeze=False, sharey=sharey)[0])


def mark_section(axes: Axes, orbit: Orbit, window: Window, colour: str) -> None:
    """Mark the upward crossings of y = 0."""
    axes.scatter(*window_shares(orbit.find_section_crossings(), window), s=2.0, color=colour, linewidths=0.0)


def window_shares(points: np.ndarray, window: Window) -> np.ndarray:
    """(2, n) of (n, 2) points, in shares of a window."""
    low = [window.x_low, window.ordinate_low]
    shares: np.ndarray = (points - low) / ([window.x_high - window.x_low, window.ordinate_high - window.ordinate_low])
    return shares.T
