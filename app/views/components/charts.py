"""Charts of the page, which Bokeh draws from `plots.pictures.charts.Chart`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Event
from bokeh.models import ColumnDataSource, Image, LinearColorMapper, MultiLine, Range1d, Scatter, Segment, Span, Text
from bokeh.plotting import figure

from app.views.components.plots import FigurePane, chart_hover, set_range, square_figure
from app.views.components.texts import TextPane, plain_symbol
from app.views.components.theme import theme_line
from plots.pictures.charts import NO_TICKS, ONLY_POINTS, Chart, Frame, Limits, Series, Shape, Tile
from plots.pictures.palette import THRESHOLD
from plots.texts.legends import legend

_POINT_COLUMNS = ("x", "y", "low", "high", "colour", "label", "marker", "size", "filled", "note")
_LINE_COLUMNS = ("xs", "ys", "colour", "dash", "width", "label")
_DOT_COLUMNS = ("x", "y", "colour")
_TILE_COLUMNS = ("image", "x", "y", "side", "top", "name", "text")
# Borders of charts without axes, in pixels. The title is above the frame.
_TILE_BORDERS = {"min_border_left": 0, "min_border_right": 0, "min_border_top": 28, "min_border_bottom": 0}
_DASHES = {Shape.DASHED: "8 8"}
_WIDTHS, _WIDTH = {Shape.THICK: 4}, 2
_SHAPES_WITH_POINTS = (Shape.POINTS, Shape.JOINED_POINTS, Shape.RINGS, Shape.CROSSES)
# Marker of a point, its size in pixels, and its opacity inside.
_MARKERS, _MARKER = {Shape.RINGS: ("circle", 9, 0.0), Shape.CROSSES: ("x", 8, 1.0)}, ("circle", 6, 1.0)


class ChartView:
    """A chart with its legend, hidden while there is nothing to show.

    Parameters
    ----------
    frame
        What the charts have in common.
    x_range
        The range of x; None for a range of the chart's own.
    **options
        Options of `square_figure`.
    """

    def __init__(self, frame: Frame, x_range: Range1d | None = None, **options: Any) -> None:
        self.frame, self._options = frame, options
        self._shared_x_range = x_range
        self._labels = frame.labels
        self._ticks = NO_TICKS, NO_TICKS
        self.plot: figure | None = None

    # The view and the models are made when they are first used, because a page is opened without charts.
    @cached_property
    def view(self) -> pn.Column:
        """The column of the chart."""
        return pn.Column(margin=0, sizing_mode="stretch_width", visible=False)

    @cached_property
    def x_range(self) -> Range1d:
        """The range of x."""
        return self._shared_x_range or Range1d(*self._first_limits[0])

    @cached_property
    def y_range(self) -> Range1d:
        """The range of y."""
        return Range1d(*self._first_limits[1])

    @property
    def _first_limits(self) -> tuple[Limits, Limits]:
        """The limits before there are numbers. An automatic range would cause warnings in the browser."""
        return Chart(self.frame, []).axis_limits

    @cached_property
    def lines(self) -> ColumnDataSource:
        """The lines of the chart."""
        return ColumnDataSource({name: [] for name in _LINE_COLUMNS}, name=f"{self.frame.name}_lines")

    @cached_property
    def points(self) -> ColumnDataSource:
        """The points of the chart, with their error bars."""
        return ColumnDataSource({name: [] for name in _POINT_COLUMNS}, name=f"{self.frame.name}_points")

    @cached_property
    def dots(self) -> ColumnDataSource:
        """The dots of the chart."""
        return ColumnDataSource({name: [] for name in _DOT_COLUMNS}, name=f"{self.frame.name}_dots")

    @cached_property
    def tiles(self) -> ColumnDataSource:
        """The tiles of the chart, with their texts."""
        return ColumnDataSource({name: [] for name in _TILE_COLUMNS}, name=f"{self.frame.name}_tiles")

    @cached_property
    def _tile_colours(self) -> LinearColorMapper:
        return LinearColorMapper()

    @cached_property
    def _legend(self) -> TextPane:
        return TextPane(margin=(0, 10))

    def show(self, chart: Chart | None) -> None:
        """Show a chart; None hides the view."""
        self.view.visible = chart is not None
        if chart is None:
            return
        self.lines.data, self.points.data = _line_columns(chart.series), _point_columns(chart.series)
        if self.frame.described is Shape.DOTS:
            self.dots.data = _dot_columns(chart.series)
        if self.frame.has_tiles:
            colours = [*chart.tile_colours]
            self._tile_colours.update(palette=colours, low=-0.5, high=len(colours) - 0.5)
            self.tiles.data = _tile_columns(chart.tiles)
        for axis_range, limits in zip((self.x_range, self.y_range), chart.axis_limits, strict=True):
            set_range(axis_range, *limits)
        entries = chart.legend()
        self._legend.param.update(object=legend(entries), visible=bool(entries))
        self._labels, self._ticks = chart.frame.labels, chart.ticks
        self._name_axes()

    def build(self, events: Mapping[type[Event], Callable[[Any], None]] = MappingProxyType({})) -> pn.Column:
        """Fill the view with a figure, which has callbacks for events, and return the view."""
        self.plot = self._draw()
        self.view.objects = [FigurePane(self.plot, events), self._legend]
        self._name_axes()
        return self.view

    def _draw(self) -> figure:
        frame = self.frame
        scales = {f"{axis}_axis_type": "log" for axis in frame.logarithmic}
        ranges = {"x_range": self.x_range, "y_range": self.y_range}
        options = self._options | (_TILE_BORDERS if frame.has_tiles else {})
        plot = square_figure(frame.name, frame.title, frame.help, x_axis_label=" ", **ranges, **scales, **options)
        if frame.has_tiles:
            self._draw_tiles(plot)
            return plot
        lines = plot.add_glyph(self.lines, MultiLine(line_color="colour", line_dash="dash", line_width="width"))
        ends = {"x0": "x", "x1": "x", "y0": "low", "y1": "high"}
        plot.add_glyph(self.points, Segment(**ends, line_color="colour", line_alpha=0.6))
        marks = Scatter(
            x="x",
            y="y",
            marker="marker",
            size="size",
            fill_color="colour",
            line_color="colour",
            fill_alpha="filled",
            line_width=1.5,
        )
        points = plot.add_glyph(self.points, marks)
        if frame.described is Shape.DOTS:
            dots = plot.add_glyph(self.dots, Scatter(x="x", y="y", size=2, fill_color="colour", line_color=None))
            plot.add_tools(chart_hover(frame.text, [dots]))
        elif frame.described in (Shape.RINGS, Shape.CROSSES):
            plot.add_tools(chart_hover(frame.text, [points]))
        elif frame.described is Shape.LINE:
            plot.add_tools(chart_hover(frame.text, [lines], line_policy="nearest"))
        else:
            plot.add_tools(chart_hover(frame.text, [points], mode="vline"))
        if frame.is_square:
            # The labels of the default number of ticks touch each other in a narrow column.
            for axis in (*plot.below, *plot.left):
                axis.ticker.desired_num_ticks = 4
        if frame.level is not None:
            style: dict[str, Any] = {"line_color": THRESHOLD, "line_dash": "dashed", "line_width": 1.5}
            plot.add_layout(Span(location=frame.level[0], dimension="width", **style))
        return plot

    def _draw_tiles(self, plot: figure) -> None:
        image = Image(image="image", x="x", y="y", dw="side", dh="side", color_mapper=self._tile_colours)
        plot.add_tools(chart_hover(self.frame.text, [plot.add_glyph(self.tiles, image)]))
        font = {"text_font_size": "11px", "text_line_height": 1.1, "text_baseline": "bottom", "text_color": theme_line("text")}
        plot.add_glyph(self.tiles, Text(x="x", y="top", text="text", **font))
        plot.outline_line_color = None

    def _name_axes(self) -> None:
        if self.plot is None:
            return
        for axis, label, ticks in zip((*self.plot.below, *self.plot.left), self._labels, self._ticks, strict=True):
            axis.axis_label = plain_symbol(label)
            if self.frame.has_tiles:
                axis.update(visible=bool(ticks), ticker=[*ticks], major_label_overrides={**ticks}, axis_line_color=None)


def _line_columns(series: Sequence[Series]) -> dict[str, list[Any]]:
    # Dashed lines come last, so they are drawn over the other lines.
    lines = sorted((one for one in series if one.shape not in ONLY_POINTS), key=lambda one: one.shape is Shape.DASHED)
    x, y = ([one.curve[axis] for one in lines] for axis in (0, 1))
    dashes = [_DASHES.get(one.shape, "solid") for one in lines]
    widths = [_WIDTHS.get(one.shape, _WIDTH) for one in lines]
    labels = [one.label for one in lines]
    return {"xs": x, "ys": y, "colour": [one.colour for one in lines], "dash": dashes, "width": widths, "label": labels}


def _dot_columns(series: Sequence[Series]) -> dict[str, Any]:
    dots = [one for one in series if one.shape is Shape.DOTS]
    # Numbers of 32 bits are as precise as a pixel, and half as long in a message.
    x, y = (np.concatenate([np.zeros(0), *(getattr(one, axis) for one in dots)]).astype(np.float32) for axis in "xy")
    return {"x": x, "y": y, "colour": np.repeat([one.colour for one in dots], [one.x.size for one in dots]).tolist()}


def _tile_columns(tiles: Sequence[Tile]) -> dict[str, list[Any]]:
    columns = [(tile.codes, tile.left, tile.bottom, tile.side, tile.bottom + tile.side, tile.name, tile.text) for tile in tiles]
    return {name: [column[k] for column in columns] for k, name in enumerate(_TILE_COLUMNS)}


def _point_columns(series: Sequence[Series]) -> dict[str, Any]:
    # The bars of points without error bars have no length.
    bars = [(one, one.bars or (one.y, one.y)) for one in series if one.shape in _SHAPES_WITH_POINTS]
    if not bars:
        return {name: [] for name in _POINT_COLUMNS}
    counts = [one.x.size for one, _ in bars]
    marks = zip(*(_MARKERS.get(one.shape, _MARKER) for one, _ in bars), strict=True)
    return {
        "x": np.concatenate([one.x for one, _ in bars], dtype=float),
        "y": np.concatenate([one.y for one, _ in bars], dtype=float),
        "low": np.concatenate([low for _, (low, _) in bars], dtype=float),
        "high": np.concatenate([high for _, (_, high) in bars], dtype=float),
        "colour": np.repeat([one.colour for one, _ in bars], counts).tolist(),
        "label": np.repeat([one.label for one, _ in bars], counts).tolist(),
        **{name: np.repeat(values, counts).tolist() for name, values in zip(("marker", "size", "filled"), marks, strict=True)},
        "note": [note for one, _ in bars for note in (one.notes or [""] * one.x.size)],
    }
