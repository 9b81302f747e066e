"""Draw pictures of a map with Matplotlib: pixels, curves, marks of starts, legend and provenance."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure

from engine import EscapeMap
from plots.layers.layer import NO_ANALYSES, Analyses
from plots.layers.picture import ColourScale, Legend
from plots.layers.table import TITLES
from plots.pictures.palette import Palette
from plots.pictures.provenance import provenance_line
from plots.pictures.time_scale import TimeScale, fitted_scale
from plots.printed.figure_axes import (
    add_legend_below,
    figure_of,
    fit_height,
    label_width,
    legend_handles,
    legend_style,
    new_figure,
    set_font,
    set_title,
    size_in_points,
    transform_below,
    write_below,
)
from plots.printed.figure_style import POINTS_PER_INCH, SCREEN, FigureStyle
from plots.printed.plane_picture import map_picture, scale_colours
from plots.printed.window_axes import labelled, mark_starts, show_window

# Distance from a map to the next element below the axis label, in units of the font size.
_BELOW_AXIS = 3.7
# Distance from a colour bar to the next element below the labels of the bar, in units of the font size.
_BELOW_BAR = 3.4
# Distance from a map to the left edge of its legend, in units of the font size.
_LEFT_OF_AXIS = 3.0
# Width of the labels and gaps beside a map, in units of the font size.
_BESIDE_MAP = 6.0
# Height of a colour bar, as a share of the side of its map.
_BAR_HEIGHT = 0.04
# Initial height of a row of maps with legends, before the height is fitted, in units of the width of a map with labels. With less
# height, a long legend would make the maps small.
_ROW_HEIGHT = 4.0
# Width of a legend, as a share of the width of a map with its labels.
_LEGEND_WIDTH = 0.9
# Approximate number of letters of a title as wide as its font size.
_LETTERS_PER_EM = 2.6
# Smallest distance between ticks of an upright colour bar, as a share of its length.
_BETWEEN_TICKS = 0.15


def draw_map_figure(
    frame: EscapeMap,
    pictures: Sequence[str],
    palette: Palette,
    style: FigureStyle,
    *,
    analyses: Analyses = NO_ANALYSES,
    starts: Sequence[tuple[float, float]] = (),
    times: TimeScale | None = None,
) -> Figure:
    """Draw pictures of a map in rows, each with title, axes, curves and legend. The provenance is below all pictures.

    A legend omits the entries of earlier legends.

    Parameters
    ----------
    frame
        The map, finished or not. Its window is stretched to a square.
    pictures
        Names of pictures, from `TITLES`.
    palette
        Colours.
    style
        Width of the figure, resolution, font size and titles.
    analyses
        Results of the layers.
    starts
        (x, ordinate) of each chosen orbit. Starts are numbered from 1. Starts outside the window are counted but not drawn.
    times
        Scale of the escape times; None for `fitted_scale`.

    Raises
    ------
    ValueError
        If no picture is given, or a picture is invalid.
    """
    if not pictures:
        raise ValueError(f"pictures={pictures!r}: must be at least one of {', '.join(TITLES)}")
    time_scale = times or fitted_scale(frame)
    columns = style.columns(len(pictures))
    rows = math.ceil(len(pictures) / columns)
    figure = new_figure(style, rows * _ROW_HEIGHT * style.width / columns, equal=True)
    # Measure texts at low resolution, because Matplotlib allocates all pixels of the figure to measure a text.
    figure.set_dpi(POINTS_PER_INCH)
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for axes in panels[len(pictures) :]:
        axes.remove()
    explained: set[str] = set()
    for axes, picture in zip(panels, pictures, strict=False):
        axes.set_label(picture)
        axes.set_box_aspect(1.0)
        legend = draw_picture(axes, frame, picture, palette, analyses, time_scale, style)
        mark_starts(axes, starts, palette, frame.spec.find_window(), style)
        _explain_picture(axes, legend, explained, style.inches / columns, style)
    if style.titles:
        write_below(figure, [provenance_line(frame)], style, style.smallest_size)
    set_font(figure)
    fit_height(figure)
    figure.set_dpi(style.dpi)
    return figure


def draw_picture(
    axes: Axes,
    frame: EscapeMap,
    picture: str,
    palette: Palette,
    analyses: Analyses = NO_ANALYSES,
    times: TimeScale | None = None,
    style: FigureStyle = SCREEN,
) -> Legend:
    """Draw a picture, one of `TITLES`: its pixels, curves, axes and title. `times` is the scale of the escape times.

    Returns the legend of the picture.
    """
    spec = frame.spec
    shown = map_picture(frame, picture, palette, analyses, times)
    shown.draw(axes)
    show_window(axes, spec.find_window(), *spec.plane.axis_symbols, style)
    letters = int(_LETTERS_PER_EM * size_in_points(axes)[0] / style.font_size)
    set_title(axes, textwrap.fill(shown.title, max(1, letters)), style)
    return shown.legend


def _explain_picture(axes: Axes, legend: Legend, explained: set[str], width: float, style: FigureStyle) -> None:
    """Draw the colour bar and the legend below a map, in a column that is `width` inches wide.

    The legend omits entries whose labels are in `explained`. The labels of its entries are added to `explained`, in place.
    """
    depth = _BELOW_AXIS * style.font_size
    if legend.scale is not None:
        bar_axes = axes.inset_axes((0.0, -_BAR_HEIGHT, 1.0, _BAR_HEIGHT), transform=transform_below(axes, depth))
        length = width * POINTS_PER_INCH - _BESIDE_MAP * style.font_size
        # The last label ends at the end of the bar, so its whole width counts, and half the width of the label before: a letter.
        last_label = _tick_labels(legend.scale, [legend.scale.high])[0]
        between_ticks = label_width(f"{last_label}0") * style.small_size / length
        add_colour_bar(figure_of(axes), legend.scale, style, between_ticks, cax=bar_axes, orientation="horizontal")
        bar_axes.get_xticklabels()[-1].set_horizontalalignment("right")
        depth += _BELOW_BAR * style.font_size
    handles = legend_handles([*legend.entries, *legend.others])
    handles += labelled(axes.collections)
    handles += legend_handles(legend.over)
    entries = {label: handle for handle in handles if (label := str(handle.get_label())) not in explained}
    explained.update(entries)
    if entries:
        place = _LEFT_OF_AXIS * style.font_size, depth
        add_legend_below(axes, entries, place, _LEGEND_WIDTH * width * POINTS_PER_INCH, legend_style(style))


def add_colour_bar(
    figure: Figure, scale: ColourScale, style: FigureStyle = SCREEN, between_ticks: float = _BETWEEN_TICKS, **place: Any
) -> Colorbar:
    """Add the colour bar of a scale.

    Parameters
    ----------
    figure, scale, style
        Figure, scale, and style of the ticks.
    between_ticks
        Smallest distance between ticks, as a share of the length of the bar.
    **place
        Options of `matplotlib.figure.Figure.colorbar`.
    """
    cmap, norm = scale_colours(scale)
    bar = figure.colorbar(ScalarMappable(norm, cmap), **place)
    ticks = [scale.low, *_inner_ticks(scale, between_ticks), scale.high]
    bar.set_ticks(ticks, labels=_tick_labels(scale, ticks))
    bar.ax.minorticks_off()
    bar.ax.tick_params(labelsize=style.small_size)
    return bar


def _tick_labels(scale: ColourScale, ticks: Sequence[float]) -> list[str]:
    # The colours at the ends stand for all smaller and all larger numbers.
    signs = {scale.low: "≤ ", scale.high: "≥ "}
    return [f"{signs.get(tick, '')}{tick:g}" for tick in ticks]


def _inner_ticks(scale: ColourScale, between: float) -> list[float]:
    """Return powers of ten inside a logarithmic scale, not too close to its ends, or the middle of a linear scale."""
    if not scale.is_logarithmic:
        return [float(f"{0.5 * (scale.low + scale.high):.3g}")]
    least_ratio = (scale.high / scale.low) ** between
    step = max(1, math.ceil(math.log10(least_ratio)))
    powers = [10.0**k for k in range(math.ceil(math.log10(scale.low)), math.floor(math.log10(scale.high)) + 1, step)]
    return [power for power in powers if scale.low * least_ratio < power < scale.high / least_ratio]
