"""Draw maps of a case at nine energies side by side, and the (x, h) plane of the case."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import CASES, EscapeMap, Fate, Plane, Window
from plots.layers.layer import NO_ANALYSES, Analyses
from plots.layers.map_images import picture_pixels
from plots.layers.picture import ColourScale
from plots.pictures.palette import PAPER
from plots.pictures.time_scale import TimeScale, common_scale
from plots.printed.figure_axes import add_figure_legend, label_axes, legend_handles, new_figure, set_title
from plots.printed.figure_style import SCREEN
from plots.printed.map_figure import add_colour_bar
from plots.printed.window_axes import draw_limits, draw_pixels, show_window
from reproduction.map_cache import MapCache
from reproduction.notation import axis_label, plane_label
from reproduction.paper_ranges import nine_energies, plane_energies

TITLES = {"basins": "basins of escape", "times": "escape times", "crossings": "upward crossings of $y = 0$ before the escape"}
"""Titles by picture of `draw_nine_maps`."""

# Number of panels in a row and in a column.
_SIDE = 3


def draw_nine_maps(case: str, cache: MapCache, *, plane: Plane, picture: str) -> Figure:
    """Draw one picture of `TITLES` at the paper's nine energies, all in one window."""
    frames = [cache.map(case, plane, energy) for energy in nine_energies(case)]
    window = _common_window(frames)
    times = common_scale(frames)
    title = f"Case {case}, {plane_label(plane)} plane: {TITLES[picture]}"
    # The colour bar of the escape times needs more width.
    figure = new_figure(replace(SCREEN, width=26.9 if picture == "times" else 24.4), 26.4, title, equal=True)
    panels = figure.subplots(_SIDE, _SIDE, sharex=True, sharey=True)
    for axes, frame in zip(panels.flat, frames, strict=True):
        draw_map_panel(axes, frame, picture, window, times=times)
        set_title(axes, f"$h = {frame.spec.energy:.2f}$")
        _remove_inner_labels(axes)
    if picture == "times":
        scale = ColourScale(times.low, times.high, PAPER.escape_time)
        bar = add_colour_bar(figure, scale, ax=panels.ravel().tolist(), shrink=0.75, aspect=34, pad=0.015, extend="both")
        bar.set_label(r"escape time $t_{\mathrm{esc}}$", fontsize=SCREEN.font_size)
    add_figure_legend(figure, [*_colour_handles(case, picture), *panels[0, 0].collections])
    return figure


def _remove_inner_labels(axes: Axes) -> None:
    """Remove the label of the x axis except in the last row, and that of the y axis except in the first column."""
    position = axes.get_subplotspec()
    assert position is not None
    x_label = axes.get_xlabel() if position.is_last_row() else ""
    y_label = axes.get_ylabel() if position.is_first_col() else ""
    label_axes(axes, x_label, y_label)


def draw_energy_plane(case: str, cache: MapCache) -> Figure:
    """Draw the basins on (x, h)."""
    frame = cache.map(case, Plane.X_H, plane_energies(case))
    figure = new_figure(replace(SCREEN, width=19.3), 16.8, f"Case {case}, {plane_label(Plane.X_H)} plane: basins of escape")
    axes = figure.subplots()
    draw_map_panel(axes, frame, "basins", frame.spec.find_window(), equal=False)
    add_figure_legend(figure, [*_colour_handles(case, "basins"), *axes.collections])
    return figure


def draw_map_panel(
    axes: Axes,
    frame: EscapeMap,
    picture: str,
    shown: Window,
    *,
    times: TimeScale | None = None,
    analyses: Analyses = NO_ANALYSES,
    equal: bool = True,
) -> None:
    """Draw a map with its limiting curve and exits.

    Starts outside are white like forbidden starts, so that panels with different windows look alike. In the picture of regular
    and chaotic orbits, escaping starts are also white.

    Parameters
    ----------
    axes
        The panel.
    frame
        A complete map.
    picture
        One of `plots.layers.table.TITLES`.
    shown
        Window of the panel.
    times
        Scale of the escape times; None for the scale that fits the map.
    analyses
        Regularity of bounded orbits, if the picture shows it.
    equal
        Whether both axes have the same scale.
    """
    spec = frame.spec
    pixels = picture_pixels(frame, picture, PAPER, analyses, times)
    is_white = frame.fate == Fate.OUTSIDE
    if picture == "characters":
        is_white |= frame.fate > Fate.BOUNDED
    # Row 0 of the pixels is on top, and row 0 of the map is lowest. Transparent pixels look white.
    pixels[::-1][is_white] = 0
    draw_pixels(axes, pixels, spec.find_window())
    draw_limits(axes, spec.potential, spec.plane, spec.energy, shown)
    x_name, y_name = map(axis_label, spec.plane.axis_names)
    show_window(axes, shown, x_name, y_name, equal=equal)


def _common_window(frames: Sequence[EscapeMap]) -> Window:
    """Return the smallest window that contains the windows of several maps."""
    edges = np.array([frame.spec.find_window().edges for frame in frames])
    return Window(edges[:, 0].min(), edges[:, 1].max(), edges[:, 2].min(), edges[:, 3].max())


def _colour_handles(case: str, picture: str) -> list[Artist]:
    bounded = PAPER.outcomes[Fate.BOUNDED]
    if picture == "times":
        return legend_handles([bounded])
    classes = PAPER.end_entries(CASES[case].outcomes) if picture == "basins" else PAPER.crossing_entries
    return legend_handles([bounded, *classes])
