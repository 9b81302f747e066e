"""The four pictures of a plane, linked in zoom, hover and clicks; they share one source, so one message repaints all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import RangesUpdate, Tap
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
    Span,
    WheelZoomTool,
)
from bokeh.plotting import figure

from app import palette
from app.map_columns import character_column, longest_typical_time
from app.views.legends import legend
from app.views.outlines import Outlines
from engine import Certificate, EscapeMap, Fate, MapSpec, Regularity, RegularityMap, Window, describe_certificate

FRAME = 300
"""Side of each picture in pixels: four fit a screen of 1600, one fits a phone of 420."""

REST_MS = 200
"""Ranges that have not moved for this long are computed anew."""

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
    "characters": "Regular or chaotic",
}


class MapsView:
    """Draws frames; calls `on_tap(x, ordinate)` for a click, and `on_zoom(window)` when the ranges have come to rest.

    A window of None is the whole interior.
    """

    def __init__(self, on_tap: Callable[[float, float], None], on_zoom: Callable[[Window | None], None]) -> None:
        self.source = ColumnDataSource(_blank(), name="maps")
        self.start = ColumnDataSource({"x": [], "y": []}, name="start")
        self.outlines = Outlines()
        self._time_mapper = LogColorMapper(palette=palette.ESCAPE_TIME, low=1.0, high=100.0, nan_color="rgba(0,0,0,0)")
        self._spec: MapSpec | None = None
        self._home: Window | None = None
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._spans = Span(dimension="width", line_alpha=0.35), Span(dimension="height", line_alpha=0.35)
        self._hover_text = _hover_text(self.source)
        self.figures = {name: self._figure(name, title) for name, title in TITLES.items()}
        self._paint()
        self._on_zoom = on_zoom
        self._rest: Any = None
        # All pictures report every zoom, as their ranges are the same; one is enough.
        self.figures["curves"].on_event(RangesUpdate, self._zooming)
        for plot in self.figures.values():
            plot.on_event(Tap, lambda event: on_tap(*self._snapped(event.x, event.y)))
        self._legends = {name: pn.pane.HTML(width=FRAME + 60, margin=(0, 5)) for name in TITLES}
        self._columns = {
            name: pn.Column(pn.pane.Bokeh(self.figures[name], margin=0), self._legends[name], margin=(0, 6), width=FRAME + 75)
            for name in TITLES
        }
        self._row = pn.FlexBox(justify_content="center", gap="4px")
        self.show_characters(False)

    def layout(self) -> pn.viewable.Viewable:
        """The pictures in a row that wraps."""
        return self._row

    def show_characters(self, visible: bool) -> None:
        """Show or hide the picture of regular and chaotic orbits."""
        # A picture that is only hidden would be painted with every frame all the same.
        self._row.objects = [column for name, column in self._columns.items() if visible or name != "characters"]

    def show(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame; the ranges follow a new window."""
        if frame.spec != self._spec:
            self._follow(frame.spec)
            self._describe(frame.spec)
            self._spec = frame.spec
        if frame.stride == 1:
            self._time_mapper.high = longest_typical_time(frame)
        self.source.data = columns

    def show_regularity(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        """Paint which bounded orbits are regular and which chaotic, as far as it is known."""
        self.source.data = {**self.source.data, **character_column(frame, regularity)}
        judged = f"{regularity.chaotic_share:.1%} of the bounded orbits are chaotic."
        open_share = np.mean(regularity.character[frame.fate == Fate.BOUNDED] == Regularity.NOT_JUDGED)
        sentence = judged if regularity.complete else f"Following deviations: {open_share:.1%} of the bounded orbits still open …"
        nothing = not np.any(frame.fate == Fate.BOUNDED)
        self._legends["characters"].object = self._character_legend("No orbit is bounded." if nothing else sentence)

    def _character_legend(self, sentence: str) -> str:
        entries = [palette.CHARACTERS[key] for key in palette.CHARACTERS]
        return legend(entries) + f'<div style="font-size:12px">{sentence}</div>'

    def mark_start(self, start: tuple[float, float] | None) -> None:
        """Put the cross of the chosen start on every picture, or take it away."""
        x, y = ([start[0]], [start[1]]) if start is not None else ([], [])
        self.start.data = {"x": x, "y": y}

    def _snapped(self, x: float, ordinate: float) -> tuple[float, float]:
        """The centre of the pixel clicked, so that the orbit is the very one whose colour was clicked."""
        pixel = self._spec.pixel_at(x, ordinate) if self._spec is not None else None
        if self._spec is None or pixel is None:
            return x, ordinate
        columns, rows = self._spec.pixel_centres()
        return float(columns[pixel[1]]), float(rows[pixel[0]])

    def _follow(self, spec: MapSpec) -> None:
        """Go to the window of a new map, unless the user is on the way to another one."""
        if self._rest is None:
            self._go_to(spec.window)

    def set_home(self, window: Window) -> None:
        """The window of the whole interior, which the reset tool goes back to."""
        self._home = window
        x, y = self._ranges
        x.update(reset_start=window.x_low, reset_end=window.x_high)
        y.update(reset_start=window.ordinate_low, reset_end=window.ordinate_high)

    def _zooming(self, event: RangesUpdate) -> None:
        """Wait until the ranges rest, then say where."""
        document = self.source.document
        if document is None:
            return
        if self._rest is not None:
            document.remove_timeout_callback(self._rest)
        edges = (event.x0, event.x1, event.y0, event.y1)
        self._rest = document.add_timeout_callback(lambda: self._rested(edges), REST_MS)

    def _rested(self, edges: tuple[float, float, float, float]) -> None:
        self._rest = None
        window = Window(*edges)
        if self._spec is None or _is_near(window, self._spec.window):
            return
        self._on_zoom(None if self._home is not None and _is_near(window, self._home) else window)

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        x.update(start=window.x_low, end=window.x_high)
        y.update(start=window.ordinate_low, end=window.ordinate_high)

    def _describe(self, spec: MapSpec) -> None:
        """Axis names, outlines and legends of a new plane, case or energy."""
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
        texts["characters"] = self._character_legend("")
        for name, text in texts.items():
            self._legends[name].object = text

    def _figure(self, name: str, title: str) -> figure:
        wheel = WheelZoomTool()
        tools = [PanTool(), wheel, BoxZoomTool(match_aspect=True), ResetTool(), CrosshairTool(overlay=self._spans, visible=False)]
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
            "characters": [("character", _code_mapper(palette.CHARACTER_COLOURS))],
        }
        for name, plot in self.figures.items():
            for column, mapper in layers[name]:
                image = plot.image(column, "x", "y", "dw", "dh", source=self.source, color_mapper=mapper)
            text, formatters = self._hover_text
            plot.add_tools(
                HoverTool(renderers=[image], tooltips=text, formatters=formatters, attachment="vertical", visible=False)
            )
            self.outlines.draw(plot, full=name == "curves")
            plot.scatter("x", "y", source=self.start, marker="cross", size=16, line_width=5, line_color=palette.HALO)
            plot.scatter("x", "y", source=self.start, marker="cross", size=14, line_width=2, line_color=palette.START)
        bar = ColorBar(color_mapper=self._time_mapper, height=8, padding=4, title="escape time", title_text_font_size="11px")
        self.figures["times"].add_layout(bar, "below")


def _is_near(one: Window, other: Window) -> bool:
    """The same window but for rounding on its way through the browser."""
    width, height = other.x_high - other.x_low, other.ordinate_high - other.ordinate_low
    apart = np.abs(np.subtract(astuple(one), astuple(other)))
    return bool(np.all(apart <= 1e-6 * np.array([width, width, height, height])))


def _code_mapper(colours: list[str]) -> LinearColorMapper:
    return LinearColorMapper(palette=colours, low=-0.5, high=len(colours) - 0.5)


def _blank() -> dict[str, list[Any]]:
    """A picture of one pixel that nobody has decided yet."""
    codes = np.zeros((1, 1), np.uint8)
    columns: dict[str, list[Any]] = {name: [codes] for name in ("fate", "crossing_class", "character")}
    columns |= {"crossings": [np.zeros((1, 1), np.int32)], "escape_time": [np.full((1, 1), np.nan, np.float32)]}
    return columns | {"x": [-1.0], "y": [-1.0], "dw": [2.0], "dh": [2.0], "complete": [False]}


_HOVER_DETAILS = """
const {flat_index} = special_vars.image_index
const fate = source.data.fate[0][flat_index]
if (fate < bounded) return ""
const time = source.data.escape_time[0][flat_index]
const crossings = `crossings of y = 0: ${source.data.crossings[0][flat_index]}`
if (Number.isFinite(time)) return `escape time ${time.toPrecision(5)}, ${crossings}`
const reason = certificates[source.data.crossing_class[0][flat_index] - first]
return fate > bounded ? crossings : reason
"""


def _hover_text(source: ColumnDataSource) -> tuple[str, dict[str, CustomJSHover]]:
    """What a hover reads out of a pixel, the same on all pictures.

    One formatter reads all columns: Bokeh hands a NaN, the escape time of a bounded orbit, to no formatter.
    """
    names = [entry.label for entry in palette.OUTCOMES.values()]
    names += [f"escapes through channel {k + 1}" for k in range(len(palette.CHANNELS))]
    fate = CustomJSHover(args={"names": names}, code="return names[value] ?? names[0]")
    bounded = list(palette.OUTCOMES).index(Fate.BOUNDED)
    certificates = [describe_certificate(code) for code in Certificate]
    first = len(palette.OUTCOMES) + len(palette.CROSSING_CLASSES)
    arguments = {"source": source, "bounded": bounded, "certificates": certificates, "first": first}
    details = CustomJSHover(args=arguments, code=_HOVER_DETAILS)
    text = (
        '<div style="font-size:11px;line-height:14px"><b>@fate{custom}</b><br>'
        "@crossing_class{custom}<br>($x{0.0000}, $y{0.0000})</div>"
    )
    return text, {"@fate": fate, "@crossing_class": details}
