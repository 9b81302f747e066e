"""An orbit drawn with Matplotlib: its path between the exits, SALI and R² against time."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from engine import CHAOS_THRESHOLD, Potential
from engine.service import SPACE, format_number
from plots.figure_axes import label_axes, name_panel, style_axes
from plots.map_figure import draw_curve, draw_limits, draw_pixels, show_window
from plots.orbit_curves import LEAST_SALI, OrbitCurves
from plots.palette import LIGHT, Palette

_LARGEST_SALI, _EARLIEST_TIME = 10.0**0.5, 0.01


def draw_path(axes: Axes, potential: Potential, curves: OrbitCurves, palette: Palette) -> None:
    """Path as a line, or shaded by its density if it is long, with the zero-velocity curve and the Lyapunov orbits."""
    orbit, window, colour = curves.orbit, curves.window, palette.orbits[0]
    if curves.visits is None:
        draw_curve(axes, [np.column_stack([orbit.x, orbit.y])], window, colors=colour, linewidths=1.0)
    else:
        pixels = curves.shaded(colour)[::-1]
        draw_pixels(axes, pixels.view(np.uint8).reshape(*pixels.shape, 4), window, window)
    draw_limits(axes, potential, SPACE, orbit.energy, window, palette.channels)
    show_window(axes, window, "x", "y", equal=True)
    name_panel(axes, "Path")


def draw_sali(axes: Axes, curves: OrbitCurves, colour: str) -> None:
    """SALI against time, both on logarithmic scales, with the threshold of chaos."""
    t, sali = curves.sali
    axes.loglog(np.maximum(t, _EARLIEST_TIME), sali, color=colour, linewidth=1.0)
    axes.axhline(CHAOS_THRESHOLD, color=LIGHT.equipotential, linewidth=1.0)
    axes.set_xlim(_EARLIEST_TIME, max(float(curves.orbit.t[-1]), 10.0 * _EARLIEST_TIME))
    axes.set_ylim(LEAST_SALI, _LARGEST_SALI)
    style_axes(axes)
    label_axes(axes, "t", "SALI")
    name_panel(axes, f"SALI (chaotic at {format_number(CHAOS_THRESHOLD)} or less)")


def draw_r2(axes: Axes, curves: OrbitCurves, colour: str) -> None:
    """R² against time."""
    axes.plot(*curves.r2, color=colour, linewidth=1.0)
    axes.set_xlim(0.0, max(float(curves.orbit.t[-1]), _EARLIEST_TIME))
    axes.set_ylim(0.0, 1.05 * max(float(curves.orbit.r2.max()), 1e-3))
    style_axes(axes)
    label_axes(axes, "t", "R²")
    name_panel(axes, "R² = x² + y²")
