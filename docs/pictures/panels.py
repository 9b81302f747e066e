"""Define style and parts of the drawings of the documents."""

from __future__ import annotations

from dataclasses import replace

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, Orbit, Result
from plots.printed.figure_axes import new_figure, style_axes
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


def show(axes: Axes, result: Result, title: str = "") -> None:
    """Draw a result with its legend in the style of the drawings."""
    with rc_context({"font.size": STYLE.font_size}):
        result.plot(axes, legend=True)
    style_axes(axes, labels=(axes.get_xlabel(), axes.get_ylabel()), title=title)


def mark_section(axes: Axes, orbit: Orbit, colour: str) -> None:
    """Mark the upward crossings of y = 0 of an orbit, in axes of (x, px)."""
    axes.scatter(*orbit.find_section_crossings().T, s=2.0, color=colour, linewidths=0.0)
