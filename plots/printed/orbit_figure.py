"""An orbit drawn with Matplotlib: its path between the exits, SALI and R² against time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import count, cycle

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CHAOS_THRESHOLD, Potential, Window
from engine.foundations.wording import format_number
from engine.slices.planes import SPACE
from plots.pictures.histories import ENVELOPE_ALPHA, History
from plots.pictures.orbit_curves import LEAST_SALI, OrbitCurves, find_well_window
from plots.pictures.palette import LIGHT, Palette
from plots.printed.figure_axes import (
    add_figure_legend,
    add_panel_legend,
    label_axes,
    name_panel,
    new_figure,
    style_axes,
    write_below,
)
from plots.printed.figure_style import SCREEN, FigureStyle
from plots.printed.map_figure import draw_curve, draw_limits, draw_pixels, show_window
from plots.printed.potential_figure import draw_well

_DrawHistory = Callable[[Axes, OrbitCurves, str, FigureStyle], None]

# Height of the figure with two columns and with one, in units of its width.
_HEIGHT, _HEIGHT_OF_COLUMN = 0.58, 1.9
_LARGEST_SALI, _EARLIEST_TIME = 10.0**0.5, 0.01


def draw_orbits_figure(
    potential: Potential, orbits: Sequence[OrbitCurves], palette: Palette, verdicts: Sequence[str], style: FigureStyle
) -> Figure:
    """Draw paths, SALI and R² of orbits in the colours of their places, and their verdicts below.

    Raises
    ------
    ValueError
        If there is no orbit.
    """
    if not orbits:
        raise ValueError(f"orbits={orbits!r}: must be at least one")
    one_column = style.columns(2) == 1
    title = f"{'Orbit' if len(orbits) == 1 else 'Orbits'} at h = {', '.join(_energies(orbits))}"
    figure = new_figure(style, style.width * (_HEIGHT_OF_COLUMN if one_column else _HEIGHT), title)
    if one_column:
        panels = figure.subplot_mosaic([["path"], ["sali"], ["r2"]], height_ratios=[2, 1, 1])
    else:
        panels = figure.subplot_mosaic([["path", "sali"], ["path", "r2"]])
    draw_path(panels["path"], potential, orbits, palette, style)
    for name, draw in (("sali", draw_sali), ("r2", draw_r2)):
        _draw_together(panels[name], draw, orbits, palette, style)
    if len(orbits) > 1:
        add_panel_legend(panels["sali"], "lower left", style)
    if style.titles:
        lines = [f"{number}: {verdict}" for number, verdict in enumerate(verdicts, 1)] if len(orbits) > 1 else verdicts
        write_below(figure, lines, style)
    return figure


def draw_well_figure(
    potential: Potential, energy: float, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle
) -> Figure:
    """Draw the well at an energy with its equipotentials and exits, and the paths of orbits in it."""
    window = find_well_window(potential, energy)
    figure = new_figure(style, style.width, f"The well at h = {energy:.6g}")
    axes = figure.subplots()
    draw_well(axes, potential, energy, window, palette)
    _draw_paths(axes, orbits, window, palette)
    show_window(axes, window, "x", "y", style, equal=True)
    curves = [curve for curve in axes.collections if not str(curve.get_label()).startswith("_")]
    add_figure_legend(figure, curves, style, columns=2)
    return figure


def _energies(orbits: Sequence[OrbitCurves]) -> list[str]:
    return list(dict.fromkeys(f"{curves.orbit.energy:.6g}" for curves in orbits))


def _draw_together(axes: Axes, draw: _DrawHistory, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle) -> None:
    """Draw a history of several orbits; each sets the limits of the axes for itself."""
    limits = []
    for curves, colour, number in zip(orbits, cycle(palette.orbits), count(1), strict=False):
        draw(axes, curves, colour, style)
        axes.plot([], [], color=colour, label=f"orbit {number}")
        limits.append((axes.get_xlim(), axes.get_ylim()))
    axes.set_xlim(min(x[0] for x, _ in limits), max(x[1] for x, _ in limits))
    axes.set_ylim(min(y[0] for _, y in limits), max(y[1] for _, y in limits))


def draw_path(
    axes: Axes, potential: Potential, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle = SCREEN
) -> None:
    """Paths as lines, or shaded by their density if they are long, with the exits at the highest of their energies."""
    widest = max(orbits, key=lambda curves: curves.orbit.energy)
    window = widest.window
    _draw_paths(axes, orbits, window, palette)
    draw_limits(axes, potential, SPACE, widest.orbit.energy, window, palette.channels)
    show_window(axes, window, "x", "y", style, equal=True)
    name_panel(axes, "Path", style)


def _draw_paths(axes: Axes, orbits: Sequence[OrbitCurves], window: Window, palette: Palette) -> None:
    for curves, colour in zip(orbits, cycle(palette.orbits), strict=False):
        if curves.visits is None:
            draw_curve(axes, [np.column_stack(curves.path)], window, colors=colour, linewidths=1.0)
        else:
            pixels = curves.shaded(colour)[::-1]
            draw_pixels(axes, pixels.view(np.uint8).reshape(*pixels.shape, 4), curves.window, window)


def draw_sali(axes: Axes, curves: OrbitCurves, colour: str, style: FigureStyle = SCREEN) -> None:
    """SALI against time, both on logarithmic scales, with the threshold of chaos."""
    _draw_history(axes, curves.sali, curves, colour, style)
    axes.set_yscale("log")
    axes.set_ylim(LEAST_SALI, _LARGEST_SALI)
    axes.axhline(CHAOS_THRESHOLD, color=LIGHT.equipotential, linewidth=1.0)
    label_axes(axes, "t", "SALI", style)
    name_panel(axes, f"SALI (chaotic at {format_number(CHAOS_THRESHOLD)} or less)", style)


def draw_r2(axes: Axes, curves: OrbitCurves, colour: str, style: FigureStyle = SCREEN) -> None:
    """R² against the logarithm of time."""
    _draw_history(axes, curves.r2, curves, colour, style)
    axes.set_ylim(0.0, 1.05 * max(float(curves.orbit.r2.max()), 1e-3))
    label_axes(axes, "t", "R²", style)
    name_panel(axes, "R² = x² + y²", style)


def _draw_history(axes: Axes, history: History, curves: OrbitCurves, colour: str, style: FigureStyle) -> None:
    """A history, with its envelope where it is a mean, against the logarithm of time."""
    t, low, high = history.band
    axes.fill_between(t, low, high, color=colour, alpha=ENVELOPE_ALPHA, linewidth=0.0)
    axes.semilogx(*history.line, color=colour, linewidth=1.0)
    axes.set_xlim(_EARLIEST_TIME, max(float(curves.orbit.t[-1]), 10.0 * _EARLIEST_TIME))
    style_axes(axes, style)
