"""Draw a potential: equipotentials, exits with Lyapunov orbits, and an orbit through each exit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, LyapunovOrbit, Plane, Potential, Window, find_lyapunov_orbits, integrate_orbit
from engine.slices.default_window import default_window
from engine.slices.limiting_curves import trace_zero_velocity_curve
from plots.pictures.palette import LIGHT, PAPER
from plots.printed.figure_axes import label_axes, new_figure, set_titles, style_axes
from plots.printed.figure_style import SCREEN
from plots.printed.potential_figure import draw_equipotentials, draw_pieces, enlarge
from reproduction.map_cache import MapCache
from reproduction.notation import axis_label
from reproduction.paper_ranges import CHANNEL_ENERGIES
from reproduction.sample_orbits import find_sample_starts

# Number of samples of V along a side of a panel.
_SAMPLES = 301
# Distance of labels from the bottom of the well, in units of the distance of the saddle.
_LABEL_DISTANCE = 1.22


def draw_potential(case: str, cache: MapCache) -> Figure:
    """Draw three panels with the same window."""
    potential = CASES[case]
    energy = CHANNEL_ENERGIES[case]
    window = enlarge(default_window(potential, Plane.X_Y, energy))
    figure = new_figure(
        replace(SCREEN, width=32.0), 12.3, f"Case {case}: the potential and its {potential.channels} channels", equal=True
    )
    panels = list(figure.subplots(1, 3, sharex=True, sharey=True))
    orbits = find_lyapunov_orbits(potential, energy)
    draw_equipotentials(panels[0], potential, window)
    _draw_channels(panels[1], potential, energy, orbits, window)
    _draw_escapes(panels[2], cache, case, window)
    for axes in panels:
        axes.set_xlim(window.x_low, window.x_high)
        axes.set_ylim(window.ordinate_low, window.ordinate_high)
        axes.set_aspect("equal")
        style_axes(axes)
        label_axes(axes, axis_label("x"), axis_label("y") if axes is panels[0] else "")
    equipotentials = f"equipotentials, the escape energy ${potential.escape_energy:.4g}$ in red"
    set_titles(
        panels,
        [equipotentials, f"channels and Lyapunov orbits, $h = {energy}$", f"one orbit through each channel, $h = {energy}$"],
    )
    return figure


def _draw_channels(axes: Axes, potential: Potential, energy: float, orbits: tuple[LyapunovOrbit, ...], window: Window) -> None:
    _draw_forbidden(axes, potential, energy, window)
    draw_pieces(axes, trace_zero_velocity_curve(potential, Plane.X_Y, energy, window), PAPER.channels[0], 1.6)
    for orbit in orbits:
        axes.plot(*orbit.half_path.T, color=LIGHT.critical_equipotential, linewidth=2.0, solid_capstyle="round")
        x, y = potential.saddles[orbit.channel - 1] * _LABEL_DISTANCE
        axes.text(x, y, f"$L_{orbit.channel}$", ha="center", va="center", fontsize=14.0, color=LIGHT.text)


def _draw_escapes(axes: Axes, cache: MapCache, case: str, window: Window) -> None:
    potential = CASES[case]
    energy = CHANNEL_ENERGIES[case]
    _draw_forbidden(axes, potential, energy, window)
    draw_pieces(axes, trace_zero_velocity_curve(potential, Plane.X_Y, energy, window), LIGHT.limiting_curve, 1.0)
    for channel, start in find_sample_starts(cache.map(case, Plane.X_PX, energy)).items():
        orbit = integrate_orbit(potential, start, cache.quality.t_max, execution=cache.execution)
        colour = PAPER.channels[channel - 1]
        axes.plot(orbit.x, orbit.y, color=colour, linewidth=1.1)
        axes.plot(orbit.x[0], orbit.y[0], "o", color=colour, markersize=4.5, markeredgecolor=LIGHT.halo, zorder=3)
        _draw_arrow(axes, orbit.x[-1], orbit.y[-1], orbit.px[-1], orbit.py[-1], colour, window)


def _draw_arrow(axes: Axes, x: float, y: float, px: float, py: float, colour: str, window: Window) -> None:
    """Draw an arrow at the end of an orbit, in the direction of its motion."""
    length = 0.05 * window.width / np.hypot(px, py)
    arrow = {"arrowstyle": "-|>,head_width=0.25,head_length=0.5", "color": colour, "linewidth": 1.1, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (x + length * px, y + length * py), (x, y), arrowprops=arrow)


def _draw_forbidden(axes: Axes, potential: Potential, energy: float, window: Window) -> None:
    x = np.linspace(window.x_low, window.x_high, _SAMPLES)
    y = np.linspace(window.ordinate_low, window.ordinate_high, _SAMPLES)
    height = potential.value(*np.meshgrid(x, y))
    axes.contourf(x, y, height, levels=[energy, np.inf], colors=[LIGHT.equipotential], alpha=0.45)
