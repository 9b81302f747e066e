"""The pictures of a map. They share ranges, tools and a data source, so that one message repaints all pictures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from bokeh.events import DoubleTap, Event, PointEvent, SelectionGeometry, Tap
from bokeh.models import ColumnDataSource, Image, LinearColorMapper, LogColorMapper
from bokeh.plotting import figure

from app.state.view import PICTURES
from app.state.view_state import ViewState
from app.views.components.plots import FigurePane, PictureTexts, changing_models, label_axes, map_figure
from app.views.components.view_store import ViewStore
from app.views.maps.comparison import ComparedMap
from app.views.maps.hover import pixel_hover
from app.views.maps.map_curves import MapCurves, find_marked_places, trace_curves
from app.views.maps.map_toolbar import MapTools
from app.views.maps.markers import Markers
from app.views.maps.overlays import Overlays
from app.views.maps.picture_grid import PictureGrid
from app.views.maps.relief import shade_relief
from app.views.maps.two_fingers import TwoFingers
from app.views.maps.well import WellView, well_spec
from engine import EscapeMap, Fate, MapSpec, Window
from engine.foundations.wording import format_number
from engine.slices.axes import highest_energy
from plots.layers.map_images import LAYER_COLUMNS, result_columns
from plots.layers.picture import ShownMap, occurring_fates
from plots.layers.table import LAYERS, map_legend
from plots.layers.table import PICTURES as PICTURE_ENTRIES
from plots.links.map_view import Start
from plots.pictures.image_columns import NO_LAYER, PIXEL_COLUMNS
from plots.pictures.palette import PALETTES
from plots.pictures.time_scale import WITHOUT_ESCAPES, TimeScale, fitted_scale
from plots.texts.legends import legend_items, picture_legend

MAPS = tuple(name for name in PICTURES if name != "well")
"""Names of the maps of starts: all pictures but the well."""

PLAIN_PICTURES = ("well", "basins", "times", "crossings")
"""The pictures of a view without layers or comparison, in their order on the page."""

COMPARISON_PICTURES = ("basins", "compared", "well", "differences")
"""The pictures of a view that is compared with another view."""

# Smallest magnification that a note mentions. The window of a neighbouring energy is only slightly smaller than the interior.
_LEAST_MAGNIFICATION = 1.5


@dataclass(frozen=True)
class MapActions:
    """Callbacks for the user's actions on the maps.

    Attributes
    ----------
    tap
        Handles a click on the pixel at x and ordinate.
    zoom_to_point
        Handles a double click at x and ordinate; `tap` has handled the first click.
    count_in
        Counts the starts in a box.
    """

    tap: Callable[[float, float], None]
    zoom_to_point: Callable[[float, float], None]
    count_in: Callable[[Window], None]


def prepare_curves(spec: MapSpec) -> None:
    """Trace the curves over a map and in the well, and cache them for `MapsView.show`. Tracing takes up to half a second."""
    trace_curves(spec)
    well = well_spec(spec.potential, highest_energy(spec.energy))
    trace_curves(well)
    shade_relief(well)
    find_marked_places(spec.potential)


class MapsView:
    """Draws the frames of maps, with marks and curves.

    Parameters
    ----------
    state
        View state, which the view follows.
    actions
        Callbacks for the user's actions.
    store
        Gets the window of each map, and has the ranges of the pictures.
    alone
        Whether only the picture shown large is visible.
    """

    def __init__(self, state: ViewState, actions: MapActions, store: ViewStore, *, alone: bool = False) -> None:
        self._state, self._actions, self._store = state, actions, store
        self.source = ColumnDataSource(_blank_columns(), name="maps")
        self.grid = PictureGrid(state, alone=alone)
        self.well, self._outlines = WellView(state, self.grid.write), MapCurves(state)
        self.overlays, self.marks = Overlays(self.source, state), Markers(state)
        self._time_mapper = LogColorMapper(nan_color="rgba(0,0,0,0)")
        # Scale that fits the escape times of the map in view.
        self._fitted_times = WITHOUT_ESCAPES
        self._mappers = {name: LinearColorMapper() for name in MAPS}
        self._spec: MapSpec | None = None
        # The map whose pixels are on the page: that of the view, or the same with more pixels.
        self._pixels: MapSpec | None = None
        # Results of the layers that are on, by layer. A result may be incomplete.
        self._results: dict[str, Any] = {}
        # Layers that are being computed.
        self._computing: frozenset[str] = frozenset()
        # Codes of the fates in the frame.
        self._fates: frozenset[int] = frozenset()
        ranges = store.x, store.ordinate
        self.compared = ComparedMap(store, state)
        self._hover = pixel_hover(self.source, self.compared.source, *ranges)
        self._fingers = TwoFingers(*ranges)
        self.tools = MapTools(state, self._hover, self.compared.hover)
        self._last_tap: Start | None = None
        self.figures: dict[str, figure] = {}
        self._panes: dict[str, FigurePane] = {"well": self.well.pane}
        state.follow(self._set_colours, "palette")
        state.follow(lambda times: self._scale_times(), "lock_times")
        state.follow(lambda *values: self._show_pictures(), "layers", "compared")

    def _show_pictures(self) -> None:
        """Show the pictures of the view and of its layers."""
        state = self._state
        layers = [layer for name, layer in LAYERS.items() if name in state.layers]
        always_shown = PLAIN_PICTURES if state.compared is None else COMPARISON_PICTURES
        names = [*always_shown, *(layer.picture.name for layer in layers if layer.picture is not None)]
        if names != [*self.grid.shown]:
            with changing_models(list(self.figures.values())):
                for name in names:
                    if name not in self._panes:
                        self._build(name)
                self.grid.show({name: self._panes[name] for name in names})
        self._redraw()

    def show(self, frame: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Paint a frame, and go to the window of a new map."""
        if frame.spec != self._spec:
            self._store.set_home(replace(frame.spec, window=None))
            self._spec, self._results = frame.spec, {}
            self._show_curves(frame.spec)
        self._pixels = frame.spec
        # The window may have changed and changed back before a map of the other window was shown.
        self._store.follow(frame.spec.find_window())
        if frame.stride == 1:
            self._fitted_times = fitted_scale(frame)
        self._fates = occurring_fates(frame)
        self._scale_times()
        self.source.data = columns | self.compared.difference(columns, frame.spec.plane)

    def sharpen(self, sharper_map: EscapeMap, columns: dict[str, list[Any]]) -> None:
        """Show the pixels of the map in view computed with a higher resolution. Layers and differences keep theirs."""
        self._pixels = sharper_map.spec
        self.source.data = {**self.source.data, **{name: columns[name] for name in PIXEL_COLUMNS}}

    def show_compared(self, frame: EscapeMap | None, title: str = "") -> None:
        """Show the map of the other view with its title; None removes the map."""
        if frame is None:
            self.compared.remove()
        else:
            self.compared.show(frame, title)
        if self._spec is not None:
            self.source.data = self.source.data | self.compared.difference(self.source.data, self._spec.plane)
        self._show_legends()

    @property
    def times(self) -> TimeScale:
        """Scale of the escape times."""
        return self._state.lock_times or self._fitted_times

    def _scale_times(self) -> None:
        self._time_mapper.update(low=self.times.low, high=self.times.high)
        self._show_legends()

    def show_layer(self, name: str, frame: EscapeMap, result: Any) -> None:
        """Show the result of a layer, which may be incomplete, over its map."""
        layer = LAYERS[name]
        self._results[name] = result
        if layer.pixels is not None:
            self.source.data = {**self.source.data, **result_columns(name, frame, result)}
        self.overlays.show(name, result)
        if layer.picture is not None:
            self.grid.mark_empty(layer.picture.name, empty=layer.is_empty(frame))
        self._show_legends()

    def mark_computing(self, layers: frozenset[str]) -> None:
        """Show that these layers, and no other layers, are being computed."""
        if layers != self._computing:
            self._computing = layers
            self._show_legends()

    def remove_layer(self, name: str) -> None:
        """Remove a layer and its pixels, which the hover text would still describe."""
        self._results.pop(name, None)
        self.overlays.remove(name)
        pixels = LAYERS[name].pixels
        if pixels is not None and self.source.data[pixels.column][0].size > 1:
            self.source.data = {**self.source.data, **dict.fromkeys(pixels.column_names, NO_LAYER)}
        self._show_legends()

    def _set_colours(self, name: str) -> None:
        palette = PALETTES[name]
        self._time_mapper.palette = list(palette.escape_time)
        for picture, mapper in self._mappers.items():
            colours = list(PICTURE_ENTRIES[picture].colours(palette))
            mapper.update(palette=colours, low=-0.5, high=len(colours) - 0.5)
        self._redraw()

    def snapped(self, x: float, ordinate: float) -> Start:
        """Return the start of the pixel at a point: the centre of the pixel. Outside the map, return the point itself."""
        pixel = self._pixels.pixel_at(x, ordinate) if self._pixels is not None else None
        if self._pixels is None or pixel is None:
            return x, ordinate
        columns, rows = self._pixels.pixel_centres()
        return float(columns[pixel[1]]), float(rows[pixel[0]])

    def _tap(self, event: PointEvent) -> None:
        self._last_tap = self.snapped(event.x, event.y)
        self._actions.tap(*self._last_tap)

    def _tap_again(self, event: PointEvent) -> None:
        """Handle the second of two quick clicks. Bokeh reports a double tap even if the clicks are at different positions."""
        if self.snapped(event.x, event.y) == self._last_tap:
            self._last_tap = None
            self._actions.zoom_to_point(event.x, event.y)
        else:
            self._tap(event)

    def _count_in_box(self, event: SelectionGeometry) -> None:
        edges = event.geometry
        if event.final and edges["x0"] < edges["x1"] and edges["y0"] < edges["y1"]:
            self._actions.count_in(Window(edges["x0"], edges["x1"], edges["y0"], edges["y1"]))

    def _redraw(self) -> None:
        """Draw the curves and write the legends again."""
        if self._spec is not None:
            self._show_curves(self._spec)
            self._show_legends()

    def _show_curves(self, spec: MapSpec) -> None:
        self._outlines.show(spec)
        self.well.show_map(spec)

    def _show_legends(self) -> None:
        """Write title, legend, notes and names of the axes around each picture."""
        spec = self._spec
        if spec is None:
            return
        offsets = label_axes(self.figures.values(), spec.plane.axis_symbols, spec.find_window())
        note = self._note()
        other = self.compared.other
        is_locked = self._state.lock_times is not None
        shown_map = ShownMap(spec, self._state.colours, self.times, self._fates, is_locked, self._results, other)
        for name in self.grid.shown:
            if name == "well":
                self.well.describe()
            else:
                entry = PICTURE_ENTRIES[name]
                axes = other.axes if name == "compared" and other is not None else spec.plane.axis_symbols
                legend, under_way = picture_legend(map_legend(name, shown_map)), self._under_way(name)
                texts = PictureTexts(entry.title_for(spec), entry.short_title, axes, legend, offsets, note, under_way)
                self.grid.write(name, texts)

    def _note(self) -> str:
        """Return HTML that the largest map has below it: an entry of the legend of previews, and the magnification."""
        undecided = [] if Fate.NOT_COMPUTED in self._fates else [self._state.colours.outcomes[Fate.NOT_COMPUTED]]
        preview = f"<span class='preview'>{legend_items(undecided)}</span>" if undecided else ""
        magnification = float(f"{self._store.magnification:.2g}")
        enlarged = f"<small>{format_number(magnification)} times enlarged</small>" if magnification > _LEAST_MAGNIFICATION else ""
        return f"{preview}{enlarged}"

    def _under_way(self, picture: str) -> str:
        """Return what is being computed for a picture: the picture itself, or layers over the picture; empty if nothing is."""
        layers = [LAYERS[name] for name in LAYERS if name in self._computing]
        if any(layer.picture is not None and layer.picture.name == picture for layer in layers):
            return "computing …"
        # The titles of layers are too long for the line of a title.
        names = [layer.name for layer in layers if layer.over_picture(picture) is not None]
        return f"{', '.join(names)} …" if names else ""

    def _build(self, name: str) -> None:
        """Make a picture with its title and help text."""
        plot = self.figures[name] = map_figure(name, PICTURE_ENTRIES[name].title, self._store.x, self._store.ordinate)
        plot.toolbar = self.tools.toolbar
        self._paint(name)
        self._fingers.follow_on(plot)
        events: dict[type[Event], Callable[[Any], None]] = {
            Tap: self._tap,
            DoubleTap: self._tap_again,
            SelectionGeometry: self._count_in_box,
        }
        self._panes[name] = FigurePane(plot, events)

    def _paint(self, name: str) -> None:
        """Add the images and lines of a picture, from back to front."""
        plot, picture = self.figures[name], PICTURE_ENTRIES[name]
        if name == "compared":
            self.compared.draw(plot, self._mappers[name])
            self.marks.draw(plot, sections=False)
            return
        # modules/painting/pictures.js finds the map, and paints previews into it, by these tags.
        plot.tags = ["map", MAPS.index(name)]
        image = plot.add_glyph(self.source, Image(image=picture.column, dw="dw", dh="dh", color_mapper=self._mappers[name]))
        if picture.has_times:
            image = plot.add_glyph(self.source, Image(image="escape_time", dw="dw", dh="dh", color_mapper=self._time_mapper))
        # The last image, which is in front, gets the hover text.
        self._hover.renderers = [*self._hover.renderers, image]
        self._outlines.draw(plot)
        self.overlays.draw(plot, name)
        self.marks.draw(plot, sections=name == "basins")


def _blank_columns() -> dict[str, list[Any]]:
    """Return the columns of a map of one undecided pixel."""
    codes = np.zeros((1, 1), np.uint8)
    images = ("fate", "crossing_class", "crossings", *LAYER_COLUMNS, "difference")
    columns: dict[str, list[Any]] = {name: [codes] for name in images}
    columns |= {"escape_time": [np.full((1, 1), np.nan, np.float32)]}
    return columns | {"x": [-1.0], "y": [-1.0], "dw": [2.0], "dh": [2.0], "energy": [np.nan], "complete": [False], "ends": [[]]}
