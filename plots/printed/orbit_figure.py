"""Draw orbits with Matplotlib: their paths between the exits, and SALI and R² against time."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count, cycle
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Potential, Window
from engine.foundations.wording import format_number
from engine.slices.planes import SPACE
from plots.pictures.charts import Limits
from plots.pictures.histories import ENVELOPE_ALPHA, History, has_log_time
from plots.pictures.orbit_curves import OrbitCurves, find_well_window
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES, OrbitQuantity
from plots.pictures.palette import THRESHOLD, Palette
from plots.printed.figure_axes import add_figure_legend, add_panel_legend, new_figure, set_title, style_axes, write_below
from plots.printed.figure_style import SCREEN, FigureStyle
from plots.printed.potential_figure import draw_well
from plots.printed.window_axes import draw_curve, draw_limits, draw_pixels, labelled, show_window

# Height of the figure with two columns, in units of the width.
_HEIGHT = 0.58
# Height of the figure with one column, in units of the width.
_ONE_COLUMN_HEIGHT = 1.9
# Lower end of the time axis, dimensionless.
_EARLIEST_TIME = 0.01
# Name of the panel of the paths.
_PATH_PANEL = "path"
# The quantities with a panel. The Lyapunov exponent has none, because it repeats what SALI shows.
_PRINTED_QUANTITIES = {quantity.name: quantity for quantity in ORBIT_QUANTITIES if quantity.name != "exponent"}


def draw_orbits_figure(
    potential: Potential, orbits: Sequence[OrbitCurves], palette: Palette, verdicts: Sequence[str], style: FigureStyle
) -> Figure:
    """Draw paths, SALI and R² of orbits, each orbit in the colour of its number, with the verdicts below.

    Raises
    ------
    ValueError
        If there is no orbit.
    """
    if not orbits:
        raise ValueError(f"orbits={orbits!r}: must be at least one")
    has_one_column = style.columns(2) == 1
    title = f"{'Orbit' if len(orbits) == 1 else 'Orbits'} at h = {', '.join(_list_energies(orbits))}"
    figure = new_figure(style, style.width * (_ONE_COLUMN_HEIGHT if has_one_column else _HEIGHT), title)
    if has_one_column:
        rows: list[list[Any]] = [[_PATH_PANEL], *([name] for name in _PRINTED_QUANTITIES)]
        panels = figure.subplot_mosaic(rows, height_ratios=[2, *([1] * len(_PRINTED_QUANTITIES))])
    else:
        panels = figure.subplot_mosaic([[_PATH_PANEL, name] for name in _PRINTED_QUANTITIES])
    draw_path(panels[_PATH_PANEL], potential, orbits, palette, style)
    for name, quantity in _PRINTED_QUANTITIES.items():
        draw_quantity(panels[name], quantity, orbits, palette, style)
    if len(orbits) > 1:
        add_panel_legend(panels[next(iter(_PRINTED_QUANTITIES))], "lower left", style)
    if style.titles:
        lines = [f"{number}: {verdict}" for number, verdict in enumerate(verdicts, 1)] if len(orbits) > 1 else verdicts
        write_below(figure, lines, style)
    return figure


def draw_well_figure(
    potential: Potential, energy: float, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle
) -> Figure:
    """Draw the well at an energy with equipotentials, exits, and the paths of orbits in the colours of their exits."""
    window = find_well_window(potential, energy)
    figure = new_figure(style, style.width, f"The well at h = {format_number(energy, 6)}")
    axes = figure.subplots()
    draw_well(axes, potential, energy, window, palette)
    _draw_paths(
        axes, orbits, window, [palette.path_colour(one.orbit.fate, one.orbit.outcomes, k) for k, one in enumerate(orbits)]
    )
    show_window(axes, window, "x", "y", style, equal=True)
    add_figure_legend(figure, labelled(axes.collections), style, columns=2)
    return figure


def _list_energies(orbits: Sequence[OrbitCurves]) -> list[str]:
    return list(dict.fromkeys(format_number(curves.orbit.energy, 6) for curves in orbits))


def draw_path(
    axes: Axes, potential: Potential, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle = SCREEN
) -> None:
    """Draw paths and exits, see `draw_paths_and_exits`, with axes and title."""
    draw_paths_and_exits(axes, potential, orbits, palette)
    show_window(axes, _highest(orbits).window, "x", "y", style, equal=True)
    set_title(axes, "Path", style)


def draw_paths_and_exits(axes: Axes, potential: Potential, orbits: Sequence[OrbitCurves], palette: Palette) -> list[Artist]:
    """Draw paths as lines, long paths as density images, and the exits at the highest energy of the orbits. Return all."""
    highest = _highest(orbits)
    paths = _draw_paths(axes, orbits, highest.window, palette.orbits)
    return paths + draw_limits(axes, potential, SPACE, highest.orbit.energy, highest.window, palette.channels)


def _highest(orbits: Sequence[OrbitCurves]) -> OrbitCurves:
    return max(orbits, key=lambda curves: curves.orbit.energy)


def _draw_paths(axes: Axes, orbits: Sequence[OrbitCurves], window: Window, colours: Sequence[str]) -> list[Artist]:
    artists: list[Artist] = []
    for curves, colour in zip(orbits, cycle(colours), strict=False):
        if curves.visits is None:
            artists += draw_curve(axes, [np.column_stack(curves.path)], window, colors=colour, linewidths=1.0)
        else:
            # `draw_pixels` takes row 0 on top.
            pixels = curves.shaded(colour)[::-1]
            image = draw_pixels(axes, pixels.view(np.uint8).reshape(*pixels.shape, 4), curves.window)
            # Like lines, above a map that is drawn later.
            image.set_zorder(2)
            artists.append(image)
    return artists


def draw_quantity(
    axes: Axes, quantity: OrbitQuantity, orbits: Sequence[OrbitCurves], palette: Palette, style: FigureStyle = SCREEN
) -> None:
    """Draw a quantity of orbits against time, see `quantity_axes`."""
    logarithmic, limits = quantity_axes(quantity, orbits)
    for axis, axis_limits in zip("xy", limits, strict=True):
        axes.set(**{f"{axis}scale": "log" if axis in logarithmic else "linear", f"{axis}lim": axis_limits})
    draw_histories(axes, quantity, orbits, palette)
    style_axes(axes, style, labels=("t", quantity.label), title=quantity.title)


def quantity_axes(quantity: OrbitQuantity, orbits: Sequence[OrbitCurves]) -> tuple[str, tuple[Limits, Limits]]:
    """Return the letters of the logarithmic axes, and the limits of both. `has_log_time` decides about the axis of time."""
    end = max(10.0 * _EARLIEST_TIME, *(float(curves.orbit.t[-1]) for curves in orbits))
    letters = "x" if has_log_time(end, logarithmic=quantity.logarithmic) else ""
    histories = [curves.histories[quantity.name] for curves in orbits]
    with_samples = [history for history in histories if history.line[0].size]
    limits = quantity.limits(with_samples) if with_samples else (_EARLIEST_TIME, 1.0)
    return letters + ("y" if quantity.logarithmic else ""), ((_EARLIEST_TIME, end), limits)


def draw_histories(axes: Axes, quantity: OrbitQuantity, orbits: Sequence[OrbitCurves], palette: Palette) -> list[Artist]:
    """Draw a quantity of orbits against time and its threshold, and return the curves."""
    artists: list[Artist] = []
    for curves, colour, number in zip(orbits, cycle(palette.orbits), count(1), strict=False):
        artists += _draw_history(axes, curves.histories[quantity.name], colour, f"orbit {number}")
    if quantity.threshold is not None:
        artists.append(axes.axhline(quantity.threshold, color=THRESHOLD, linestyle="--", linewidth=1.0))
    return artists


def _draw_history(axes: Axes, history: History, colour: str, label: str) -> list[Artist]:
    """Draw a history, with its envelope where the curve is a mean."""
    t, low, high = history.band
    envelope = axes.fill_between(t, low, high, color=colour, alpha=ENVELOPE_ALPHA, linewidth=0.0)
    return [envelope, *axes.plot(*history.line, color=colour, linewidth=1.0, label=label)]
