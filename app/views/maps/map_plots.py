"""The pictures of a plane, linked in zoom, hover and clicks; they share one data source, so one message repaints all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import DoubleTap, RangesUpdate, SelectionGeometry, Tap
from bokeh.models import ColorBar, ColumnDataSource, Image, LinearColorMapper, LogColorMapper, Range1d, Span
from bokeh.plotting import figure

from app.rendering.image_columns import character_column, longest_typical_time, passage_column
from app.rendering.map_images import DOUBTED, ON_DEMAND, PAINTED, SHORTEST_TIME, TITLES
from app.rendering.palette import DARK, LIGHT, PAPER, Palette
from app.views.components.curve_layers import CurveLayers
from app.views.components.flex_row import flex_row
from app.views.components.legends import legend, passage_legend
from app.views.components.numbers import percent
from app.views.components.plots import TEXT, map_figure, with_help
from app.views.maps.hover import pixel_hover
from app.views.maps.markers import Markers
from app.views.maps.overlays import Overlays
from engine import EscapeMap, Fate, MapSpec, OriginFateMap, Regularity, RegularityMap, Window

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
    on_box
        Called with the box that is drawn to count in.
    """

    def __init__(
        self,
        on_tap: Callable[[float, float], None],
        on_zoom: Callable[[Window | None], None],
        on_box: Callable[[Window], None],
    ) -> None:
        self.source = ColumnDataSource(_blank(), name="maps")
        self.outlines, self.overlays, self.marks = CurveLayers(), Overlays(), Markers()
        self._palette = PAPER
        self._time_mapper = LogColorMapper(low=SHORTEST_TIME, high=100.0, nan_color="rgba(0,0,0,0)")
        self._colour_bar = ColorBar(color_mapper=self._time_mapper, height=8, padding=4, title="t", background_fill_alpha=0.0)
        self._mappers = {name: LinearColorMapper() for name in TITLES}
        self._spec: MapSpec | None = None
        self._regularity_text = ""
        self._home: Window | None = None
        self._rest_timer: Any = None
        self._following = False
        self._on_zoom = on_zoom
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._spans = Span(dimension="width", line_alpha=0.35), Span(dimension="height", line_alpha=0.35)
        self._hover = pixel_hover(self.source, *self._ranges)
        self._on_tap, self._on_box = on_tap, on_box
        self.figures: dict[str, figure] = {}
        self._legends: dict[str, pn.pane.HTML] = {}
        self._columns: dict[str, pn.viewable.Viewable] = {}
        for edges in self._ranges:
            edges.on_change("start", self._moved)
            edges.on_change("end", self._moved)
        self._row = flex_row(justify="center")
        self.show_pictures(frozenset())
        self.set_palette(PAPER)

    def layout(self) -> pn.viewable.Viewable:
        """The pictures in a row that wraps."""
        return self._row

    def show_pictures(self, on_demand: frozenset[str]) -> None:
        """Show some of the pictures `ON_DEMAND` beside the others."""
        shown = [name for name in TITLES if name in on_demand or name not in ON_DEMAND]
        for name in shown:
            if name not in self.figures:
                self._build(name)
        # Hidden pictures would still be painted with every frame.
        self._row.objects = [self._columns[name] for name in shown]
        self.describe()

    def show(self, frame: EscapeMap, columns: dict[str, list[Any]], *, preview: bool = False) -> None:
        """Paint a frame; the ranges follow a new window. A preview changes as little as possible."""
        if frame.spec != self._spec:
            self._follow(frame.spec)
            self._spec, self._regularity_text = frame.spec, ""
            if preview:
                self.outlines.show(frame.spec, preview=True)
            else:
                self.describe()
        if frame.stride == 1 and not preview:
            self._time_mapper.high = longest_typical_time(frame)
        self.source.data = columns

    def show_origins(self, origins: OriginFateMap) -> None:
        """Paint through which channels orbits enter and leave."""
        self.source.data = {**self.source.data, **passage_column(origins)}

    def show_regularity(self, frame: EscapeMap, regularity: RegularityMap) -> None:
        """Paint which bounded orbits are regular and which are chaotic, as far as known."""
        self.source.data = {**self.source.data, **character_column(frame, regularity)}
        self._regularity_text = _describe_regularity(regularity, regularity.character[frame.fate == Fate.BOUNDED])
        if "characters" in self._legends:
            self._legends["characters"].object = self._character_legend()

    def set_palette(self, palette: Palette) -> None:
        """Set all colours."""
        self._palette = palette
        self._time_mapper.palette = list(palette.escape_time)
        for name, (_, colours) in PAINTED.items():
            codes: list[str] = getattr(palette, colours)
            self._mappers[name].update(palette=codes, low=-0.5, high=len(codes) - 0.5)
        self.marks.set_palette(palette)
        self.outlines.set_palette(palette)
        self.describe()

    def set_dark(self, dark: bool) -> None:
        """Use the line colours of the dark or the light theme."""
        inks = DARK if dark else LIGHT
        # The text of a colour bar does not follow the stylesheet.
        self._colour_bar.update(title_text_color=inks.quiet, major_label_text_color=inks.quiet)
        self.outlines.set_dark(dark)
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

    def _character_legend(self) -> str:
        return legend(self._palette.character_entries) + f"<div class='legend'>{self._regularity_text}</div>"

    def _follow(self, spec: MapSpec) -> None:
        """Go to the window of a new map, unless the ranges are being moved."""
        if self._rest_timer is None:
            self._go_to(spec.window)

    def _moved(self, _name: str, _old: float, _new: float) -> None:
        """The ranges change: wait until they stop."""
        document = self.source.document
        if not self._following and document is not None:
            self._stop_waiting()
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
        window = Window(x.start, x.end, y.start, y.end)
        if self._spec is None or _is_near(window, self._spec.window):
            return
        self._on_zoom(None if self._home is not None and _is_near(window, self._home) else window)

    def _boxed(self, event: SelectionGeometry, on_box: Callable[[Window], None]) -> None:
        edges = event.geometry
        if event.final and edges["x0"] < edges["x1"] and edges["y0"] < edges["y1"]:
            on_box(Window(edges["x0"], edges["x1"], edges["y0"], edges["y1"]))

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        self._following = True
        x.update(start=window.x_low, end=window.x_high)
        y.update(start=window.ordinate_low, end=window.ordinate_high)
        self._following = False

    def describe(self) -> None:
        """Update axis names, outlines and legends."""
        spec, palette = self._spec, self._palette
        if spec is None:
            return
        for plot in self.figures.values():
            plot.yaxis.axis_label = spec.plane.ordinate
        self.outlines.show(spec)
        outcomes = [entry for fate, entry in palette.outcomes.items() if fate is not Fate.FAILED]
        texts = {
            "curves": legend([*self.outlines.entries(spec), *outcomes[1:3]]),
            "basins": legend([*palette.channel_entries(spec.potential.channels), *reversed(outcomes), *self.overlays.entries()]),
            "times": legend(list(reversed(outcomes))),
            "crossings": legend([*palette.crossing_entries, *reversed(outcomes)]),
            "characters": self._character_legend(),
            "origins": passage_legend(palette, spec.potential.channels),
        }
        for name, pane in self._legends.items():
            pane.object = texts[name]

    def _build(self, name: str) -> None:
        """Make a picture with its legend and help text."""
        plot = self.figures[name] = map_figure(name, TITLES[name], self._ranges, self._spans)
        self._paint(name)
        # Two quick clicks, even at two places, are one tap and one double tap.
        for tap in (Tap, DoubleTap):
            plot.on_event(tap, lambda event: self._on_tap(*self.snapped(event.x, event.y)))
        plot.on_event(SelectionGeometry, lambda event: self._boxed(event, self._on_box))
        if name == "curves":
            # The end of a drag; after a step of the wheel it comes half a second late. One of the linked pictures is enough.
            plot.on_event(RangesUpdate, lambda event: self._rested())
        self._legends[name] = pn.pane.HTML(width=TEXT, margin=(0, 5))
        self._columns[name] = with_help(pn.pane.Bokeh(plot, margin=0), name, self._legends[name])

    def _paint(self, name: str) -> None:
        """Add the images and lines of a picture, from back to front."""
        plot, (column, _) = self.figures[name], PAINTED[name]
        image = plot.add_glyph(self.source, Image(image=column, dw="dw", dh="dh", color_mapper=self._mappers[name]))
        if name == "times":
            image = plot.add_glyph(self.source, Image(image="escape_time", dw="dw", dh="dh", color_mapper=self._time_mapper))
            plot.add_layout(self._colour_bar, "below")
        plot.add_tools(self._hover.clone(renderers=[image]))
        self.outlines.draw(plot, full=name == "curves")
        if name == "curves" or name in DOUBTED:
            self.overlays.draw(plot, doubts=name in DOUBTED, coloured=name == "curves")
        self.marks.draw(plot, sections=name in ("curves", "basins"))


def _describe_regularity(regularity: RegularityMap, bounded: np.ndarray) -> str:
    """The share of chaotic orbits among the bounded pixels (n,), or the progress of the analysis."""
    if not bounded.size:
        return "No bounded orbits."
    if regularity.complete:
        return f"{percent(regularity.chaotic_share)} of the bounded orbits are chaotic."
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
    return columns | {"x": [-1.0], "y": [-1.0], "dw": [2.0], "dh": [2.0], "complete": [False]}
