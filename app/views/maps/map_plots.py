"""The pictures of a plane, linked in zoom, hover and clicks; they share one data source, so one message repaints all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from functools import partial
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import DoubleTap, Event, PinchEnd, PointEvent, RangesUpdate, SelectionGeometry, Tap
from bokeh.models import (
    BoxSelectTool,
    BoxZoomTool,
    ColumnDataSource,
    CrosshairTool,
    HoverTool,
    Image,
    LinearColorMapper,
    LogColorMapper,
    PanTool,
    Range1d,
    Span,
    Toolbar,
    WheelZoomTool,
)  # fmt: skip
from bokeh.plotting import figure

from app.views.components.curve_layers import CurveLayers
from app.views.components.flex_row import FULL_HEIGHT
from app.views.components.numbers import percent
from app.views.components.plots import FigurePane, map_figure, name_axes
from app.views.components.widgets import SegmentedControl
from app.views.maps.hover import pixel_hover
from app.views.maps.map_legend import MapLegend
from app.views.maps.map_toolbar import Drag
from app.views.maps.markers import Markers
from app.views.maps.overlays import Overlays
from app.views.maps.two_fingers import TwoFingers
from app.views.maps.well import WellView
from engine import EscapeMap, Fate, MapSpec, OriginFateMap, Regularity, RegularityMap, Window
from plots.image_columns import NO_LAYER, character_column, longest_typical_time, passage_column
from plots.map_images import CROSSED_BY_MANIFOLDS, DOUBTED, ON_DEMAND, PAINTED, SHORTEST_TIME, TITLES
from plots.palette import PAPER, Palette

MAPS = tuple(name for name in TITLES if name != "curves")
"""The pictures of starts; beside them stands the well."""

SHORT_TITLES = {
    "well": "Well",
    "basins": "Basins",
    "times": "Times",
    "crossings": "Crossings",
    "characters": "Chaos",
    "origins": "Origins",
}
"""Titles of the pictures where there is little room."""

GESTURE_PAUSE_MS = 500
"""Drags and steps of the wheel that follow each other within this time are one entry of the browser's history."""

REST_MS = 90
"""A window is computed when the ranges have not changed for this long, longer than between two steps of a wheel."""


class MapsView:
    """Draws frames of maps, and the marks over them.

    Parameters
    ----------
    on_tap
        Called with x and ordinate of the pixel clicked.
    on_zoom
        Called with the window when the ranges have stopped changing; None is the whole interior.
    on_rest
        Called `GESTURE_PAUSE_MS` after the end of the last drag or step of the wheel.
    on_box
        Called with the box that is drawn to count in.
    """

    def __init__(
        self,
        on_tap: Callable[[float, float], None],
        on_zoom: Callable[[Window | None], None],
        on_rest: Callable[[], None],
        on_box: Callable[[Window], None],
    ) -> None:
        self.source = ColumnDataSource(_blank(), name="maps")
        self.well, self.outlines, self.overlays, self.marks = WellView(), CurveLayers(), Overlays(), Markers()
        self._palette = PAPER
        self._time_mapper = LogColorMapper(low=SHORTEST_TIME, high=100.0, nan_color="rgba(0,0,0,0)")
        # Upper ends of the scale of escape times: of the map in view, and the one that is kept instead.
        self._typical_time: float = self._time_mapper.high
        self._locked_time: float | None = None
        self._mappers = {name: LinearColorMapper() for name in MAPS}
        self._spec: MapSpec | None = None
        self._regularity_text = ""
        self._home: Window | None = None
        self._rest_timer: Any = None
        self._gesture_timer: Any = None
        self._following = False
        self._on_zoom, self._on_rest = on_zoom, on_rest
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._hover = pixel_hover(self.source, self.overlays.doubts, *self._ranges)
        self._fingers = TwoFingers(*self._ranges)
        self._drags: dict[Drag, Any] = {Drag.PAN: PanTool()}
        self._toolbar = _toolbar(self._drags[Drag.PAN], self._hover)
        self._on_tap, self._on_box = on_tap, on_box
        self.figures: dict[str, figure] = {}
        self._panes: dict[str, pn.pane.Bokeh] = {}
        for edges in self._ranges:
            edges.on_change("start", self._moved)
            edges.on_change("end", self._moved)
        self.legend = MapLegend()
        self.picker = SegmentedControl(label="Map", value="basins", css_classes=["segmented", "map-picker"], visible=False)
        self.picker.param.watch(lambda event: self._pick(), "value")
        self._grid = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["maps"])
        self.set_palette(PAPER)

    def layout(self) -> list[pn.viewable.Viewable]:
        """The pictures and their legend."""
        return [self._grid, self.legend.pane]

    def show_pictures(self, on_demand: frozenset[str]) -> None:
        """Show some of the pictures `ON_DEMAND` beside the others."""
        shown = [name for name in MAPS if name in on_demand or name not in ON_DEMAND]
        for name in shown:
            if name not in self.figures:
                self._build(name)
        # Hidden pictures would still be painted with every frame.
        self._grid.objects = [*self._picker(), self.well.pane, *(self._panes[name] for name in shown)]
        self._set_class("many", len(shown) > 3)
        offered = ["well", *shown]
        picked = self.picker.value if self.picker.value in offered else "basins"
        self.picker.param.update(options={SHORT_TITLES[name]: name for name in offered}, value=picked)
        self._pick()
        self.describe()

    def mark_stale(self, stale: bool) -> None:
        """Grey the pictures out while they do not belong to the controls, or show them as they are."""
        self._set_class("stale", stale)

    def _set_class(self, name: str, on: bool) -> None:
        """Set or remove a class of the grid in the stylesheet."""
        others = [each for each in self._grid.css_classes if each != name]
        self._grid.css_classes = [*others, name] if on else others

    def begin_touch(self) -> None:
        """The page is used by touch: on a narrow screen one picture is shown, chosen with the picker."""
        # The wheel's tool would answer to two fingers, too.
        others = [tool for tool in self._toolbar.tools if not isinstance(tool, WheelZoomTool)]
        self._toolbar.update(tools=others, active_scroll=None)
        self.picker.visible = True
        self._grid.objects = [*self._picker(), *self._grid.objects]

    def set_drag(self, drag: Drag) -> None:
        """Choose what dragging over a picture does."""
        if drag in _BOX_TOOLS and drag not in self._drags:
            self._drags[drag] = _BOX_TOOLS[drag]()
            self._toolbar.tools = [*self._toolbar.tools, self._drags[drag]]
        self._toolbar.active_drag = self._drags.get(drag)

    def show(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame; the ranges follow a new window."""
        if frame.spec != self._spec:
            self._follow(frame.spec)
            self._spec, self._regularity_text = frame.spec, ""
            self.describe()
        if frame.stride == 1:
            self._typical_time = longest_typical_time(frame)
            self._scale_times()
        self.source.data = columns

    @property
    def longest_time(self) -> float:
        """Upper end of the scale of escape times."""
        return float(self._time_mapper.high)

    def lock_times(self, longest: float | None) -> None:
        """Keep the upper end of the scale of escape times; None follows the maps again."""
        self._locked_time = longest
        self._scale_times()

    def _scale_times(self) -> None:
        self._time_mapper.high = self._locked_time or self._typical_time
        self._show_legend()

    def show_origins(self, origins: OriginFateMap) -> None:
        """Paint through which channels orbits enter and leave."""
        self.source.data = {**self.source.data, **passage_column(origins)}

    def show_regularity(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        """Paint which bounded orbits are regular and which are chaotic, as far as known."""
        self.source.data = {**self.source.data, **character_column(frame, regularity)}
        self._regularity_text = _describe_regularity(regularity, regularity.character[frame.fate == Fate.BOUNDED])
        self._show_legend()

    def remove_layer(self, column: str) -> None:
        """Remove the column of a layer, ``character`` or ``passage``, which the hover text would still describe."""
        if self.source.data[column][0].size > 1:
            self.source.data = {**self.source.data, column: NO_LAYER}

    def set_palette(self, palette: Palette) -> None:
        """Set all colours."""
        self._palette = palette
        self._time_mapper.palette = list(palette.escape_time)
        for name in MAPS:
            colours = PAINTED[name][1]
            codes: list[str] = getattr(palette, colours)
            self._mappers[name].update(palette=codes, low=-0.5, high=len(codes) - 0.5)
        self.marks.set_palette(palette)
        self.outlines.set_palette(palette)
        self.well.set_palette(palette)
        self.describe()

    def set_dark(self, dark: bool) -> None:
        """Use the line colours of the dark or the light theme."""
        self.outlines.set_dark(dark)
        self.well.outlines.set_dark(dark)
        self.describe()

    def set_home(self, window: Window) -> None:
        """Set the window of the whole interior, where the reset tool leads."""
        self._home = window
        x, y = self._ranges
        x.update(reset_start=window.x_low, reset_end=window.x_high)
        y.update(reset_start=window.ordinate_low, reset_end=window.ordinate_high)

    def snapped(self, x: float, ordinate: float) -> tuple[float, float]:
        """The centre of the pixel at a point, so that its orbit is the one whose colour is shown."""
        pixel = self._spec.pixel_at(x, ordinate) if self._spec is not None else None
        if self._spec is None or pixel is None:
            return x, ordinate
        columns, rows = self._spec.pixel_centres()
        return float(columns[pixel[1]]), float(rows[pixel[0]])

    def _follow(self, spec: MapSpec) -> None:
        """Go to the window of a new map, unless the ranges are being moved."""
        if self._rest_timer is None:
            self._go_to(spec.find_window())

    def _moved(self, _name: str, _old: float, _new: float) -> None:
        """The ranges change: wait until they stop."""
        document = self.source.document
        if not self._following and document is not None:
            self._stop_waiting()
            if self._gesture_timer is not None:
                document.remove_timeout_callback(self._gesture_timer)
                self._gesture_timer = None
            self._rest_timer = document.add_timeout_callback(self._waited, REST_MS)

    def _stop_waiting(self) -> None:
        if self._rest_timer is not None:
            self.source.document.remove_timeout_callback(self._rest_timer)
            self._rest_timer = None

    def _waited(self) -> None:
        # A timeout callback that runs is already removed.
        self._rest_timer = None
        self._rested()

    def _rested(self) -> None:
        """The ranges have stopped: report the window."""
        self._stop_waiting()
        x, y = self._ranges
        # The page and its browser can change a range at once.
        if not (x.start < x.end and y.start < y.end):
            return
        window = Window(x.start, x.end, y.start, y.end)
        if self._spec is None or _is_near(window, self._spec.find_window()):
            return
        self._on_zoom(None if self._home is not None and _is_near(window, self._home) else window)

    def _end_gesture(self) -> None:
        """The end of a drag, or a step of the wheel, which has no end: the next one may follow."""
        self._rested()
        document = self.source.document
        if document is not None and self._gesture_timer is None:
            self._gesture_timer = document.add_timeout_callback(self._finish_gesture, GESTURE_PAUSE_MS)

    def _finish_gesture(self) -> None:
        self._gesture_timer = None
        self._on_rest()

    def _tapped(self, event: PointEvent) -> None:
        self._on_tap(*self.snapped(event.x, event.y))

    def _boxed(self, event: SelectionGeometry) -> None:
        edges = event.geometry
        if event.final and edges["x0"] < edges["x1"] and edges["y0"] < edges["y1"]:
            self._on_box(Window(edges["x0"], edges["x1"], edges["y0"], edges["y1"]))

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        self._following = True
        x.update(start=window.x_low, end=window.x_high)
        y.update(start=window.ordinate_low, end=window.ordinate_high)
        self._following = False

    def describe(self) -> None:
        """Update axis names, outlines and the legend."""
        spec = self._spec
        if spec is None:
            return
        for name, plot in self.figures.items():
            name_axes(plot, TITLES[name], spec.plane.axis_names)
        self.outlines.show(spec)
        self.well.show_map(spec)
        self._show_legend()

    def _show_legend(self) -> None:
        spec = self._spec
        if spec is None:
            return
        shown = [name for name, pane in self._panes.items() if pane in self._grid.objects]
        self.legend.show(
            spec,
            self._palette,
            self.longest_time,
            [*self.well.outlines.entries(spec), *self.overlays.entries()],
            regularity=self._regularity_text if "characters" in shown else None,
            origins="origins" in shown,
            locked=self._locked_time is not None,
        )

    def _picker(self) -> list[pn.viewable.Viewable]:
        return [self.picker] if self.picker.visible else []

    def _pick(self) -> None:
        """Mark the picture that narrow screens show."""
        # The classes of a pane of Bokeh cannot be changed once it is on the page.
        with pn.io.hold():
            for name, plot in {"well": self.well.plot, **self.figures}.items():
                kind = "well" if name == "well" else "map"
                plot.css_classes = [kind, "picked"] if name == self.picker.value else [kind]

    def _build(self, name: str) -> None:
        """Make a picture with its title and help text."""
        plot = self.figures[name] = map_figure(name, TITLES[name], *self._ranges)
        plot.toolbar = self._toolbar
        self._paint(name)
        self._fingers.follow_on(plot)
        # Two quick clicks, even at two places, are one tap and one double tap.
        events: dict[type[Event], Callable[[Any], None]] = {
            Tap: self._tapped,
            DoubleTap: self._tapped,
            SelectionGeometry: self._boxed,
            PinchEnd: lambda event: self._end_gesture(),
        }
        if name == "basins":
            # The end of a drag; after a step of the wheel it comes half a second late. One of the linked pictures is enough.
            events[RangesUpdate] = lambda event: self._end_gesture()
        self._panes[name] = FigurePane(plot, events)

    def _paint(self, name: str) -> None:
        """Add the images and lines of a picture, from back to front."""
        plot, (column, _) = self.figures[name], PAINTED[name]
        image = plot.add_glyph(self.source, Image(image=column, dw="dw", dh="dh", color_mapper=self._mappers[name]))
        if name == "times":
            image = plot.add_glyph(self.source, Image(image="escape_time", dw="dw", dh="dh", color_mapper=self._time_mapper))
        self._hover.renderers = [*self._hover.renderers, image]
        self.outlines.draw(plot, full=False)
        self.overlays.draw(plot, doubts=name in DOUBTED, manifolds=name in CROSSED_BY_MANIFOLDS)
        self.marks.draw(plot, sections=name == "basins")


# The box selects pixels to count; without renderers the image keeps its look.
_BOX_TOOLS = {Drag.ZOOM: partial(BoxZoomTool, match_aspect=True), Drag.COUNT: partial(BoxSelectTool, renderers=[])}


def _toolbar(pan: PanTool, hover: HoverTool) -> Toolbar:
    """The tools of all pictures."""
    wheel = WheelZoomTool()
    spans = [Span(dimension=dimension, line_alpha=0.35) for dimension in ("width", "height")]
    return Toolbar(tools=[pan, wheel, CrosshairTool(overlay=spans), hover], active_drag=pan, active_scroll=wheel)


def _describe_regularity(regularity: RegularityMap, bounded: np.ndarray) -> str:
    """The share of chaotic orbits among the bounded pixels (n,), or the progress of the analysis."""
    if not bounded.size:
        return "No bounded orbits."
    if regularity.complete:
        caveat = " Too short a t_max to call the others regular: no chaos so far." if regularity.is_too_short else ""
        return f"{percent(regularity.chaotic_share)} of the bounded orbits are chaotic.{caveat}"
    return f"{percent(np.mean(bounded == Regularity.NOT_JUDGED))} of the bounded orbits left …"


def _is_near(one: Window, other: Window) -> bool:
    """Whether two windows are equal up to rounding in the browser."""
    width, height = other.x_high - other.x_low, other.ordinate_high - other.ordinate_low
    apart = np.abs(np.subtract(astuple(one), astuple(other)))
    return bool(np.all(apart <= 1e-6 * np.array([width, width, height, height])))


def _blank() -> dict[str, list[Any]]:
    """A picture of one undecided pixel."""
    codes = np.zeros((1, 1), np.uint8)
    columns: dict[str, list[Any]] = {name: [codes] for name in ("fate", "crossing_class", "crossings", "character", "passage")}
    columns |= {"escape_time": [np.full((1, 1), np.nan, np.float32)]}
    return columns | {"x": [-1.0], "y": [-1.0], "dw": [2.0], "dh": [2.0], "energy": [np.nan], "complete": [False]}
