"""The four pictures of a plane, linked in zoom, hover and clicks; they share one source, so one message repaints all."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Tap
from bokeh.models import (
    BoxZoomTool,
    ColorBar,
    ColumnDataSource,
    CrosshairTool,
    CustomJSHover,
    HoverTool,
    LinearColorMapper,
    LogColorMapper,
    PanTool,
    Range1d,
    ResetTool,
    SaveTool,
    Span,
    WheelZoomTool,
)
from bokeh.plotting import figure

from app import palette
from app.map_columns import longest_typical_time
from app.views.legends import legend
from app.views.outlines import Outlines
from engine import EscapeMap, Window

FRAME = 300
"""Side of each picture in pixels: four fit a screen of 1600, one fits a phone of 420."""

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
}


class MapsView:
    """Draws frames; calls `on_tap(x, ordinate)` for a click on any picture."""

    def __init__(self, on_tap: Callable[[float, float], None]) -> None:
        self.source = ColumnDataSource(_blank(), name="maps")
        self.start = ColumnDataSource({"x": [], "y": []}, name="start")
        self.outlines = Outlines()
        self._time_mapper = LogColorMapper(palette=palette.ESCAPE_TIME, low=1.0, high=100.0, nan_color="rgba(0,0,0,0)")
        self._home: Window | None = None
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._spans = Span(dimension="width", line_alpha=0.35), Span(dimension="height", line_alpha=0.35)
        self._hover_rows = _hover_rows()
        self.figures = {name: self._figure(name, title) for name, title in TITLES.items()}
        self._paint()
        for plot in self.figures.values():
            plot.on_event(Tap, lambda event: on_tap(event.x, event.y))
        self._legends = {name: pn.pane.HTML(width=FRAME + 60, margin=(0, 5)) for name in TITLES}

    def layout(self) -> pn.viewable.Viewable:
        """The pictures in a row that wraps."""
        columns = [
            pn.Column(pn.pane.Bokeh(self.figures[name], margin=0), self._legends[name], margin=(0, 6), width=FRAME + 75)
            for name in TITLES
        ]
        return pn.FlexBox(*columns, justify_content="center", gap="4px")

    def show(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame; the ranges follow a new window unless the user has zoomed away from the old one."""
        window = frame.spec.window
        if window != self._home:
            if self._home is None or self._is_at(self._home):
                self._go_to(window)
            self._home = window
            for axis, low, high in zip(self._ranges, (window.x_low, window.ordinate_low), (window.x_high, window.ordinate_high), strict=True):
                axis.reset_start, axis.reset_end = low, high
            self._describe(frame)
        if frame.stride == 1:
            self._time_mapper.high = longest_typical_time(frame)
        self.source.data = columns

    def mark_start(self, start: tuple[float, float] | None) -> None:
        """Put the cross of the chosen start on every picture, or take it away."""
        x, y = ([start[0]], [start[1]]) if start is not None else ([], [])
        self.start.data = {"x": x, "y": y}

    def _is_at(self, window: Window) -> bool:
        x, y = self._ranges
        return np.allclose([x.start, x.end, y.start, y.end], [window.x_low, window.x_high, window.ordinate_low, window.ordinate_high])

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        x.update(start=window.x_low, end=window.x_high)
        y.update(start=window.ordinate_low, end=window.ordinate_high)

    def _describe(self, frame: EscapeMap) -> None:
        """Axis names, outlines and legends of a new plane, case or energy."""
        spec = frame.spec
        for plot in self.figures.values():
            plot.yaxis.axis_label = spec.plane.ordinate
        self.outlines.show(spec)
        channels = palette.channel_entries(spec.potential.channels)
        outcomes = [palette.OUTCOMES[fate] for fate in palette.OUTCOMES if fate.name != "FAILED"]
        texts = {
            "curves": legend([*self.outlines.entries(spec), *outcomes[1:3]]),
            "basins": legend([*channels, *reversed(outcomes)]),
            "times": legend(list(reversed(outcomes))),
            "crossings": legend([*(entry for _, entry in palette.CROSSING_CLASSES), *reversed(outcomes)]),
        }
        for name, text in texts.items():
            self._legends[name].object = text

    def _figure(self, name: str, title: str) -> figure:
        wheel = WheelZoomTool()
        tools = [PanTool(), wheel, BoxZoomTool(match_aspect=True), ResetTool(), SaveTool(), CrosshairTool(overlay=self._spans)]
        plot = figure(
            name=name, title=title, tools=tools, active_scroll=wheel, toolbar_location="above",
            frame_width=FRAME, frame_height=FRAME, x_range=self._ranges[0], y_range=self._ranges[1],
            x_axis_label="x", y_axis_label="y",
        )  # fmt: skip
        plot.toolbar.autohide = True
        plot.toolbar.logo = None
        plot.grid.visible = False
        plot.title.text_font_size = "14px"
        plot.background_fill_color = palette.FORBIDDEN
        return plot

    def _paint(self) -> None:
        """The images and lines of each picture, from back to front."""
        layers = {
            "curves": [("fate", _code_mapper(palette.REGION_COLOURS))],
            "basins": [("fate", _code_mapper(palette.FATE_COLOURS))],
            "times": [("fate", _code_mapper(palette.BACKGROUND_COLOURS)), ("escape_time", self._time_mapper)],
            "crossings": [("crossing_class", _code_mapper(palette.CROSSING_COLOURS))],
        }
        for name, plot in self.figures.items():
            for column, mapper in layers[name]:
                image = plot.image(column, "x", "y", "dw", "dh", source=self.source, color_mapper=mapper)
            plot.add_tools(HoverTool(renderers=[image], tooltips=self._hover_rows[0], formatters=self._hover_rows[1]))
            self.outlines.draw(plot, full=name == "curves")
            plot.scatter("x", "y", source=self.start, marker="cross", size=16, line_width=5, line_color=palette.START_HALO)
            plot.scatter("x", "y", source=self.start, marker="cross", size=14, line_width=2, line_color=palette.START)
        bar = ColorBar(color_mapper=self._time_mapper, height=8, padding=4, title="escape time", title_text_font_size="11px")
        self.figures["times"].add_layout(bar, "below")


def _code_mapper(colours: list[str]) -> LinearColorMapper:
    return LinearColorMapper(palette=colours, low=-0.5, high=len(colours) - 0.5)


def _blank() -> dict[str, list[Any]]:
    """A picture of one pixel that nobody has decided yet."""
    codes = np.zeros((1, 1), np.uint8)
    columns: dict[str, list[Any]] = {name: [codes] for name in ("fate", "crossing_class")}
    columns |= {"crossings": [np.zeros((1, 1), np.int32)], "escape_time": [np.full((1, 1), np.nan, np.float32)]}
    return columns | {"x": [-1.0], "y": [-1.0], "dw": [2.0], "dh": [2.0], "complete": [False]}


def _hover_rows() -> tuple[list[tuple[str, str]], dict[str, CustomJSHover]]:
    """What a hover reads out of a pixel, the same on all pictures."""
    names = [entry.label for entry in palette.OUTCOMES.values()]
    names += [f"escapes through channel {k + 1}" for k in range(len(palette.CHANNELS))]
    fate = CustomJSHover(args={"names": names}, code="return names[value] ?? 'not decided yet'")
    time = CustomJSHover(code="return Number.isFinite(value) ? value.toPrecision(5) : '–'")
    rows = [
        ("start", "($x{0.00000}, $y{0.00000})"),
        ("fate", "@fate{custom}"),
        ("escape time", "@escape_time{custom}"),
        ("crossings", "@crossings"),
    ]
    return rows, {"@fate": fate, "@escape_time": time}
