"""Draw charts of measures with Matplotlib."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from engine import Result
from engine.results import EscapeStatistics
from plots.pictures.charts import ONLY_POINTS, Chart, Series, Shape, Tile
from plots.pictures.palette import DEFAULT_COLOURS, THRESHOLD, rgba
from plots.pictures.setting import Settings
from plots.printed.figure_axes import Corner, add_panel_legend, new_figure, set_title, style_axes
from plots.printed.figure_style import SCREEN, FigureStyle
from plots.studies.escape_charts import probabilities_chart, times_chart
from plots.studies.study import Study

# Heights of a row of charts in figures with two columns and with one, in units of the width.
_ROW_HEIGHT, _ONE_COLUMN_ROW_HEIGHT = 0.24, 0.5
# Height of a square chart with its axis and title, in units of the width of its column.
_SQUARE = 1.02
# Line styles of shapes without solid lines.
_LINES = {Shape.DASHED: (0, (4.0, 3.0)), **dict.fromkeys(ONLY_POINTS, "")}
# Markers of shapes with points.
_MARKERS = {Shape.JOINED_POINTS: "o", **dict.fromkeys(ONLY_POINTS, "o"), Shape.CROSSES: "x"}
# Size of the texts of tiles, of which two lines fit between two rows.
_TILE_TEXT = 6.0
# Largest number of entries of a legend with one column; longer ones have several.
_MOST_ENTRIES, _LEGEND_COLUMNS = 6, 3
# Width of lines, and diameter of points, in points of typography.
_WIDTHS, _WIDTH = {Shape.THICK: 3.0}, 1.5
_SIZES, _SIZE = {Shape.DOTS: 0.9, Shape.RINGS: 4.5, Shape.CROSSES: 4.0}, 2.5


def draw_study_figure(study: Study[Any], found: Result, style: FigureStyle, settings: Settings) -> Figure:
    """Draw the charts of a study, with error bars, under the caption of the result.

    Raises
    ------
    ValueError
        If there is nothing to draw yet.
    """
    charts = study.charts(found, DEFAULT_COLOURS, settings)
    if not charts:
        raise ValueError(f"{study.files}: there must be at least one point")
    columns = min(style.columns(2), len(charts))
    is_high = any(chart.frame.aspect <= 1.0 for chart in charts)
    row_height = _SQUARE / columns if is_high else _ROW_HEIGHT if columns == 2 else _ONE_COLUMN_ROW_HEIGHT
    height = style.width * row_height * math.ceil(len(charts) / columns)
    return _draw_figure(charts, new_figure(style, height, study.caption(found)), style, columns)


def draw_statistics_figure(statistics: EscapeStatistics, style: FigureStyle) -> Figure:
    """Draw the histogram of escape times, and the probability of escape after each number of crossings."""
    height = style.width * (0.45 if style.columns(2) == 2 else 1.6)
    figure = new_figure(style, height, "Statistics of the escapes")
    return _draw_figure([times_chart(statistics), probabilities_chart(statistics)], figure, style, style.columns(2))


def _draw_figure(charts: Sequence[Chart], figure: Figure, style: FigureStyle, columns: int) -> Figure:
    """Draw charts with their titles, in one or two columns."""
    grid = np.ravel(figure.subplots(math.ceil(len(charts) / columns), columns)).tolist()
    for axes, chart in zip(grid, charts, strict=False):
        draw_chart(axes, chart, style)
        set_title(axes, chart.frame.title, style)
    for axes in grid[len(charts) :]:
        axes.remove()
    return figure


def draw_chart(axes: Axes, chart: Chart, style: FigureStyle = SCREEN, corner: Corner | None = "best") -> None:
    """Draw a chart with its axes. A legend with more than one entry is drawn in a corner; `corner` None omits the legend."""
    frame = chart.frame
    draw_series(axes, chart)
    for axis in frame.logarithmic:
        axes.set(**{f"{axis}scale": "log"})
    for axis, limits in zip("xy", chart.axis_limits, strict=True):
        axes.set(**{f"{axis}lim": limits})
    if frame.has_tiles:
        _style_tiles(axes, chart, style)
        return
    style_axes(axes, style, grid=True, labels=frame.labels)
    entry_count = len(chart.legend())
    if corner is not None and entry_count > 1:
        add_panel_legend(axes, corner, style, columns=1 if entry_count <= _MOST_ENTRIES else _LEGEND_COLUMNS)


def _style_tiles(axes: Axes, chart: Chart, style: FigureStyle) -> None:
    """Give maps that are as high as wide the axes that have ticks."""
    style_axes(axes, style, labels=(_typeset(chart.frame.labels[0]), _typeset(chart.frame.labels[1])))
    for axis, ticks in zip((axes.xaxis, axes.yaxis), chart.ticks, strict=True):
        axis.set_ticks([*ticks], [*ticks.values()])
        axis.set_visible(bool(ticks))
    axes.spines[:].set_visible(False)
    axes.set_aspect("equal")


def draw_series(axes: Axes, chart: Chart) -> list[Artist]:
    """Draw the series and the level of a chart, and return them."""
    artists = [artist for series in chart.series for artist in _draw_one(axes, series)]
    artists += [artist for tile in chart.tiles for artist in _draw_tile(axes, tile, chart.tile_colours)]
    if chart.frame.level is not None:
        value, label = chart.frame.level
        artists.append(axes.axhline(value, color=THRESHOLD, linestyle="--", linewidth=1.2, label=label))
    return artists


def _draw_tile(axes: Axes, tile: Tile, colours: Sequence[str]) -> list[Artist]:
    left, bottom, top = tile.left, tile.bottom, tile.bottom + tile.side
    image = axes.imshow(
        rgba(colours)[tile.codes], extent=(left, left + tile.side, bottom, top), origin="lower", interpolation="nearest",
        aspect="auto",
    )  # fmt: skip
    text = axes.text(left, top, _typeset(tile.text), fontsize=_TILE_TEXT, verticalalignment="bottom", linespacing=1.0)
    return [image, text]


def _draw_one(axes: Axes, series: Series) -> list[Artist]:
    if series.shape is Shape.BARS:
        left, right = series.bars or (series.x, series.x)
        return [*axes.bar(left, series.y, right - left, align="edge", color=series.colour)]
    label, shape = _typeset(series.label), series.shape
    artists: list[Artist] = [*axes.plot(
        *series.curve, color=series.colour, linewidth=_WIDTHS.get(shape, _WIDTH), linestyle=_LINES.get(shape, "-"),
        marker=_MARKERS.get(shape, ""), markersize=_SIZES.get(shape, _SIZE), label=label,
        markerfacecolor="none" if shape is Shape.RINGS else series.colour, zorder=3 if shape is Shape.DASHED else 2,
    )]  # fmt: skip
    if series.bars is not None:
        artists.append(axes.vlines(series.x, *series.bars, color=series.colour, alpha=0.6, linewidth=1.0))
    return artists


def _typeset(text: str) -> str:
    """Return a text in which Matplotlib typesets a subscript, such as that of S_b, which stands between dollar signs."""
    return re.sub(r"_(\w+)", r"$_{\1}$", text)
