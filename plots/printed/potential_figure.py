"""Draw the equipotentials of a potential with Matplotlib, in red at the `critical_energies`."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from engine import Potential, Window
from engine.slices.limiting_curves import trace_equipotentials
from engine.slices.planes import SPACE
from engine.systems.review.energy_ranges import depth_levels
from engine.systems.review.potential_review import critical_energies
from plots.pictures.palette import LIGHT, Palette
from plots.printed.window_axes import draw_curve, draw_limits

# Levels of equipotentials relative to the bottom of the well, in units of its depth: dense inside the well, sparse outside.
_LEVELS = (-6.0, -4.0, -2.0, -1.0, 0.0, 0.15, 0.3, 0.5, 0.7, 0.85, 1.25, 1.6, 2.2, 3.0, 4.5, 6.5, 9.0)
# Levels of equipotentials inside the well, in the same units.
_INNER_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9)
# Side of a panel, in units of the width of the interior.
_ENLARGEMENT = 1.35


def draw_equipotentials(axes: Axes, potential: Potential, window: Window) -> list[Artist]:
    """Draw equipotentials of a potential with exits in axes with equal scales, and return the curves."""
    levels = trace_equipotentials(potential, SPACE, depth_levels(potential, _LEVELS), window)
    critical = trace_equipotentials(potential, SPACE, critical_energies(potential), window)
    curves = [line for pieces in levels for line in draw_pieces(axes, pieces, LIGHT.quiet, 0.6)]
    return curves + [line for pieces in critical for line in draw_pieces(axes, pieces, LIGHT.critical_equipotential, 1.6)]


def draw_well(axes: Axes, potential: Potential, energy: float, window: Window, palette: Palette) -> None:
    """Draw equipotentials, and the zero-velocity curve and Lyapunov orbits of an energy."""
    for pieces in trace_equipotentials(potential, SPACE, depth_levels(potential, _INNER_LEVELS), window):
        draw_curve(axes, pieces, window, colors=LIGHT.equipotential, linewidths=0.6)
    draw_limits(axes, potential, SPACE, energy, window, palette.channels)


def draw_pieces(axes: Axes, pieces: list[np.ndarray], colour: str, width: float) -> list[Artist]:
    """Draw a curve that consists of pieces, each of shape (n, 2), and return the lines."""
    return [line for piece in pieces for line in axes.plot(*piece.T, color=colour, linewidth=width)]


def enlarge(window: Window) -> Window:
    """Return a square window with the centre of a window, wider by a margin."""
    x = 0.5 * (window.x_low + window.x_high)
    ordinate = 0.5 * (window.ordinate_low + window.ordinate_high)
    half = 0.5 * _ENLARGEMENT * window.width
    return Window(x - half, x + half, ordinate - half, ordinate + half)
